// SPDX-License-Identifier: Apache-2.0
// Error frames of a CAN controller, as Linux hands them over: what happened, in words.
// Promises to name every class that <linux/can/error.h> has, and to take short or odd data as "nothing more is known".
// Never judges: whether the link counts as down is BusOffPlan's matter.
#pragma once

#include <cstdint>
#include <string>

#include "gateway/core/bytes.hpp"

namespace axisgate::can {

/// The bits of an error frame's id: CAN_ERR_* of <linux/can/error.h>.
namespace error_class {
inline constexpr std::uint32_t kTxTimeout = 0x001;
inline constexpr std::uint32_t kLostArbitration = 0x002;
inline constexpr std::uint32_t kController = 0x004;  ///< data[1] tells more
inline constexpr std::uint32_t kProtocol = 0x008;    ///< data[2] and data[3] tell more
inline constexpr std::uint32_t kTransceiver = 0x010;
inline constexpr std::uint32_t kNoAck = 0x020;
inline constexpr std::uint32_t kBusOff = 0x040;
inline constexpr std::uint32_t kBusError = 0x080;
inline constexpr std::uint32_t kRestarted = 0x100;
inline constexpr std::uint32_t kCounters = 0x200;  ///< data[6] and data[7] are the error counters
inline constexpr std::uint32_t kAll = 0x3FF;
}  // namespace error_class

struct CanErrors {
  bool bus_off = false;
  bool restarted = false;
  bool no_ack = false;
  bool error_passive = false;
  bool error_warning = false;
  bool error_active = false;  ///< recovered
  bool receive_overflow = false;
  bool transmit_overflow = false;
  bool transmit_timeout = false;
  bool lost_arbitration = false;
  bool protocol_error = false;
  bool transceiver_error = false;
  friend bool operator==(const CanErrors&, const CanErrors&) = default;
};

/// `classes`: the id without its flags. `data`: up to 8 bytes.
[[nodiscard]] CanErrors decode_errors(std::uint32_t classes, Bytes data);

/// "bus-off", "error passive, no acknowledgement": for the log.
[[nodiscard]] std::string text(const CanErrors& errors);

}  // namespace axisgate::can
