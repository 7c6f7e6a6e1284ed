// SPDX-License-Identifier: Apache-2.0
// Where the gateway of this computer listens, for the commands that are given no HOST:PORT, from the text of its
// configuration. Pure. Promises an answer also for a file that has mistakes elsewhere: a stop must not wait for them.
// Never says that the gateway runs, or that it runs with this file.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "gateway/commands/client/axis_names.hpp"
#include "gateway/commands/client/host_port.hpp"

namespace axisgate::commands {

/// The configuration of the service (deploy/systemd/axisgate.service).
inline constexpr const char* kServiceConfig = "/etc/axisgate/gateway.json";
/// Where a gateway is looked for that has no configuration there: the "listen" of every example.
inline const HostPort kUsualPlace{"127.0.0.1", 1502};

struct OwnGateway {
  HostPort place;
  AxisNames names;
};
/// A listener of this computer alone before the others, of these the first; "0.0.0.0" and "[::]" are reached at this
/// computer's own address. None: the text is no configuration, or has no listener that can be read.
[[nodiscard]] std::optional<OwnGateway> own_gateway_in(std::string_view configuration);

}  // namespace axisgate::commands
