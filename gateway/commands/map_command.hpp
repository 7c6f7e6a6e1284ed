// SPDX-License-Identifier: Apache-2.0
// `axisgate map CONFIG`: every register, coil and input of this gateway, for the PLC programmer.
// Promises that it comes from the table that the server answers from, as one listener shows it; that it says on stderr
// where another listener shows it otherwise.
// Never opens a port.
#pragma once

#include <string>
#include <vector>

namespace axisgate::commands {

struct MapOptions {
  std::string config;
  std::vector<std::string> profile_folders;
  std::string format = "table";  ///< json, csv, md, st or table
  std::string listener;          ///< its "listen", "HOST:PORT"; empty: the first one
};

[[nodiscard]] int run(const MapOptions& options);

}  // namespace axisgate::commands
