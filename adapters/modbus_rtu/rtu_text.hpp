// SPDX-License-Identifier: Apache-2.0
// A Modbus RTU frame in words, for the decode log: "unit 1: read 2 registers at 304 (0x0130)".
// Promises one line for any bytes; registers in decimal and hexadecimal, since makers print either.
// Never decides anything.
#pragma once

#include <string>

#include "gateway/core/bytes.hpp"

namespace axisgate::modbus_rtu {

/// `frame`: unit and PDU.
[[nodiscard]] std::string describe_request(Bytes frame);
[[nodiscard]] std::string describe_reply(Bytes frame);

}  // namespace axisgate::modbus_rtu
