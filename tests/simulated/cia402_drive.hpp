// SPDX-License-Identifier: Apache-2.0
// What simulated drives with CiA 402's machine have in common: power and boot, one millisecond after the other, the
// controlword, stops that end in another state, modes, halt and homing. What differs by drive is in Cia402Facts, or
// asked of the drive. Promises the same answers for the same requests at the same times, and a record of every
// transition. Never reads a clock, never draws a random number, and never knows how its objects are reached.
#pragma once

#include <deque>
#include <optional>
#include <set>

#include "tests/simulated/axis.hpp"
#include "tests/simulated/digital_inputs.hpp"
#include "tests/simulated/motion.hpp"
#include "tests/simulated/transition.hpp"

namespace axisgate::simulated {

// In which points a drive's machine is its own.
struct Cia402Facts {
  std::int64_t encoder_counts;
  int inputs;
  Time boot_time;
  Time store_time;
  std::uint16_t fault_reset_word;   // these bits must be 1, and bit 7 rising
  bool needs_shutdown_first;        // a 0x0F before the first 0x06 does nothing
  bool shutdown_leaves_quick_stop;  // a 0x06 does so while the drive stops
  bool stands_released_at_once;     // a motor that stands: the state changes with the request, not with the next look
  bool takes_new_speed_while_on;    // 60FF acts as it is written
};

class Cia402Drive {
 public:
  static constexpr std::size_t transition_limit = 10000;  // the oldest are forgotten

  Cia402Drive(const Cia402Drive&) = delete;  // the axis refers to the mechanics of the drive
  Cia402Drive& operator=(const Cia402Drive&) = delete;
  virtual ~Cia402Drive() = default;

  // What a line needs.
  const ObjectEntry* entry(ObjectKey key) const { return lacks_.contains(key) ? nullptr : objects_.find(key); }
  void advance(Time now);
  bool booting() const { return boot_until_.has_value(); }
  std::uint64_t stores() const { return stores_; }  // EEPROM writes done

  // What a world does to it.
  void restart(Time now);  // off and on: RAM lost, silent for the boot time
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
  // Its velocity (606C) has noise, and is told late.
  void blur_speed(std::int64_t noise_rpm, Time late) {
    axis_.blur(speed_dec(noise_rpm, facts_.encoder_counts), static_cast<std::size_t>(late / one_millisecond));
  }
  // As the panel or another port would write it: same effects, not counted. Measured values that nothing computes
  // (voltage, temperature) may be set too.
  Refusal poke(ObjectKey key, std::int64_t value);

  // What a world looks at.
  Cia402State state() const { return state_; }
  std::optional<std::int64_t> peek(ObjectKey key) const;
  std::int64_t value_of(const ObjectEntry& entry) const;                      // of one that it has
  std::uint64_t writes(ObjectKey key) const { return objects_.writes(key); }  // accepted over the bus
  std::uint64_t restarts() const { return restarts_; }
  const std::deque<Transition>& transitions() const { return transitions_; }
  const Axis& axis() const { return axis_; }
  int input_count() const { return facts_.inputs; }
  virtual std::int32_t position() const = 0;  // as the drive counts it

 protected:
  Cia402Drive(const Cia402Facts& facts, const Mechanics& mechanics, ObjectDictionary objects)
      : facts_(facts),
        mechanics_(mechanics),
        objects_(std::move(objects)),
        inputs_(facts.inputs),
        axis_(mechanics_, facts.encoder_counts) {}

  // What the drive does at these moments.
  virtual void power_up() = 0;
  virtual bool rests() const { return true; }  // beside what is looked at here
  virtual void before_step() = 0;              // inputs, for example
  virtual void after_step(Dec speed_before) = 0;
  virtual void supervise() = 0;
  virtual void store_now() = 0;
  virtual void reset_fault(std::uint64_t tag) = 0;
  virtual void start_mode() = 0;
  virtual void start_move(std::uint16_t word) = 0;
  virtual void start_homing() = 0;
  virtual void finish_homing() = 0;
  // A controlword that did not find it operating, or did not leave it so.
  virtual void heard_beside_operation(std::uint16_t rising) = 0;
  virtual void halt_ended() {}
  // What it has.
  virtual int direction() const = 0;
  virtual bool can_halt() const = 0;
  virtual bool follows_target() const { return false; }
  virtual Dec target_speed() const = 0;
  virtual Dec halt_deceleration() const = 0;
  struct Stop {
    Dec deceleration;
    bool stays;  // in quick stop
  };
  virtual std::optional<Stop> stop_of(Cia402Command command) const = 0;  // none: the torque goes at once
  virtual std::optional<std::int64_t> measured(ObjectKey key) const = 0;
  virtual Refusal take_write(ObjectKey key, int width, std::uint32_t raw, std::uint64_t tag, bool counted) = 0;

  void begin_store() { store_until_ = now_ + facts_.store_time; }
  void take_controlword(std::uint16_t word, std::uint64_t tag);
  void obey(Cia402Command command, std::uint64_t tag);
  void change_state(Cia402State to, std::uint64_t tag);
  void halt(std::uint16_t rising, std::uint16_t falling);
  void set_mode(std::int64_t mode);
  void take_target_speed();
  void enter_fault(std::optional<Dec> deceleration);
  bool operating() const { return state_ == Cia402State::operation_enabled && !pending_; }
  Motion& commanded() { return halted_ ? *halted_ : motion_; }
  std::int64_t object(std::uint16_t index, std::uint8_t sub = 0) const { return objects_.get({index, sub}); }
  Dec full_acceleration() const;
  std::uint16_t heard_controlword() const { return unheard_.value_or(controlword_); }

  const Cia402Facts facts_;
  const Mechanics mechanics_;
  ObjectDictionary objects_;
  DigitalInputs inputs_;
  Axis axis_;
  Motion motion_;
  std::optional<Motion> halted_;  // what goes on when controlword bit 8 falls
  MotionSettings settings_;
  Cia402State state_ = Cia402State::not_ready_to_switch_on;
  std::uint16_t controlword_ = 0;
  std::int64_t mode_ = 0;
  bool homed_ = false;
  bool homing_error_ = false;
  Time now_{};
  std::int64_t ticks_ = 0;

 private:
  void tick(Time at);
  bool quiescent() const;
  void boot_by(Time at);
  void follow_motion();
  void leave_operation(Cia402Command command, Cia402State to, std::uint64_t tag);
  void operate(std::uint16_t rising, std::uint16_t falling);

  std::set<ObjectKey> lacks_;
  std::optional<Cia402State> pending_;  // entered at standstill
  bool locked_out_ = false;
  bool numb_ = false;
  bool ignores_quick_stop_ = false;
  std::optional<std::uint16_t> unheard_;  // the controlword written while numb
  std::optional<Time> boot_until_;
  std::optional<Time> store_until_;
  std::uint64_t stores_ = 0;
  std::uint64_t restarts_ = 0;
  std::deque<Transition> transitions_;
};

}  // namespace axisgate::simulated
