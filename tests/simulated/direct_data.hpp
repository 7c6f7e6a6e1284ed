// SPDX-License-Identifier: Apache-2.0
// One simulated stepper drive that is told a whole motion by one request: way of operation, position, speed, ramps and
// a trigger behind one another, as Oriental Motor's AZ has its direct data operation (0058h to 0067h). Promises that a
// trigger starts what came in its own request, and nothing else. Never reads a clock and never knows a line.
#pragma once

#include "tests/simulated/id286pro_motion.hpp"
#include "tests/simulated/register_slave.hpp"

namespace axisgate::simulated {

struct DirectDataOptions {
  std::uint8_t unit = 1;
  Time answer_delay = std::chrono::milliseconds(1);
  Time boot_time = std::chrono::seconds(1);
};

class DirectData final : public RegisterSlave {
 public:
  // All but the inputs and outputs are pairs, the high register first.
  enum Register : std::uint16_t {
    data_number = 0x0058,
    way = 0x005A,            // 1: absolute
    position = 0x005C,       // steps
    speed = 0x005E,          // Hz
    starting_rate = 0x0060,  // 0.001 kHz/s
    stopping_rate = 0x0062,
    current = 0x0064,  // 0.1 %
    trigger = 0x0066,  // 1: all of it
    inputs = 0x007D,   // bit 5 stop, bit 6 free, bit 7 alarm reset
    outputs = 0x007F,  // bit 5 ready, bit 7 alarm, bit 13 moves
    alarm = 0x0080,
    actual_position = 0x00CC,
    actual_speed = 0x00CE,
  };
  static constexpr std::int64_t steps_per_rev = 1000;

  explicit DirectData(const DirectDataOptions& options);

  std::uint8_t unit() const override { return options_.unit; }
  Time answer_delay() const override { return options_.answer_delay; }
  std::string describe() const override { return "direct-data@" + std::to_string(options_.unit); }

  // What a world looks at.
  std::int64_t place() const { return counts_of(axis_.actual()); }
  bool moves() const { return motion_.running(); }
  std::uint64_t starts() const { return starts_; }

 private:
  std::optional<std::int64_t> shown(std::uint16_t number) const override;
  void written(std::uint16_t number, std::int64_t value, std::uint64_t tag) override;
  void power_up() override;
  void step() override;
  bool at_rest() const override { return !motion_.running() && axis_.speed() == 0; }
  bool enabled() const { return !booting() && (held(inputs) & 0x40) == 0; }
  Dec fine_per_ms(std::int64_t hertz) const { return divide_rounded(hertz * fine_per_count, 1000); }
  void start(std::uint64_t tag);

  const DirectDataOptions options_;
  Mechanics mechanics_{};
  Axis axis_;
  Id286proMotion motion_;
  std::map<std::uint16_t, std::uint64_t> tags_;  ///< of the request that wrote it last
  std::uint64_t starts_ = 0;
};

}  // namespace axisgate::simulated
