// SPDX-License-Identifier: Apache-2.0
// One who looks at the page as a browser does: GET, by Boost.Beast, which is known here alone.
// Promises an answer or a reason within its patience, whatever the other side does. Never sends anything but GET.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <string>

#include "gateway/commands/client/host_port.hpp"

namespace axisgate::commands::record {

inline constexpr std::chrono::seconds kPatience{10};
/// As long as the page's own answers may be.
inline constexpr std::uint64_t kLongestAnswer = 64ULL * 1024 * 1024;

struct PageAnswer {
  std::string problem{};  ///< why there is none; empty: there is one
  unsigned status = 0;
  std::string body{};
};

/// A connection for each request: they are seconds apart.
class PageClient {
 public:
  PageClient(boost::asio::io_context& io, HostPort place, std::chrono::milliseconds patience = kPatience)
      : io_(io), place_(std::move(place)), patience_(patience) {}
  [[nodiscard]] boost::asio::awaitable<PageAnswer> get(std::string target);

 private:
  boost::asio::io_context& io_;
  HostPort place_;
  std::chrono::milliseconds patience_;
};

}  // namespace axisgate::commands::record
