// SPDX-License-Identifier: Apache-2.0
// The command line of axisgate-dds: what to serve or to show, and where on the network.
// Promises options within their ranges, or a message that names the option and what to change.
// Never opens anything.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gateway/upstream/dds_process/participant/participant_options.hpp"

namespace axisgate::dds {

struct ServeOptions {
  int link_fd = -1;
  ParticipantOptions participant{};
  std::string gateway_name{};
  bool commands = false;
  std::vector<std::string> certificates{};  ///< PEM files whose subjects the gateway wants to tell apart
  bool ros2 = false;
  std::uint32_t min_period_ms = 10;  ///< of what is gathered here: joint_states
  std::uint32_t memory_limit_mib = 512;
};

struct TopicsOptions {
  ParticipantOptions participant{};
  bool all = false;                           ///< every gateway of the domain, and which of them there are
  std::optional<std::string> gateway_name{};  ///< this one alone; none: all, as with `all`, but axes alone
  bool once = false;
  bool json = false;
};

/// An exit code where there is nothing to do: a message or the help was printed.
[[nodiscard]] std::variant<int, ServeOptions, TopicsOptions> parse_command_line(int argc, char** argv);

}  // namespace axisgate::dds
