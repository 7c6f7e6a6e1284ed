// SPDX-License-Identifier: Apache-2.0
#include "adapters/can/can_error.hpp"

#include <array>
#include <string_view>
#include <utility>

namespace axisgate::can {
namespace {

// data[1]: CAN_ERR_CRTL_*
constexpr Byte kReceiveOverflow = 0x01;
constexpr Byte kTransmitOverflow = 0x02;
constexpr Byte kWarning = 0x04 | 0x08;  // receiver, transmitter
constexpr Byte kPassive = 0x10 | 0x20;
constexpr Byte kActive = 0x40;
// data[3]: CAN_ERR_PROT_LOC_ACK. Some controllers (m_can) tell a missing acknowledgement by its place in the frame
// alone.
constexpr Byte kAckSlot = 0x19;

}  // namespace

CanErrors decode_errors(std::uint32_t classes, Bytes data) {
  const auto has = [classes](std::uint32_t bit) { return (classes & bit) != 0; };
  const auto byte = [data](std::size_t at) { return at < data.size() ? data[at] : Byte{0}; };
  const Byte controller = has(error_class::kController) ? byte(1) : Byte{0};
  CanErrors errors;
  errors.bus_off = has(error_class::kBusOff);
  errors.restarted = has(error_class::kRestarted);
  errors.no_ack = has(error_class::kNoAck) || (has(error_class::kProtocol) && byte(3) == kAckSlot);
  errors.error_passive = (controller & kPassive) != 0;
  errors.error_warning = (controller & kWarning) != 0;
  errors.error_active = (controller & kActive) != 0;
  errors.receive_overflow = (controller & kReceiveOverflow) != 0;
  errors.transmit_overflow = (controller & kTransmitOverflow) != 0;
  errors.transmit_timeout = has(error_class::kTxTimeout);
  errors.lost_arbitration = has(error_class::kLostArbitration);
  errors.protocol_error = has(error_class::kProtocol) || has(error_class::kBusError);
  errors.transceiver_error = has(error_class::kTransceiver);
  return errors;
}

std::string text(const CanErrors& errors) {
  const std::array<std::pair<bool, std::string_view>, 12> words{{
      {errors.bus_off, "bus-off"},
      {errors.restarted, "restarted after bus-off"},
      {errors.no_ack, "no acknowledgement"},
      {errors.error_passive, "error passive"},
      {errors.error_warning, "error warning"},
      {errors.error_active, "error active again"},
      {errors.receive_overflow, "receive overflow in the controller"},
      {errors.transmit_overflow, "transmit overflow in the controller"},
      {errors.transmit_timeout, "transmit timeout"},
      {errors.lost_arbitration, "arbitration lost"},
      {errors.protocol_error, "protocol error"},
      {errors.transceiver_error, "transceiver error"},
  }};
  std::string out;
  for (const auto& [so, word] : words) {
    if (!so) continue;
    if (!out.empty()) out += ", ";
    out += word;
  }
  return out.empty() ? "error of no known class" : out;
}

}  // namespace axisgate::can
