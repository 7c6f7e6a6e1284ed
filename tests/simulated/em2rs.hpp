// SPDX-License-Identifier: Apache-2.0
// One simulated Leadshine EM2RS (open loop) or CS2RS (closed loop), also sold by StepperOnline as DM-RS and CL-RS:
// registers, one path of its PR controller, inputs, faults, as public lists of its registers tell (docs/drives).
// Promises the same answers for the same requests at the same times. Never reads a clock and never knows a line.
#pragma once

#include <array>

#include "tests/simulated/id286pro_motion.hpp"
#include "tests/simulated/register_slave.hpp"

namespace axisgate::simulated {

struct Em2rsOptions {
  std::uint8_t unit = 1;
  bool closed_loop = false;                        // a CS2RS
  bool input_enables = false;                      // as delivered: DI1 is enable, closed by default (0145h = 88h)
  std::map<std::uint16_t, std::int64_t> stored{};  // other registers as they were saved before the world began
  // Places in pulses. A switch is wired to each input that has its function: 25h positive limit, 26h negative limit,
  // 27h home; closed beyond its place, or between home_from and home_to.
  Mechanics mechanics{};
  Time answer_delay = std::chrono::milliseconds(1);
  Time boot_time = std::chrono::seconds(1);
};

class Em2rs final : public RegisterSlave {
 public:
  static constexpr int inputs = 7;

  explicit Em2rs(const Em2rsOptions& options);

  void restart(Time now) override;
  std::uint8_t unit() const override { return options_.unit; }
  Time answer_delay() const override { return options_.answer_delay; }
  std::string describe() const override;

  // What a world does to it.
  void inject_fault(std::uint16_t code);  // the cause stays until cleared
  void clear_fault_cause() { cause_ = 0; }
  void set_input(int input, bool closed);
  void jam(bool jammed) { axis_.jam(jammed); }
  void numb(bool numb) { numb_ = numb; }  // commands are acknowledged, and none is carried out

  // What a world looks at.
  const Em2rsOptions& options() const { return options_; }
  bool enabled() const;
  bool running() const { return motion_.running(); }
  std::uint16_t fault() const { return fault_; }
  std::int32_t position() const { return static_cast<std::int32_t>(counts_of(axis_.actual())); }
  const Axis& axis() const { return axis_; }
  std::int64_t pulses_per_rev() const { return held(0x0001); }

 private:
  std::optional<std::int64_t> shown(std::uint16_t number) const override;
  void written(std::uint16_t number, std::int64_t value, std::uint64_t tag) override;
  void was_read(std::uint16_t number) override;
  void power_up() override;
  void step() override;
  bool at_rest() const override;
  void follow_switches();
  bool active(std::uint16_t function) const;
  void trigger(std::int64_t value);
  void run_path(std::uint16_t path);
  void home();
  std::int64_t status() const;
  std::int64_t rpm_of(Dec speed) const;
  Dec speed_of(std::int64_t rpm) const;
  Dec ramp_of(std::int64_t ms_per_1000_rpm) const;

  const Em2rsOptions options_;
  Axis axis_;
  Id286proMotion motion_;  // a trapezoid with the same four ways of homing
  std::array<bool, inputs> closed_{};
  bool path_completed_ = true;
  bool homed_ = false;
  bool homing_ = false;
  bool stopping_ = false;
  bool numb_ = false;
  std::uint16_t fault_ = 0;
  std::uint16_t cause_ = 0;
  std::int64_t save_status_ = 0x1111;
};

}  // namespace axisgate::simulated
