// SPDX-License-Identifier: Apache-2.0
// One simulated Leadshine LD2-CAN: objects, CiA 402 machine, units, motion, alarms, saving, as its manual tells.
// Promises the same answers for the same requests at the same times, and a record of every write and every transition.
// Never reads a clock, never draws a random number, and never speaks CiA 301: CanopenNode does.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>

#include "tests/simulated/axis.hpp"
#include "tests/simulated/canopen_node.hpp"
#include "tests/simulated/digital_inputs.hpp"
#include "tests/simulated/leadshine_objects.hpp"
#include "tests/simulated/motion.hpp"
#include "tests/simulated/transition.hpp"

namespace axisgate::simulated {

struct LeadshineOptions {
  std::uint8_t node = 1;                       // on the rotary switch
  std::uint32_t encoder_counts = 10000;        // 608Fh:01; a 2500-line encoder
  std::map<ObjectKey, std::int64_t> stored{};  // objects as they were saved before the world began
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

class LeadshineDrive final : public CanDevice {
 public:
  static constexpr std::size_t transition_limit = 10000;  // the oldest are forgotten
  static constexpr int input_count = 6;                   // SI1 to SI6; DI3 to DI6 exist (1)

  explicit LeadshineDrive(const LeadshineOptions& options);

  // What the node needs.
  ObjectReply read(ObjectKey key, Time now) override;
  std::uint32_t write(ObjectKey key, CanView bytes, std::uint64_t tag, Time now) override;
  bool may_be_mapped(ObjectKey key, PdoDirection direction) const override;
  std::uint32_t poke(ObjectKey key, std::int64_t value) override;
  void advance(Time now) override;
  void restart(Time now) override;
  bool booting() const override { return boot_until_.has_value(); }
  void connect() override {}
  void lose_master(MasterLoss how, Time now) override;
  std::uint16_t error_code() const override { return error_; }
  std::uint8_t error_register() const override;
  std::uint64_t stores() const override { return stores_; }
  std::string describe() const override { return "ld2@" + std::to_string(options_.node); }

  // What a world does to it.
  void inject_fault(std::uint16_t code);  // of 603Fh; the cause stays until cleared
  void clear_fault_cause() { cause_ = 0; }
  void set_input(int input, bool high) { inputs_.set_pin(input, high); }
  void jam(bool jammed) { axis_.jam(jammed); }  // the motor stands while the demand goes on
  // A contact in the way of the torque: an enable is acknowledged, and is carried out when the contact closes, if the
  // controlword in effect still asks for it.
  void lock(bool locked);
  // It acknowledges controlwords and modes and carries none out; when it comes to, it carries out those in effect.
  void numb(bool numb);
  // It shows quick stop active and turns on at its target velocity, on a ramp too; when it comes to, it stops.
  void ignore_quick_stop(bool ignores);

  // What a world looks at.
  const LeadshineOptions& options() const { return options_; }
  Cia402State state() const { return state_; }
  std::optional<std::int64_t> peek(ObjectKey key) const;
  std::uint64_t writes(ObjectKey key) const { return objects_.writes(key); }  // accepted over the bus
  std::uint64_t restarts() const { return restarts_; }
  const std::deque<Transition>& transitions() const { return transitions_; }
  const Axis& axis() const { return axis_; }
  std::int32_t position() const { return static_cast<std::int32_t>(units_of(axis_.actual())); }  // 6064h
  std::int64_t units_per_revolution() const;                                                     // P (4.1)

 private:
  static constexpr std::int64_t full_torque = 3000;  // 0.1 %; what the drive can give (3.5, 6072h)
  static constexpr std::int64_t save_word = 0x5A5A;

  // leadshine_drive.cpp: power, time
  void power_up();
  void tick(Time at);
  bool quiescent() const;
  void wire_inputs();
  void follow_motion();
  void supervise();
  void follow_torque();
  void finish_homing();

  // leadshine_access.cpp: reads, writes, units
  Refusal take_write(ObjectKey key, int width, std::uint32_t raw, std::uint64_t tag, bool counted);
  void written(ObjectKey key, std::int64_t value, std::uint64_t tag);
  void refresh_settings();
  bool known_index(std::uint16_t index) const;
  std::uint8_t highest_sub(std::uint16_t index) const;
  FinePosition fine_of(std::int64_t units) const;
  std::int64_t units_of(FinePosition position) const;
  Dec speed_of(std::int64_t units_per_s) const;
  Dec acceleration_of(std::int64_t units_per_s2) const;
  std::int64_t units_per_s_of(Dec speed) const;

  // leadshine_control.cpp: controlword, modes, stops, alarms
  void take_controlword(std::uint16_t word, std::uint64_t tag);
  void obey(Cia402Command command, std::uint64_t tag);
  void leave_operation(Cia402Command command, Cia402State to, std::uint64_t tag);
  void operate(std::uint16_t rising, std::uint16_t falling);
  void halt(std::uint16_t rising, std::uint16_t falling);
  void change_state(Cia402State to, std::uint64_t tag);
  void set_mode(std::int64_t mode);
  void start_mode();
  void start_move(std::uint16_t word);
  void start_homing();
  void take_target_speed();
  Dec stop_deceleration(std::int64_t option) const;
  void raise_fault(std::uint16_t code);
  void reset_fault(std::uint64_t tag);
  bool operating() const { return state_ == Cia402State::operation_enabled && !pending_; }
  Motion& commanded() { return halted_ ? *halted_ : motion_; }
  std::int64_t object(std::uint16_t index, std::uint8_t sub = 0) const { return objects_.get({index, sub}); }

  // leadshine_status.cpp: what it reports
  std::uint16_t statusword() const;
  bool target_reached() const;
  std::uint32_t input_word() const;
  std::int64_t torque_actual() const;
  std::optional<std::int64_t> measured(ObjectKey key) const;
  std::optional<std::int64_t> monitored(ObjectKey key) const;

  const LeadshineOptions options_;
  ObjectDictionary objects_;
  DigitalInputs inputs_;
  Axis axis_;
  Motion motion_;
  std::optional<Motion> halted_;  // what goes on when controlword bit 8 falls
  MotionSettings settings_;

  Cia402State state_ = Cia402State::not_ready_to_switch_on;
  std::optional<Cia402State> pending_;  // entered at standstill
  std::uint16_t controlword_ = 0;
  bool locked_out_ = false;
  bool numb_ = false;
  bool ignores_quick_stop_ = false;
  std::optional<std::uint16_t> unheard_;  // the controlword written while numb
  std::int64_t mode_ = 0;
  std::int64_t torque_demand_ = 0;  // in millionths of rated torque, on its slope
  Dec last_step_ = 0;               // change of speed in the last millisecond
  bool homed_ = false;
  bool homing_error_ = false;
  std::uint16_t error_ = 0;  // 603Fh
  std::uint16_t cause_ = 0;  // still there

  Time now_{};
  std::int64_t ticks_ = 0;
  Time inside_following_window_{};
  Time reached_until_{};
  std::optional<Time> boot_until_;
  std::optional<Time> store_until_;
  std::uint64_t stores_ = 0;
  std::uint64_t restarts_ = 0;
  std::deque<Transition> transitions_;
};

CommunicationFacts communication_of(const LeadshineOptions& options);

}  // namespace axisgate::simulated
