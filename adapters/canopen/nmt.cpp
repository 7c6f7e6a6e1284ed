// SPDX-License-Identifier: Apache-2.0
#include "adapters/canopen/nmt.hpp"

#include <array>

#include "adapters/canopen/cob_id.hpp"

namespace axisgate::canopen {

namespace {

constexpr Byte kBootUp = 0;
constexpr Byte kStopped = 4;
constexpr Byte kOperational = 5;
constexpr Byte kPreOperational = 127;
/// Disconnected, connecting, preparing: states of CAL's guarding that some manuals still list (JD 2.3, LD2-CAN 2.5).
constexpr Byte kFirstPassing = 1;
constexpr Byte kLastPassing = 3;
constexpr Byte kToggleBit = 0x80;

can::CanFrame error_control_frame(std::uint8_t node, Byte state) {
  return can::data_frame(error_control_id(node), std::array{state});
}

}  // namespace

std::optional<NmtCommand> nmt_command(std::uint32_t code) {
  for (const NmtCommand command : {NmtCommand::start, NmtCommand::stop, NmtCommand::enter_pre_operational,
                                   NmtCommand::reset_node, NmtCommand::reset_communication}) {
    if (code == static_cast<std::uint32_t>(command)) return command;
  }
  return std::nullopt;
}

can::CanFrame nmt_frame(NmtCommand command, std::uint8_t node) {
  return can::data_frame(kNmtId, std::array{static_cast<Byte>(command), node});
}

can::CanFrame guard_frame(std::uint8_t node) { return can::remote_frame(error_control_id(node), 1); }

std::optional<ErrorControl> decode_error_control(Bytes bytes) {
  if (bytes.size() != 1) return std::nullopt;  // a node that babbles under its id has not started anew
  if (bytes[0] == kBootUp) return ErrorControl{.boot_up = true, .state = bus::NodeState::pre_operational};
  ErrorControl heard{.toggle = (bytes[0] & kToggleBit) != 0};
  switch (const Byte state = bytes[0] & 0x7F; state) {
    case kStopped:
      heard.state = bus::NodeState::stopped;
      return heard;
    case kOperational:
      heard.state = bus::NodeState::operational;
      return heard;
    case kPreOperational:
      heard.state = bus::NodeState::pre_operational;
      return heard;
    default:
      if (state < kFirstPassing || state > kLastPassing) return std::nullopt;
      return heard;
  }
}

can::CanFrame boot_up_frame(std::uint8_t node) { return error_control_frame(node, kBootUp); }

can::CanFrame operational_heartbeat_frame(std::uint8_t node) { return error_control_frame(node, kOperational); }

}  // namespace axisgate::canopen
