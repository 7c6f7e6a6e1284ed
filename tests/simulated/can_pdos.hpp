// SPDX-License-Identifier: Apache-2.0
// The PDOs of a CANopen node: their communication and mapping objects (1400h, 1600h, 1800h, 1A00h and on), what is sent
// when, and what a received one writes (CiA 301 7.2.2, 7.5.2.35 to 7.5.2.38).
// Promises that a mapping changes only in pre-operational, while its PDO is off and has no entries, and that nothing is
// sent or taken but between start() and stop(). Never knows a state beside that.
#pragma once

#include <array>
#include <optional>

#include "tests/simulated/can_device.hpp"

namespace axisgate::simulated {

struct PdoFacts {
  int count = 4;               // in each direction; the predefined connection set has identifiers for four
  bool event_timer = false;    // sub 5
  bool takes_type_254 = true;  // not the LD2-CAN (C11)
  std::uint8_t type = 254;     // as delivered
  Time inhibit_unit = std::chrono::microseconds(100);
  bool on_change = true;        // of its values; else sub 5 alone sends it
  bool free_mapping = false;    // entries change while the PDO is valid and has some
  bool receive_timers = false;  // subs 3 to 5 of an RPDO too
  bool compatibility = false;   // sub 4, which does nothing
  std::size_t entries = 8;      // of a mapping
  // PDOs as delivered, from the first on; the rest have no entries.
  struct Delivered {
    std::uint16_t event;
    std::uint8_t mapped;
    std::vector<std::uint32_t> map;
  };
  std::vector<Delivered> receive{};
  std::vector<Delivered> transmit{};
};

class CanPdos {
 public:
  static constexpr std::size_t longest_map = 8;

  CanPdos(const PdoFacts& facts, std::uint8_t node);

  bool has(ObjectKey key) const;
  ObjectReply read(ObjectKey key) const;
  std::uint32_t write(ObjectKey key, CanView bytes, bool preoperational, CanDevice& device, Time now);

  void start(Time now);
  void stop() { running_ = false; }
  // What is due to be sent: values that changed, looked at once in each millisecond, and event timers.
  std::vector<BusFrame> due(CanDevice& device, Time now);
  std::vector<BusFrame> sync(CanDevice& device, std::uint64_t tag, Time now);
  std::optional<BusFrame> asked_for(std::uint32_t id, CanDevice& device, Time now);
  // Is it an RPDO of this node?
  bool take(const BusFrame& frame, CanDevice& device, std::uint64_t tag, Time now);
  // When due() must look again.
  std::optional<Time> next_look(Time now) const;

  void store() { stored_ = settings_; }
  void power_up() { settings_ = stored_; }

 private:
  struct Pdo {
    std::uint32_t cob_id = 0;
    std::uint8_t type = 0;
    std::uint16_t inhibit = 0;
    std::uint16_t event = 0;
    std::uint8_t reserved = 0;
    std::uint8_t mapped = 0;
    std::array<std::uint32_t, longest_map> map{};
    bool valid() const { return (cob_id & 0x80000000U) == 0; }
    std::uint32_t id() const { return cob_id & 0x7FFU; }
  };
  struct Settings {
    std::vector<Pdo> receive, transmit;
  };
  struct Sending {
    BusFrame last;
    bool sent = false;
    Time at{};
    int syncs = 0;
  };
  struct Place {
    bool transmit;
    bool mapping;
    std::size_t number;
  };
  struct Waiting {
    std::size_t number;
    CanBytes bytes;
  };

  static void deliver(Pdo& pdo, const std::vector<PdoFacts::Delivered>& facts, std::size_t number);
  bool has_timers(const Place& place) const { return place.transmit ? facts_.event_timer : facts_.receive_timers; }
  std::optional<Place> place_of(ObjectKey key) const;
  const Pdo& pdo_at(const Place& place) const;
  std::uint32_t write_parameter(Pdo& pdo, const Place& place, std::uint8_t sub, std::uint32_t value, std::size_t size);
  std::uint32_t write_mapping(Pdo& pdo, const Place& place, std::uint8_t sub, std::uint32_t value, CanDevice& device,
                              Time now);
  static BusFrame frame_of(const Pdo& pdo, CanDevice& device, Time now);
  static void put_values(const Pdo& pdo, CanView bytes, CanDevice& device, std::uint64_t tag, Time now);
  BusFrame send(std::size_t number, const BusFrame& frame, Time now);
  bool by_event(const Pdo& pdo) const { return pdo.valid() && pdo.mapped > 0 && pdo.type >= 254; }

  PdoFacts facts_;
  Settings settings_;
  Settings stored_;
  std::vector<Sending> sending_;
  std::vector<Waiting> waiting_;  // received, and due with the next SYNC
  Time looked_{};                 // for changes
  bool running_ = false;
};

}  // namespace axisgate::simulated
