// SPDX-License-Identifier: Apache-2.0
// One axis as `axisgate enable`, `move`, `jog` and `stop` see it, and what they write: registers to words and numbers
// and back, for every kind of listener. Pure. Promises that a number is converted exactly, in turns and rpm for the
// person and in the listener's own form on the line, and that a value which is not good now is marked ('?'). Never
// decides what is written.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/commands/view/top_table.hpp"
#include "gateway/core/bytes.hpp"
#include "gateway/core/error.hpp"
#include "gateway/core/rational.hpp"
#include "gateway/image/axis_image.hpp"
#include "gateway/image/command.hpp"

namespace axisgate::commands {

/// The rows of an axis that are read at once: up to and with loss_stop_ms.
inline constexpr std::uint16_t kManualRegisters = 99;

/// How a listener shows its numbers.
struct ManualListener {
  WordOrder order = WordOrder::high_first;
  bool float_numbers = false;
};

struct ManualView {
  LinkState link = LinkState::unknown;
  AxisState state = AxisState::unknown;
  MotionState motion = MotionState::none;
  std::uint16_t motion_id = 0;
  std::uint16_t command_id_seen = 0;
  CommandResult result = CommandResult::none;
  std::uint32_t detail = 0;
  std::uint16_t owner = 0;  ///< register 28: nobody, this client, another
  std::uint32_t owner_address = 0;
  std::uint16_t lease_remaining_ms = 0;
  std::uint16_t error_code = 0;
  std::uint32_t alarms = 0;
  std::uint16_t loss_stop_ms = kLossNotKnown;
  Capabilities can{};
  std::optional<Rational> profile_rpm{};  ///< profile_velocity; none: no value
  std::optional<Rational> jog_rpm{};
  std::optional<Rational> rated_rpm{};
  std::uint16_t inputs = 0;  ///< discrete inputs, bit by bit
  Rational units_per_rev{10000};
  std::optional<double> turns;  ///< none: no value
  std::optional<double> rpm;
  bool turns_good = false;
  bool rpm_good = false;

  [[nodiscard]] bool has(AxisInput input) const { return (inputs & bit(input)) != 0; }
  [[nodiscard]] bool in_sight() const { return link == LinkState::online || link == LinkState::suspect; }
  [[nodiscard]] bool mine() const { return owner == 1; }
  [[nodiscard]] bool anothers() const { return owner == 2; }
};

/// `registers`: kManualRegisters of them, from the axis's first.
[[nodiscard]] ManualView manual_view(std::span<const std::uint16_t> registers, std::uint16_t inputs,
                                     const ManualListener& listener);
/// "10.0.0.7", of register 96; "another client" where it is 0.
[[nodiscard]] std::string owner_text(const ManualView& view);
/// One line without its end: where the axis is, how fast, and in which state.
[[nodiscard]] std::string manual_line(AxisNumber axis, const ManualView& view, std::string_view doing);

/// One write, in the words of the register map.
struct ManualWrite {
  enum class What : std::uint8_t { target_position, profile_velocity, jog_velocity, command, stop, coil, heartbeat };
  What what = What::command;
  Rational number{};                ///< turns, or rpm
  Command command = Command::none;  ///< of a command or a stop
  std::uint16_t id = 0;             ///< command_id, or the heartbeat's value
  std::uint16_t coil = 0;           ///< its offset
  bool on = false;
  friend bool operator==(const ManualWrite&, const ManualWrite&) = default;
};

/// The request that carries it. No value: the number does not fit its row.
[[nodiscard]] std::optional<std::vector<Byte>> manual_request(const ManualWrite& write, AxisNumber axis,
                                                              const ManualListener& listener,
                                                              const Rational& units_per_rev);
/// Device identification: the text of one object.
[[nodiscard]] std::vector<Byte> identification_request(std::uint8_t object);
/// Empty: there is none.
[[nodiscard]] std::string identification_in(Bytes reply);
[[nodiscard]] std::vector<Byte> read_registers_request(std::uint16_t address, std::uint16_t count);
[[nodiscard]] std::vector<Byte> read_inputs_request(std::uint16_t address, std::uint16_t count);
/// None: it is no such answer.
[[nodiscard]] std::optional<std::vector<std::uint16_t>> registers_in(Bytes reply, std::uint16_t count);
[[nodiscard]] std::optional<std::uint16_t> inputs_in(Bytes reply, std::uint16_t count);
[[nodiscard]] ModbusException exception_in(Bytes reply);
/// "exception 0x04 server device failure"
[[nodiscard]] std::string exception_text(ModbusException exception);

}  // namespace axisgate::commands
