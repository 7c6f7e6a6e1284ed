// SPDX-License-Identifier: Apache-2.0
// An iD286pro behind the shipped core, and its registers. Promises what every rig does. Never decides what is right:
// the tests do.
#pragma once

#include <string>

#include "tests/stage_drive/drive_rig.hpp"

namespace axisgate::test {

struct StepperOptions {
  simulated::Id286proOptions drive{};
  profile::ResolveAxis axis{};
};

/// A register (5).
inline constexpr std::uint16_t kControlRegister = 323;

class StepperRig : public DriveRig {
 public:
  explicit StepperRig(const StepperOptions& options = {});

  [[nodiscard]] simulated::Id286pro& motor() { return stage.id286pro(0); }
  void enable() { expect(code(command(Command::enable)) == Errc::ok, "not enabled"); }
  /// Runs at this velocity (0.001 rpm), and has reached it.
  void run_at(std::int64_t velocity);
  [[nodiscard]] static Errc code(const BatchResult& result) { return result.outcome.code; }
  BatchResult move_to(std::int64_t position);
  BatchResult mailbox_write(std::uint16_t address, std::uint8_t size, std::uint32_t data);
  BatchResult mailbox_read(std::uint16_t address, std::uint8_t size);

  /// The motion ends within a minute, however.
  bool motion_ends();
  /// The motor and its image stand within five seconds.
  bool stands();

  /// Since the last mark(), or since the beginning.
  [[nodiscard]] std::size_t writes();
  /// Requests that read this many registers from there.
  [[nodiscard]] std::size_t reads_of(std::uint16_t address, std::uint16_t registers);

  [[nodiscard]] bool has_command(Command command) {
    return (axis().supported_commands >> static_cast<unsigned>(command) & 1U) != 0;
  }
};

[[nodiscard]] inline bool reads(const AxisImage& axis, Quantity quantity, std::int64_t value) {
  return axis[quantity].valid && axis[quantity].value == value;
}

}  // namespace axisgate::test
