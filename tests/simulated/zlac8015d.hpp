// SPDX-License-Identifier: Apache-2.0
// One simulated ZLTECH ZLAC8015D on Modbus RTU: two motors behind one control word and one mode, as the maker's RS485
// routine tells (docs/drives/zlac8015d.md). Promises that enable, stop and alarm clear act on both motors, whoever
// meant one. Never reads a clock and never knows a line.
#pragma once

#include <array>

#include "tests/simulated/id286pro_motion.hpp"
#include "tests/simulated/register_slave.hpp"

namespace axisgate::simulated {

struct ZlacOptions {
  std::uint8_t unit = 1;
  std::map<std::uint16_t, std::int64_t> stored{};  // registers as they were saved before the world began
  std::array<Mechanics, 2> mechanics{};            // left, right
  Time answer_delay = std::chrono::milliseconds(1);
  Time boot_time = std::chrono::seconds(1);

  // Not in the routine, so tests may choose.
  std::int64_t ramp_speed_rpm = 1000;  // what a ramp's time goes to from 0
};

class Zlac8015d final : public RegisterSlave {
 public:
  enum class State : std::uint8_t { released, enabled, stopping, quick_stopped };
  static constexpr std::size_t left = 0, right = 1;

  explicit Zlac8015d(const ZlacOptions& options);

  std::uint8_t unit() const override { return options_.unit; }
  Time answer_delay() const override { return options_.answer_delay; }
  std::string describe() const override { return "zlac8015d@" + std::to_string(options_.unit); }

  // What a world does to it.
  void inject_fault(std::size_t motor, std::uint16_t bits);  // the cause stays until cleared
  void clear_fault_cause() { causes_ = {}; }
  void jam(std::size_t motor, bool jammed) { motors_.at(motor).axis.jam(jammed); }
  void numb(bool numb) { numb_ = numb; }  // commands are acknowledged, and none is carried out

  // What a world looks at.
  const ZlacOptions& options() const { return options_; }
  State state() const { return state_; }
  bool powered() const { return state_ != State::released && !faulted() && !booting(); }
  bool faulted() const { return faults_[left] != 0 || faults_[right] != 0; }
  std::int32_t position(std::size_t motor) const {
    return static_cast<std::int32_t>(counts_of(motors_.at(motor).axis.actual()));
  }
  const Axis& axis(std::size_t motor) const { return motors_.at(motor).axis; }
  std::int64_t counts_per_rev(std::size_t motor) const;

 private:
  struct Motor {
    Axis axis;
    Id286proMotion motion;
  };
  std::optional<std::int64_t> shown(std::uint16_t number) const override;
  void written(std::uint16_t number, std::int64_t value, std::uint64_t tag) override;
  void power_up() override;
  void step() override;
  bool at_rest() const override;
  void control(std::int64_t word);
  void start(std::size_t motor);
  void follow_speed(std::size_t motor);
  void stop(bool emergency);
  Dec speed_of(std::size_t motor, std::int64_t tenths) const;
  Dec ramp_of(std::size_t motor, std::uint16_t time_register) const;
  std::int64_t tenths_of_rpm(std::size_t motor) const;

  const ZlacOptions options_;
  std::array<Motor, 2> motors_;
  State state_ = State::released;
  std::array<std::uint16_t, 2> faults_{};
  std::array<std::uint16_t, 2> causes_{};
  bool numb_ = false;
};

}  // namespace axisgate::simulated
