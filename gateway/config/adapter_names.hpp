// SPDX-License-Identifier: Apache-2.0
// The adapters that a configuration can name, and the kind of line each of them speaks on.
// Promises one place for their names.
// Never knows what is spoken there.
#pragma once

#include <string_view>

namespace axisgate::config::adapter {

inline constexpr std::string_view kCanopen = "canopen";
inline constexpr std::string_view kModbusRtu = "modbus-rtu";
inline constexpr std::string_view kKincoSerial = "kinco-serial";
inline constexpr std::string_view kKeyaCan = "keya-can";
inline constexpr std::string_view kKeyaRs232 = "keya-rs232";
inline constexpr std::string_view kKeyaRs485 = "keya-rs485";

/// A CAN interface or a serial CAN adapter; every other one has a serial port.
[[nodiscard]] constexpr bool on_can(std::string_view name) { return name == kCanopen || name == kKeyaCan; }
[[nodiscard]] constexpr bool keya_serial(std::string_view name) { return name == kKeyaRs232 || name == kKeyaRs485; }
[[nodiscard]] constexpr bool keya(std::string_view name) { return name == kKeyaCan || keya_serial(name); }

}  // namespace axisgate::config::adapter
