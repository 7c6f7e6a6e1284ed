// SPDX-License-Identifier: Apache-2.0
// The settings of the web server (configuration key "web"), with their defaults.
// Promises values within their documented ranges: the configuration was checked before.
// Never changes but by a reload.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "gateway/core/clock.hpp"
namespace axisgate::web {

struct WebSettings {
  std::string gateway{};  ///< configuration key "gateway", its name
  std::string listen = "127.0.0.1:8080";
  std::vector<std::string> hosts{};                ///< names under which a browser may ask, beside the address
  bool insecure = false;                           ///< the address may be another than the loopback, without TLS
  std::vector<std::string> allow{"127.0.0.1/32"};  ///< who may look: addresses and networks
  Duration sample_period = std::chrono::milliseconds(10);
  std::uint32_t history_mib = 48;
  std::uint32_t max_connections = 100;
  std::uint32_t max_streams = 50;
  std::uint32_t memory_limit_mib = 128;  ///< of axisgate-web, which is ended beyond it
  std::string recorder = "{}";           ///< an object with the keys `captures` and `triggers`, for axisgate-web
  friend bool operator==(const WebSettings&, const WebSettings&) = default;
};

/// What the history gets: it leaves room for answers that are not taken yet.
[[nodiscard]] inline std::uint32_t history_mib(const WebSettings& settings) {
  return std::min(settings.history_mib, settings.memory_limit_mib / 2);
}
/// What a sample that differs from the one before takes of it, at most.
inline constexpr double kHistoryBytes = 12.75;

}  // namespace axisgate::web
