// SPDX-License-Identifier: Apache-2.0
// One simulated Leadshine LD2-CAN: what it adds to CiA 402's machine, as its manual tells: objects, units, alarms,
// saving. Promises the same answers for the same requests at the same times. Never reads a clock, never draws a random
// number, and never speaks CiA 301: CanopenNode does.
#pragma once

#include <map>

#include "tests/simulated/canopen_node.hpp"
#include "tests/simulated/cia402_drive.hpp"
#include "tests/simulated/leadshine_objects.hpp"

namespace axisgate::simulated {

struct LeadshineOptions {
  std::uint8_t node = 1;                       // on the rotary switch
  std::uint32_t encoder_counts = 10000;        // 608Fh:01; a 2500-line encoder
  std::map<ObjectKey, std::int64_t> stored{};  // objects as they were saved before the world began
  std::map<ObjectKey, std::uint32_t> more{};   // of another drive of CiA 402: read-only, four bytes
  Mechanics mechanics{};

  // Not in the manual, or printed in two ways (LD2 8, 9), so tests may choose.
  Time boot_time = std::chrono::seconds(1);
  Time store_time = std::chrono::milliseconds(50);
  bool acknowledges_setpoints = false;  // statusword bit 12 in profile position; "not valid" (C5)
  Time reached_falls{};                 // so long after its start a move still shows bit 10 of the one before (5.2)
  bool ready_flag = true;               // 3001h tells 20h before the start of an immediate move (Appendix E)
  bool needs_halt_edge = false;         // profile velocity starts with the end of a halt alone (C12)
  std::int64_t mode = 8;                // 6060h at power-up: 8 or 0 (C6)
  bool sends_emergencies = true;        // of drive alarms, with the value of 603Fh
  bool stops_without_master = true;     // alarm 903 when a consumed heartbeat stays away
  bool leaves_operational_on_loss = true;
  bool segmented = true;
  bool block = false;
  bool event_timer = false;                                // sub 5 of 1800h is not mentioned
  std::uint32_t mismatch_abort = 0x06070010;               // printed 06060010 (C8)
  std::set<ObjectKey> unmappable{};                        // mappability is printed for few objects
  std::array<std::uint32_t, 4> identity{0x4321, 1, 1, 1};  // 1018h is not mentioned
  std::string name = "LD2-CAN7010";                        // nor is 1008h
};

class LeadshineDrive final : public CanDevice, public Cia402Drive {
 public:
  explicit LeadshineDrive(const LeadshineOptions& options);

  // What the node needs.
  ObjectReply read(ObjectKey key, Time now) override;
  std::optional<std::uint32_t> mapped(ObjectKey key, Time now) override;
  std::uint32_t write(ObjectKey key, CanView bytes, std::uint64_t tag, Time now) override;
  bool may_be_mapped(ObjectKey key, PdoDirection direction) const override;
  std::uint32_t poke(ObjectKey key, std::int64_t value) override { return abort_of(Cia402Drive::poke(key, value)); }
  void advance(Time now) override { Cia402Drive::advance(now); }
  void restart(Time now) override;
  bool booting() const override { return Cia402Drive::booting(); }
  void connect() override {}
  void lose_master(MasterLoss how, Time now) override;
  std::uint16_t error_code() const override { return error_; }
  std::uint8_t error_register() const override;
  std::uint64_t stores() const override { return Cia402Drive::stores(); }
  std::string describe() const override { return "ld2@" + std::to_string(options_.node); }

  // What a world does to it.
  void inject_fault(std::uint16_t code);  // of 603Fh; the cause stays until cleared
  void clear_fault_cause() { cause_ = 0; }

  // What a world looks at.
  const LeadshineOptions& options() const { return options_; }
  std::int32_t position() const override { return static_cast<std::int32_t>(units_of(axis_.actual())); }  // 6064h
  std::int64_t units_per_revolution() const;                                                              // P (4.1)

 private:
  static constexpr std::int64_t full_torque = 3000;  // 0.1 %; what the drive can give (3.5, 6072h)
  static constexpr std::int64_t save_word = 0x5A5A;

  // leadshine_drive.cpp: power, time
  void power_up() override;
  void store_now() override;
  bool rests() const override { return !inputs_.active(InputFunction::emergency_stop); }
  void wire_inputs();
  void before_step() override;
  void after_step(Dec speed_before) override { last_step_ = axis_.speed() - speed_before; }
  void supervise() override;
  void follow_torque();
  void finish_homing() override;

  // leadshine_access.cpp: reads, writes, units
  Refusal take_write(ObjectKey key, int width, std::uint32_t raw, std::uint64_t tag, bool counted) override;
  void written(ObjectKey key, std::int64_t value, std::uint64_t tag);
  void refresh_settings();
  std::uint8_t highest_sub(std::uint16_t index) const;
  FinePosition fine_of(std::int64_t units) const;
  std::int64_t units_of(FinePosition position) const;
  Dec speed_of(std::int64_t units_per_s) const;
  Dec acceleration_of(std::int64_t units_per_s2) const;
  std::int64_t units_per_s_of(Dec speed) const;

  // leadshine_control.cpp: modes, stops, alarms
  void heard_beside_operation(std::uint16_t rising) override;
  bool can_halt() const override { return true; }
  void halt_ended() override;
  int direction() const override { return (object(0x607E) & 0x80) != 0 ? -1 : 1; }
  void start_mode() override;
  void start_move(std::uint16_t word) override;
  void start_homing() override;
  Dec target_speed() const override { return speed_of(object(0x60FF)); }
  Dec stop_deceleration(std::int64_t option) const;
  Dec halt_deceleration() const override { return stop_deceleration(object(0x605D)); }
  std::optional<Stop> stop_of(Cia402Command command) const override;
  void raise_fault(std::uint16_t code);
  void reset_fault(std::uint64_t tag) override;

  // leadshine_status.cpp: what it reports
  std::uint16_t statusword() const;
  bool target_reached() const;
  std::uint32_t input_word() const;
  std::int64_t torque_actual() const;
  std::optional<std::int64_t> measured(ObjectKey key) const override;
  std::optional<std::int64_t> monitored(ObjectKey key) const;

  const LeadshineOptions options_;
  std::int64_t torque_demand_ = 0;  // in millionths of rated torque, on its slope
  Dec last_step_ = 0;               // change of speed in the last millisecond
  std::uint16_t error_ = 0;         // 603Fh
  std::uint16_t cause_ = 0;         // still there
  Time inside_following_window_{};
  Time reached_until_{};
};

CommunicationFacts communication_of(const LeadshineOptions& options);

}  // namespace axisgate::simulated
