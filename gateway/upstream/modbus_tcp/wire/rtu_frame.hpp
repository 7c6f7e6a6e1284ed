// SPDX-License-Identifier: Apache-2.0
// Tells a request of Modbus RTU where one of Modbus-TCP was to be: the commonest mistake of whoever sets up a client.
// Promises that nothing is taken for one but whole bytes of a known function with their CRC (Modbus over serial line
// V1.02, 6.2.2). Never decodes what it asks.
#pragma once

#include "gateway/core/bytes.hpp"

namespace axisgate::modbus_tcp {

[[nodiscard]] bool is_rtu_request(Bytes bytes);

}  // namespace axisgate::modbus_tcp
