// SPDX-License-Identifier: Apache-2.0
// One simulated iD286pro: registers, built-in motion controller, inputs, faults, EEPROM, as its sheet tells.
// Promises the same answers for the same requests at the same times, and a record of every motion it began and why.
// Never reads a clock, never draws a random number, and never knows a line: RtuLine does.
#pragma once

#include <deque>
#include <set>

#include "tests/simulated/id286pro_inputs.hpp"
#include "tests/simulated/id286pro_motion.hpp"
#include "tests/simulated/id286pro_options.hpp"
#include "tests/simulated/rtu_slave.hpp"

namespace axisgate::simulated {

// A motion that began, and the request that caused it. Tag 0: an input did.
struct Id286proStart {
  Time at;
  std::uint64_t tag;
  std::uint16_t command;
};

class Id286pro final : public RtuSlave {
 public:
  static constexpr std::size_t start_limit = 10000;  // the oldest are forgotten
  enum class RunState : std::uint8_t { disabled = 1, stopped = 2, running = 3 };

  explicit Id286pro(const Id286proOptions& options);

  // What the line needs.
  RtuBytes answer(RtuView pdu, std::uint64_t tag, Time now) override;
  RtuBytes refusal(RtuView pdu, RtuException code) const override;
  void advance(Time now) override;
  void restart(Time now) override;  // power off and on: volatile registers at their defaults, position 0
  bool listens() const override { return !boot_until_; }
  std::uint8_t unit() const override { return unit_; }
  bool obeys_broadcast(std::uint8_t address) const override;
  Time answer_delay() const override { return options_.answer_delay; }
  int longest_pause() const override { return 15; }  // 1.5 characters
  std::string describe() const override { return "id286pro@" + std::to_string(options_.unit); }

  // What a world does to it.
  void lack(std::set<std::uint16_t> registers) { lacks_ = std::move(registers); }  // of another type: refused
  void inject_fault(std::uint16_t code, bool clearable = true);                    // the cause stays until cleared
  void clear_fault_cause() { cause_ = 0; }
  void numb(bool numb) { numb_ = numb; }  // commands and targets are acknowledged, and none is carried out
  void set_enable_switch(bool on);        // the hard-wired one: off frees the motor
  void set_input(int input, bool on);
  void jam(bool jammed) { axis_.jam(jammed); }               // the rotor stands; an open-loop drive does not see it
  RtuException poke(std::uint16_t row, std::int64_t value);  // as the maker's tool would write it: not counted

  // What a world looks at.
  const Id286proOptions& options() const { return options_; }
  RunState run_state() const;
  std::uint16_t fault() const { return fault_; }
  bool booting() const { return boot_until_.has_value(); }
  bool internal_pulses() const { return internal_; }  // the mode in effect, not the one in 0296
  std::optional<std::int64_t> peek(std::uint16_t row) const;
  const Id286proRegisters& registers() const { return registers_; }
  const Id286proInputs& inputs() const { return inputs_; }
  std::int32_t position() const { return static_cast<std::int32_t>(counts_of(axis_.demand())); }
  const Axis& axis() const { return axis_; }
  std::uint64_t restarts() const { return restarts_; }
  const std::deque<Id286proStart>& starts() const { return starts_; }

 private:
  // id286pro.cpp: power, time
  void power_up();
  void tick(Time at);
  bool quiescent() const;
  void scan_inputs();
  bool enabled() const;
  Id286proSignals signals() const;

  // id286pro_answers.cpp: reads and writes
  RtuBytes read(const RegisterRequest& request, RtuView pdu);
  RtuException write(const RegisterRequest& request, std::uint64_t tag);
  bool may_act(const Id286proRegisters::Change& change) const;
  void written(const Id286proRegisters::Change& change, std::uint64_t tag);
  std::optional<std::int64_t> measured(std::uint16_t row) const;
  std::int64_t motor_current() const;

  // id286pro_commands.cpp: 0323, 0206 and the inputs' functions
  bool can_obey(std::uint16_t command) const;
  void obey(std::uint16_t command, std::uint64_t tag);
  void obey_user_command(std::int64_t command);
  void clear_alarm();
  Id286proProfile profile(std::int64_t speed) const;
  Dec speed_of(std::int64_t hundredths) const;
  Dec acceleration_of(std::int64_t revolutions) const;

  const Id286proOptions options_;
  Id286proRegisters registers_;
  Id286proInputs inputs_;
  Axis axis_;
  Id286proMotion motion_;

  std::uint8_t unit_ = 1;
  bool internal_ = true;
  bool enable_switch_ = true;
  bool numb_ = false;
  std::uint16_t fault_ = 0;
  std::uint16_t cause_ = 0;
  bool clearable_ = true;
  bool origin_command_ = false;  // 0323 = 11: an origin signal for one millisecond
  std::int64_t voltage_ = 4800;

  Time now_{};
  std::int64_t ticks_ = 0;
  Time moved_at_{};
  std::optional<Time> boot_until_;
  std::optional<Time> restart_at_;
  std::uint64_t restarts_ = 0;
  std::deque<Id286proStart> starts_;
  std::set<std::uint16_t> lacks_;
};

}  // namespace axisgate::simulated
