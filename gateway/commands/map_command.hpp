// SPDX-License-Identifier: Apache-2.0
// `axisgate map CONFIG`: every register, coil and input of this gateway, for the PLC programmer.
// Promises that it comes from the table that the server answers from.
// Never opens a port.
#pragma once

#include <string>
#include <vector>

namespace axisgate::app {

struct MapOptions {
  std::string config;
  std::vector<std::string> profile_folders;
  std::string format = "table";  ///< json, csv, md, st or table
};

[[nodiscard]] int run(const MapOptions& options);

}  // namespace axisgate::app
