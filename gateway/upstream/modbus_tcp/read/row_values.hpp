// SPDX-License-Identifier: Apache-2.0
// What each row of the register map shows one client at one moment (design 3.1 and 3.2).
// Promises the rules of 3.2 whatever the image says, and the client's own values for the rows that are its own.
// Never changes anything and never waits.
#pragma once

#include <cstdint>
#include <memory>

#include "gateway/image/command_port.hpp"
#include "gateway/image/process_image.hpp"
#include "gateway/image/register_map.hpp"
#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/client/listener_settings.hpp"

namespace axisgate::modbus_tcp {

/// Who looks, at what, when.
struct Onlooker {
  const ProcessImage& image;
  const CommandPort& commands;
  const ListenerSettings& settings;
  const Client& client;
  const std::shared_ptr<ConnectionWords>& words;  ///< of the connection by which it looks
  Role role = Role::viewer;
  Instant now = kLongAgo;
};

/// In two's complement, 16 or 32 bits wide by the row's type.
[[nodiscard]] std::uint32_t axis_value(const RegisterRow& row, const AxisImage& axis, const Onlooker& onlooker);
[[nodiscard]] std::uint32_t gateway_value(const RegisterRow& row, const Onlooker& onlooker);
[[nodiscard]] std::uint32_t bus_value(const RegisterRow& row, const BusImage& bus);

/// The bits of a register of this type as the number they stand for.
[[nodiscard]] std::int64_t number_of(std::uint32_t bits, RegisterType type);

}  // namespace axisgate::modbus_tcp
