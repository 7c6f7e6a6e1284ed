// SPDX-License-Identifier: Apache-2.0
// The gateway and the axis of a manual command: `axisgate move lift 2.5` as well as `axisgate move HOST:PORT 1 2.5`.
// Promises that a name is the one that the running gateway itself tells, asked for by each command, and that whatever
// is not certain is refused before anything is written. Never writes to a gateway.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <optional>
#include <string>

#include "gateway/commands/client/axis_names.hpp"
#include "gateway/commands/client/host_port.hpp"
#include "gateway/commands/client/own_gateway.hpp"
#include "gateway/commands/client/top_client.hpp"

namespace axisgate::commands {

/// Where the gateway of this computer is looked for.
struct OwnPlace {
  HostPort place;
  std::optional<ConfiguredNames> configured{};  ///< none: by no configuration
};
/// By `config`, else by `usual` where that is there, else kUsualPlace. None: `config` does not say it; stderr has why.
[[nodiscard]] std::optional<OwnPlace> own_place(const std::string& command, const std::string& config,
                                                const std::string& usual = kServiceConfig);

struct NamesRead {
  AxisNames names;      ///< empty: the gateway tells none
  std::string problem;  ///< no usable answer; the connection is closed then
};
/// Of a connected client.
[[nodiscard]] boost::asio::awaitable<NamesRead> read_names(TopClient& client, TopClient::Limit limit);

/// What a person has typed.
struct TypedAxis {
  std::string endpoint;  ///< "HOST:PORT"; empty: the gateway of this computer
  std::string axis;      ///< a number, or a name
  std::string config{};  ///< the configuration of that gateway; empty: that of the service
};
struct FoundAxis {
  HostPort place;
  AxisNumber number = 0;
  std::string said{};  ///< "axis 1 "lift" at 127.0.0.1:1502"; empty: what was typed says it all
};
/// None: stderr says why, and what to write. A number behind a HOST:PORT asks nobody.
[[nodiscard]] std::optional<FoundAxis> find_typed_axis(const std::string& command, const TypedAxis& typed,
                                                       const std::string& usual = kServiceConfig);

}  // namespace axisgate::commands
