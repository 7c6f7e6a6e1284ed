// SPDX-License-Identifier: Apache-2.0
// How long the exchanges of one bus took in the last minute, by class: from counts since the gateway's start, once a
// second. Promises percentiles that are right to the width of a bucket, and in it by its share. Never keeps an
// exchange.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>

#include "gateway/upstream/web_link/records.hpp"

namespace axisgate::web {

inline constexpr std::array<std::string_view, kExchangeClasses> kExchangeClassNames{
    "stop", "fault_cause", "command", "interactive", "setup", "poll"};

class ExchangeTimes {
 public:
  using Counts = BusCounts::ByClass;
  static constexpr SteadyNs kSpan = 60'000'000'000;

  void add(const Counts& counts, SteadyNs at);

  struct Percentiles {
    std::uint64_t count = 0;
    double p50 = 0, p95 = 0, p99 = 0;  ///< ms
  };
  /// None: there was no exchange of the class.
  [[nodiscard]] std::optional<Percentiles> of(std::size_t exchange_class) const;

 private:
  struct Look {
    SteadyNs at = 0;
    Counts counts{};
  };
  std::deque<Look> looks_;  ///< from one that is a minute old to the newest
};

}  // namespace axisgate::web
