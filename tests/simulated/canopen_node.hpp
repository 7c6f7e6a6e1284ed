// SPDX-License-Identifier: Apache-2.0
// One node on a CANopen bus (CiA 301 slave): NMT states, heartbeat, guarding, SDO, PDO, EMCY around a drive.
// Promises that nothing but NMT and error control works while it is stopped, and nothing at all while it boots; that a
// reply is given to a request alone. Never reads a clock and never knows a bus: CanLine does.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <utility>

#include "tests/simulated/can_pdos.hpp"
#include "tests/simulated/sdo_server.hpp"

namespace axisgate::simulated {

enum class NmtState : std::uint8_t { initialising = 0, stopped = 4, operational = 5, pre_operational = 127 };

std::string_view name_of(NmtState state);

// What one type of drive has of CiA 301, and what it holds as delivered.
struct CommunicationFacts {
  SdoFacts sdo{};
  PdoFacts pdo{};
  bool guarding_objects = false;  // 100Ch, 100Dh, 100Eh and the reaction 6007h (MD 4.5); else guarding is answered only
  bool drive_minds_guarding = false;  // 6007h is the drive's, which also says what it does without guarding
  bool answers_guarding = true;
  bool answers_guarding_with_heartbeat = true;   // CiA 301 wants one of both; no sheet says what happens
  int consumers = 1;                             // entries of 1016h; 0: there is none
  bool leaves_operational_on_loss = true;        // CiA 301 1029h as delivered; no sheet mentions it
  bool sends_emergencies = true;                 // of alarms; the sheets leave it open
  std::uint16_t heartbeat = 0;                   // 1017h as stored
  std::uint8_t heartbeat_width = 2;              // bytes of it; CiA 301's
  bool identity_object = true;                   // 1018h
  bool keeps_settings = false;                   // whatever was written stays over a restart, without a save
  std::uint32_t device_type = 0x00020192;        // 1000h: CiA 402, servo
  std::array<std::uint32_t, 4> identity{};       // 1018h: vendor, product, revision, serial
  std::string name{};                            // 1008h
  std::string hardware{};                        // 1009h
  std::string software{};                        // 100Ah
  std::optional<std::uint16_t> version_numbers;  // 1009h and 100Ah are numbers, and this one
  std::map<ObjectKey, std::string> texts{};      // more objects that hold a text; may be written
  std::set<ObjectKey> lacks{};                   // of another type or firmware than the sheet's: refused
};

class CanopenNode final : public CanNode, private ObjectAccess {
 public:
  static constexpr std::size_t longest_history = 8;  // entries of 1003h

  CanopenNode(CommunicationFacts facts, std::uint8_t node, std::unique_ptr<CanDevice> device);

  using Output = CanOutput;

  void hear(const BusFrame& frame, std::uint64_t tag, Time now) override;
  void advance(Time now) override;
  std::vector<Output> take_output() override { return std::exchange(output_, {}); }
  std::optional<Time> next_event() const override;

  // What a world does to it.
  void restart(Time now) override;
  void announce_emergency(std::uint16_t code, Time now) override;
  // As another port would write it; an abort code or 0.
  std::uint32_t poke(ObjectKey key, std::int64_t value, Time now);

  // What a world looks at.
  std::uint8_t node() const override { return node_; }
  NmtState state() const { return state_; }
  CanDevice& device() { return *device_; }
  CommunicationFacts& facts() { return facts_; }
  SdoServer& server() { return server_; }
  std::optional<CanBytes> peek(ObjectKey key, Time now);
  bool is_request(const BusFrame& frame) const override;  // SDO or guarding, to this node
  bool wants_answer(const BusFrame& request) const override;
  bool may_refuse(const BusFrame& request) const override;
  BusFrame refuse(const BusFrame& request, std::uint32_t code) override;
  BusFrame life_sign(CanView bytes) const override;
  std::string describe() const override { return device_->describe(); }

 private:
  static constexpr ObjectKey heartbeat_time{0x1017, 0};
  static constexpr std::uint16_t consumer_entries = 0x1016;
  struct Cell {
    std::uint32_t value;
    std::uint8_t width;
    bool writable;
  };
  using Cells = boost::unordered_flat_map<ObjectKey, Cell, ObjectKey::Hash>;
  struct Consumer {
    std::optional<Time> deadline;  // once a heartbeat was heard
  };

  ObjectReply read(ObjectKey key, Time now) override;
  std::uint32_t write(ObjectKey key, CanView bytes, std::uint64_t tag, Time now) override;
  std::uint32_t write_cell(Cell& cell, ObjectKey key, CanView bytes, Time now);
  std::uint32_t cell(ObjectKey key) const;
  void make_cells();
  bool own_index(std::uint16_t index) const;

  void enter(NmtState state, Time now);
  void begin_communication(Time now);
  void take_command(std::uint8_t command, Time now);
  void take_heartbeat(const BusFrame& frame, Time now);
  void answer_guarding(std::uint64_t tag, Time now);
  void watch(Time now);
  void lose_master(MasterLoss how, Time now);
  void watch_device(Time now);
  Time guarded_for() const;
  void send(BusFrame frame, std::uint64_t tag = 0, bool answer = false);
  void send_pdos(const std::vector<BusFrame>& frames, std::uint64_t tag);

  CommunicationFacts facts_;
  std::uint8_t node_;
  std::unique_ptr<CanDevice> device_;
  SdoServer server_;
  CanPdos pdos_;
  Cells cells_;
  Cells stored_;
  NmtState state_ = NmtState::pre_operational;
  bool toggle_ = false;
  Time next_heartbeat_{};
  std::optional<Time> guard_deadline_;
  std::vector<Consumer> consumers_;
  std::uint16_t error_ = 0;
  std::vector<std::uint32_t> history_;  // newest first
  std::uint64_t stores_ = 0;
  std::vector<Output> output_;
  Time now_{};
};

}  // namespace axisgate::simulated
