// SPDX-License-Identifier: Apache-2.0
// "HOST:PORT" and "[IPV6]:PORT" on the command line: where a gateway listens. Pure.
// Promises that what cannot be meant is refused with what to write. Never resolves a name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate::commands {

struct HostPort {
  std::string host;  ///< a name or an address
  std::uint16_t port = 0;
};
[[nodiscard]] std::optional<HostPort> parse_host_port(std::string_view text);
/// As a program on this computer reaches it: "0.0.0.0" and "[::]" are the loopback.
[[nodiscard]] HostPort reached_here(HostPort place);
/// "'x' is no HOST:PORT: write ..."
[[nodiscard]] std::string host_port_mistake(std::string_view text);

}  // namespace axisgate::commands
