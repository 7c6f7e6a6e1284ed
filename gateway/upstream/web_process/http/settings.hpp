// SPDX-License-Identifier: Apache-2.0
// What is served, to whom, and how much of it at once: the section "web" of the configuration, resolved.
// Promises values that the gateway has checked. Never changes while the program runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gateway/upstream/web_process/http/address.hpp"

namespace axisgate::web {

struct Settings {
  std::vector<std::string> listen{"127.0.0.1:8080"};
  std::vector<std::string> hosts{};  ///< names by which this server may be called
  bool insecure = false;             ///< served beyond this computer, without TLS
  std::vector<Network> allow{};      ///< who may look; empty: this computer
  std::size_t max_connections = 100;
  std::size_t max_streams = 50;
  std::uint32_t history_mb = 48;
  std::uint32_t memory_limit_mb = 128;
};

}  // namespace axisgate::web
