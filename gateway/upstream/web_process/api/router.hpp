// SPDX-License-Identifier: Apache-2.0
// Which request gets which answer. Pure: a request and what is known in, an answer out.
// Promises that what is unknown is refused by name: a path, a parameter, a value. Never asks whose request it is:
// Reception has done so.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <variant>
#include <vector>

#include "gateway/upstream/web_process/api/gateway_json.hpp"
#include "gateway/upstream/web_process/api/stores.hpp"
#include "gateway/upstream/web_process/http/request.hpp"
#include "gateway/upstream/web_process/http/response.hpp"

namespace axisgate::web {

inline constexpr std::uint64_t kLeastPeriodMs = 50, kMostPeriodMs = 5000, kPeriodMs = 100;
inline constexpr std::size_t kMostSeries = 16;

struct StreamRequest {
  std::uint64_t period_ms = kPeriodMs;
  std::optional<std::set<std::uint64_t>> axes{};  ///< none: all of them
  std::optional<std::uint64_t> after{};           ///< events behind this one; none: from now on
  std::vector<Series> series{};                   ///< of the scope
};

struct Answer {
  std::variant<Response, StreamRequest> what;
  std::optional<Refusal> refused{};
};

[[nodiscard]] Answer answer(const Request& request, const Stores& stores, const Served& served, const Now& now);

}  // namespace axisgate::web
