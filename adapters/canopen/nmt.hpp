// SPDX-License-Identifier: Apache-2.0
// Network management frames (CiA 301 sections 7.2.8.2 and 7.2.8.3): commands, boot-up, heartbeat, guarding answers.
// Promises that a command has exactly two bytes (LD2-CAN C10: longer ones in its examples are misprints), and that
// states a node only passes through are still taken for a sign of life.
// Never knows what state a node is in: that is its watch's question.
#pragma once

#include <optional>

#include "adapters/bus/exchange.hpp"
#include "adapters/can/can_frame.hpp"

namespace axisgate::canopen {

using bus::NmtCommand;

/// No value: no command.
[[nodiscard]] std::optional<NmtCommand> nmt_command(std::uint32_t code);
/// `node` 0: all nodes.
[[nodiscard]] can::CanFrame nmt_frame(NmtCommand command, std::uint8_t node);
/// Node guarding: a remote frame for the one byte of the answer.
[[nodiscard]] can::CanFrame guard_frame(std::uint8_t node);

struct ErrorControl {
  bool boot_up = false;
  bool toggle = false;  ///< of a guarding answer
  bus::NodeState state = bus::NodeState::unknown;
  friend bool operator==(const ErrorControl&, const ErrorControl&) = default;
};
/// No value: not exactly one byte, or no state that CiA 301 has.
[[nodiscard]] std::optional<ErrorControl> decode_error_control(Bytes bytes);

/// Ours.
[[nodiscard]] can::CanFrame boot_up_frame(std::uint8_t node);
[[nodiscard]] can::CanFrame operational_heartbeat_frame(std::uint8_t node);

}  // namespace axisgate::canopen
