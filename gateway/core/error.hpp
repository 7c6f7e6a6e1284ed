// SPDX-License-Identifier: Apache-2.0
// Every way a request can end, and the one table that turns it into text, a Modbus exception and a command_result.
// Promises that each code has exactly one row (a static assertion counts them) and that all servers say the same thing.
// Never carries the drive's own code: that travels beside it as `Outcome::detail`.
#pragma once

#include <cstdint>
#include <string_view>

namespace axisgate {

enum class Errc : std::uint8_t {
  ok,
  // Refused before anything was sent: the request itself (design 3.3 Outcomes).
  illegal_function,   ///< function code this server does not have
  not_supported,      ///< no such register, quantity or command on this drive, read-only, half of a 32-bit value
  bad_value,          ///< outside limits, not representable, unknown command
  role_forbidden,     ///< the client's role may not do this
  state_unsuitable,   ///< the axis is in no state for it
  stop_owed,          ///< after a loss: a stop comes first, and was not seen to act yet
  busy,               ///< not now: moving where standstill is needed, mailbox busy, only while disabled
  queue_full,         ///< a bound of the bus or of the axis is reached
  superseded,         ///< replaced by a newer setpoint before it was sent
  never_started,      ///< start deadline passed, nothing was sent
  dropped_by_stop,    ///< dropped by a stop before it was sent
  stopped_by_other,   ///< another client's stop ended it
  still_in_setup,     ///< the axis is still in setup
  identity_mismatch,  ///< the drive is not the configured one
  not_owner,          ///< another client owns the axis
  offline,            ///< bus down or axis offline: nothing was sent
  no_path,            ///< this unit id or axis does not exist here
  // Ends of what was sent.
  refused_by_drive,  ///< the drive answered with an error; its code is the detail
  timed_out,         ///< sent, no acknowledgement in time: outcome unknown
  link_lost,         ///< sent, then the link or the drive was lost: outcome unknown
  bad_reply,         ///< the reply does not fit the request (width, form)
  not_reached,       ///< acknowledged, but the drive never showed the state that was asked for
  // What the rules of edges did not let act.
  not_new,  ///< it repeats what was written before and does nothing: another value must come first
};
inline constexpr int kErrcCount = static_cast<int>(Errc::not_new) + 1;

/// Register 25 (design 3.1).
enum class CommandResult : std::uint8_t {
  none = 0,
  pending = 1,
  done = 2,
  refused_by_drive = 3,
  outcome_unknown = 4,
  superseded = 5,
  never_started = 6,
  not_owner = 7,
  stopped_by_other = 8,
  state_unsuitable = 9,
  not_new = 10,
  not_reached = 11,
};

/// Modbus application protocol V1.1b3 section 7; 0 is no exception.
enum class ModbusException : std::uint8_t {
  none = 0x00,
  illegal_function = 0x01,
  illegal_data_address = 0x02,
  illegal_data_value = 0x03,
  server_device_failure = 0x04,
  server_device_busy = 0x06,
  gateway_path_unavailable = 0x0A,
  gateway_target_failed = 0x0B,
};

/// `state_unsuitable` and `stop_owed` always carry this detail: CiA 301 abort code "because of the present device
/// state".
inline constexpr std::uint32_t kDetailDeviceState = 0x08000022;

struct Outcome {
  Errc code = Errc::ok;
  /// Abort code, Modbus exception or the drive's own code; 0 where there is none. Of `not_reached` the number of the
  /// step, from 1; 0: nothing was sent.
  std::uint32_t detail = 0;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

/// Refused before anything was sent: the code, with the detail that belongs to it.
[[nodiscard]] constexpr Outcome refusal(Errc code) {
  const bool by_state = code == Errc::state_unsuitable || code == Errc::stop_owed;
  return {code, by_state ? kDetailDeviceState : 0};
}

[[nodiscard]] std::string_view text(Errc code);
[[nodiscard]] ModbusException modbus_exception(Errc code);
[[nodiscard]] CommandResult command_result(Errc code);
/// `result` of a DDS reply (schemas/axisgate.idl): the command_result where there is one, else 16 not supported, 17 bad
/// value, 18 the role may not do this, 19 busy, 20 no such axis.
[[nodiscard]] std::uint8_t dds_result(Errc code);

}  // namespace axisgate
