// SPDX-License-Identifier: Apache-2.0
// One simulated iD286pro behind the shipped core, with the words in which these tests speak. Promises a fresh world per
// rig. Never decides what is right: the tests do.
#pragma once

#include <string>

#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {

struct StepperOptions {
  simulated::Id286proOptions drive{};
  drive::ResolveAxis axis{};
};

/// Registers (5).
inline constexpr std::uint16_t kSpeedRegister = 307, kControlRegister = 323;

class StepperRig {
 public:
  explicit StepperRig(StepperOptions options = {});

  GatewayStage stage;

  [[nodiscard]] const AxisImage& axis() { return stage.axis(1); }
  [[nodiscard]] simulated::Id286pro& motor();
  [[nodiscard]] simulated::DriveFaults& faults();

  void online();
  void enable();
  /// Runs at this velocity (0.001 rpm), and has reached it.
  void run_at(std::int64_t velocity);
  [[nodiscard]] static Errc code(const BatchResult& result) { return result.outcome.code; }
  BatchResult command(Command command) { return stage.command(1, command); }
  BatchResult write(Quantity quantity, std::int64_t value) { return stage.write(1, quantity, value); }
  BatchResult ask(const WriteBatch& batch) { return stage.ask(1, batch); }
  BatchResult move_to(std::int64_t position);
  BatchResult move_by(std::int64_t distance);
  BatchResult mailbox_write(std::uint16_t address, std::uint8_t size, std::uint32_t data);
  BatchResult mailbox_read(std::uint16_t address, std::uint8_t size);

  /// The motion ends within a minute, however.
  bool motion_ends();
  /// The motor and its image stand within five seconds.
  bool stands();
  void cut();
  void plug();

  /// What reached the wire since the last mark(), or since the beginning.
  void mark();
  [[nodiscard]] std::size_t writes();
  /// Requests that read this many registers from there.
  [[nodiscard]] std::size_t reads_of(std::uint16_t address, std::uint16_t registers);

  [[nodiscard]] bool has_command(Command command) {
    return (axis().supported_commands >> static_cast<unsigned>(command) & 1U) != 0;
  }
  [[nodiscard]] bool has_event(EventKind kind, const std::string& part);

 private:
  std::size_t marked_ = 0;
};

[[nodiscard]] inline bool reads(const AxisImage& axis, Quantity quantity, std::int64_t value) {
  return axis[quantity].valid && axis[quantity].value == value;
}

}  // namespace axisgate::test
