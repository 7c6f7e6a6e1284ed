// SPDX-License-Identifier: Apache-2.0
// How an exchange is said in Keya's serial frames, and which frame answers it.
// Promises that a query is matched by all that its answer says: code, and on RS485 the drive's number.
// Never looks at anything but its arguments.
#pragma once

#include <optional>

#include "adapters/bus/exchange.hpp"
#include "adapters/keya/keya_serial_codec.hpp"

namespace axisgate::keya {

// Objects, as ObjectAddress says them: a query is kQueryIndex + code, sub 0; a control frame is all four of
// kOnIndex and kValueIndex with the motor as sub-index, 1 = A and 2 = B.
inline constexpr std::uint16_t kQueryIndex = 0x2100;
inline constexpr std::uint16_t kOnIndex = 0x200D;
inline constexpr std::uint16_t kValueIndex = 0x2000;

/// What the protocol cannot say is refused here, and nothing is to be sent: a query that it does not have, a field
/// beyond its data, and a write that is not exactly the four fields of a control frame, each once (a client may ask for
/// one of them by the mailbox). On is 0 or 1 in any width, a value has four bytes.
[[nodiscard]] std::optional<bus::ExchangeResult> refusal_of(KeyaLine line, const bus::Exchange& exchange);

/// The drive's interface, its supply voltage and its version's date are never 0.
[[nodiscard]] constexpr bool is_never_zero(std::uint8_t code) {
  const auto query = static_cast<Query>(code);
  return query == Query::control_state || query == Query::voltage || query == Query::version;
}

/// Only where refusal_of() has no value. On RS485 the node is 1 to 255; RS232 has none.
[[nodiscard]] SerialFrame request_of(KeyaLine line, const bus::Exchange& exchange);

/// Only a read is answered at all. A query looks like an answer whose data are 0: telling them apart is for the
/// receiver.
[[nodiscard]] bool answers(KeyaLine line, const SerialFrame& frame, const bus::Exchange& exchange);

/// Of a frame that answers.
[[nodiscard]] bus::ExchangeResult result_of(KeyaLine line, const SerialFrame& frame, const bus::Exchange& exchange);

}  // namespace axisgate::keya
