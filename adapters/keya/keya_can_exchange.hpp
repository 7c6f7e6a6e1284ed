// SPDX-License-Identifier: Apache-2.0
// How an exchange is said in Keya's CAN frames, and which frame answers it.
// Promises that a reply is matched by all it says: an acknowledgement (index 0x20xx) never answers a read, nor a value
// a write, although both begin with 0x60. Never looks at anything but its arguments.
#pragma once

#include <optional>

#include "adapters/keya/keya_can_codec.hpp"

namespace axisgate::keya {

/// What the protocol cannot say is refused here, and nothing is to be sent: a read of a command (0x20xx), a write of
/// anything else, for another motor than 1 or 2, of another width than 4 bytes or of several fields; a field of a read
/// that goes beyond the four data bytes.
[[nodiscard]] std::optional<bus::ExchangeResult> refusal_of(const bus::Exchange& exchange);

/// Only where refusal_of() has no value.
[[nodiscard]] CanMessage request_of(const bus::Exchange& exchange);

/// The sub-index of an acknowledgement may be 0 (other drives of this maker do not repeat it); a value's may not.
[[nodiscard]] bool answers(const CanMessage& message, const bus::Exchange& exchange);

/// Of a message that answers.
[[nodiscard]] bus::ExchangeResult result_of(const CanMessage& message, const bus::Exchange& exchange);

}  // namespace axisgate::keya
