// SPDX-License-Identifier: Apache-2.0
// One simulated frequency converter with a motor of two pole pairs, on Modbus RTU: a frequency without a sign, and the
// direction in the command word or in a register of its own, as most of them have it. Promises to follow each write at
// once, whatever it makes of the motor, and to remember every speed that it was told. Never reads a clock and never
// knows a line.
#pragma once

#include <vector>

#include "tests/simulated/register_slave.hpp"
#include "tests/simulated/units.hpp"

namespace axisgate::simulated {

struct InverterOptions {
  std::uint8_t unit = 1;
  Time answer_delay = std::chrono::milliseconds(1);
  Time boot_time = std::chrono::seconds(1);
};

class Inverter final : public RegisterSlave {
 public:
  enum Register : std::uint16_t {
    command = 0x2000,    // bits 0 and 1: 1 stop, 2 run; bits 4 and 5: 1 forward, 2 reverse, 0 as it was
    frequency = 0x2001,  // 0.01 Hz
    reset = 0x2002,
    direction = 0x2003,  // 1: reverse
    fault = 0x2100,
    status = 0x2101,  // bit 0 runs, bit 3 turns in reverse
    output = 0x2102,  // 0.01 Hz
  };
  static constexpr std::int64_t pole_pairs = 2;

  explicit Inverter(const InverterOptions& options);

  std::uint8_t unit() const override { return options_.unit; }
  Time answer_delay() const override { return options_.answer_delay; }
  std::string describe() const override { return "inverter@" + std::to_string(options_.unit); }

  void stop_at_panel() { runs_ = false; }  // the command word stays what it was

  // What a world looks at. In 0.01 Hz, with a sign.
  std::int64_t speed() const { return speed_; }
  // What it was told while it ran, each change of it, from 0 on.
  const std::vector<std::int64_t>& demands() const { return demands_; }
  bool runs() const { return runs_; }

 private:
  std::optional<std::int64_t> shown(std::uint16_t number) const override;
  void written(std::uint16_t number, std::int64_t value, std::uint64_t tag) override;
  void power_up() override;
  void step() override;
  bool at_rest() const override { return speed_ == demand(); }
  std::int64_t demand() const;

  const InverterOptions options_;
  bool runs_ = false;
  bool reverse_ = false;
  std::int64_t speed_ = 0;
  std::vector<std::int64_t> demands_;
};

}  // namespace axisgate::simulated
