// SPDX-License-Identifier: Apache-2.0
// One simulated Kinco JD or MD: objects, CiA 402 machine, inputs, motion, faults, EEPROM, as the sheets tell.
// Promises the same answers for the same requests at the same times, and a record of every write and every transition.
// Never reads a clock, never draws a random number, and never knows a line: SerialLine does.
#pragma once

#include <deque>
#include <optional>
#include <set>

#include "tests/simulated/axis.hpp"
#include "tests/simulated/digital_inputs.hpp"
#include "tests/simulated/drive_options.hpp"
#include "tests/simulated/motion.hpp"
#include "tests/simulated/ten_byte_frame.hpp"
#include "tests/simulated/transition.hpp"

namespace axisgate::simulated {

class KincoDrive {
 public:
  static constexpr std::size_t transition_limit = 10000;  // the oldest are forgotten
  static constexpr ObjectKey controlword{0x6040, 0};

  explicit KincoDrive(const DriveOptions& options);
  KincoDrive(const KincoDrive&) = delete;  // the axis refers to the mechanics in here
  KincoDrive& operator=(const KincoDrive&) = delete;

  // What the line needs.
  std::optional<TenByteFrame> answer(const TenByteFrame& request, std::uint64_t tag, Time now);
  // The same for a protocol that addresses objects otherwise. `raw` in the low `width` bytes.
  std::optional<std::int64_t> read(ObjectKey key, Time now);
  Refusal write(ObjectKey key, int width, std::uint32_t raw, std::uint64_t tag, Time now);
  const ObjectEntry* entry(ObjectKey key) const { return lacks_.contains(key) ? nullptr : objects_.find(key); }
  void advance(Time now);
  bool booting() const { return boot_until_.has_value(); }
  std::uint8_t station() const { return station_; }
  bool cascade() const { return cascade_; }
  std::uint32_t rs232_baud() const { return rs232_baud_; }
  bool rs485_speaks_kinco() const { return rs485_speaks_kinco_; }
  bool rs485_speaks_modbus() const { return !rs485_speaks_kinco_; }

  // What a world does to it.
  void restart(Time now);                                 // power off and on: RAM lost, silent for the boot time
  void inject_fault(int error_word, std::uint16_t bits);  // 1: 2601, 2: 2602; the cause stays until cleared
  void clear_fault_cause(int error_word, std::uint16_t bits);
  void trip(std::uint16_t word_1, std::uint16_t word_2) { raise_fault(word_1, word_2); }  // a fault whose cause is over
  void set_input(int input, bool high) { inputs_.set_pin(input, high); }
  void jam(bool jammed) { axis_.jam(jammed); }                             // the motor stands while the demand goes on
  void lack(std::set<ObjectKey> objects) { lacks_ = std::move(objects); }  // of another type or firmware: refused
  // A contact in the way of the torque: an enable is acknowledged, and is carried out when the contact closes, if the
  // controlword in effect still asks for it.
  void lock(bool locked);
  // It acknowledges controlwords and modes and carries none out; when it comes to, it carries out those in effect.
  void numb(bool numb);
  // It shows quick stop active and turns on at its target velocity, on a ramp too; when it comes to, it stops.
  void ignore_quick_stop(bool ignores);
  // As the panel or another port would write it: same effects, not counted. Measured values that nothing computes
  // (voltage, temperature) may be set too.
  Refusal poke(ObjectKey key, std::int64_t value);

  // What a world looks at.
  const KincoModel& model() const { return model_; }
  const DriveOptions& options() const { return options_; }
  Cia402State state() const { return state_; }
  std::uint16_t error_word(int number) const { return number == 1 ? error_1_ : error_2_; }  // 2601, 2602
  std::optional<std::int64_t> peek(ObjectKey key) const;
  std::uint64_t writes(ObjectKey key) const { return objects_.writes(key); }  // accepted over the bus
  std::uint64_t stores() const { return stores_; }                            // EEPROM writes done
  std::uint64_t restarts() const { return restarts_; }
  const std::deque<Transition>& transitions() const { return transitions_; }
  const Axis& axis() const { return axis_; }
  std::int32_t position() const { return static_cast<std::int32_t>(counts_of(axis_.actual())); }

 private:
  // kinco_drive.cpp: power, time
  void power_up();
  void tick(Time at);
  bool quiescent() const;
  void scan_inputs();
  void follow_motion();
  void supervise();
  void begin_store(Keep what);

  // kinco_drive_objects.cpp: reads and writes
  Refusal take_write(ObjectKey key, int width, std::uint32_t raw, std::uint64_t tag, bool counted);
  Refusal may_write(ObjectKey key, std::int64_t value) const;
  void written(ObjectKey key, std::int64_t value, std::uint64_t tag);
  void couple(ObjectKey key, std::int64_t value);
  void refresh_settings();

  // kinco_drive_control.cpp: controlword, modes, stops
  void take_controlword(std::uint16_t word, std::uint64_t tag);
  void obey(Cia402Command command, std::uint64_t tag);
  void leave_operation(Cia402Command command, Cia402State to, std::uint64_t tag);
  void operate(std::uint16_t rising, std::uint16_t falling);
  void change_state(Cia402State to, std::uint64_t tag);
  void set_mode(std::int64_t mode);
  void start_mode();
  void start_move(std::uint16_t word);
  void start_homing();
  void take_target_speed();
  bool follows_target() const;
  Dec option_deceleration(std::int64_t option) const;
  void raise_fault(std::uint16_t word_1, std::uint16_t word_2);
  void reset_fault(std::uint64_t tag);
  bool operating() const { return state_ == Cia402State::operation_enabled && !pending_; }
  Motion& commanded() { return halted_ ? *halted_ : motion_; }
  std::int64_t object(std::uint16_t index, std::uint8_t sub = 0) const { return objects_.get({index, sub}); }

  // kinco_drive_status.cpp: what it reports
  std::uint16_t statusword() const;
  FinePosition set_position() const;
  bool inside_position_window() const;
  bool target_reached() const;
  std::uint16_t outputs() const;
  std::optional<std::int64_t> measured(ObjectKey key) const;

  const DriveOptions options_;
  const KincoModel& model_;
  const std::int64_t encoder_counts_;
  ObjectDictionary objects_;
  std::set<ObjectKey> lacks_;
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
  Dec torque_command_ = 0;
  Dec current_ = 0;
  bool reference_found_ = false;
  bool homing_error_ = false;
  bool reset_input_ = false;
  bool locked_ = false;  // a user password was stored and has not been given since power-up (JD 1.4 point 6)
  std::uint16_t error_1_ = 0, error_2_ = 0;  // 2601 and 2602
  std::uint16_t cause_1_ = 0, cause_2_ = 0;  // still there
  std::int64_t sampled_rpm_ = 0;

  Time now_{};
  std::int64_t ticks_ = 0;
  Time outside_window_at_{};  // last time, for target reached
  std::optional<Time> boot_until_;
  std::optional<Time> store_until_;
  Keep store_what_ = Keep::eeprom;
  std::uint64_t stores_ = 0;
  std::uint64_t restarts_ = 0;
  std::deque<Transition> transitions_;

  std::uint8_t station_ = 1;
  bool cascade_ = false;
  std::uint32_t rs232_baud_ = 38400;
  bool rs485_speaks_kinco_ = true;
};

}  // namespace axisgate::simulated
