// SPDX-License-Identifier: Apache-2.0
// What the log says first: version and configuration, then one line for each bus, axis, listener and the DDS server.
// Promises that a log says by itself what was running, and which name and drive an axis number stands for.
// Never opens or asks anything: it is what was configured, not what is there.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gateway/config/config_loader.hpp"

namespace axisgate::compose {

struct StartLine {
  LogSource source;
  std::string text;
};

/// "/dev/ttyUSB0, 38400 baud 8N1", "can0, 500 kbit/s".
[[nodiscard]] std::string wire_text(const config::BusConfig& bus);
[[nodiscard]] std::vector<StartLine> start_lines(const config::LoadedConfig& loaded, std::string_view version);

}  // namespace axisgate::compose
