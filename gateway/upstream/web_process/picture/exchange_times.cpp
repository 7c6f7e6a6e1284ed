// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/picture/exchange_times.hpp"

#include <numeric>

namespace axisgate::web {
namespace {

using Buckets = std::array<std::uint64_t, TimeCounts::kBuckets>;

/// Below it all of bucket i are; the last one has no end, and is taken to be as wide as those before together.
double end_of(std::size_t bucket) {
  constexpr double kFirstMs = 0.1;
  return kFirstMs * static_cast<double>(1U << bucket);
}

double percentile(const Buckets& buckets, std::uint64_t count, double share) {
  const double wanted = share * static_cast<double>(count);
  double below = 0;
  for (std::size_t i = 0; i < buckets.size(); ++i) {
    const auto here = static_cast<double>(buckets[i]);
    if (here > 0 && below + here >= wanted) {
      const double begin = i == 0 ? 0 : end_of(i - 1);
      return begin + (end_of(i) - begin) * (wanted - below) / here;
    }
    below += here;
  }
  return end_of(buckets.size() - 1);
}

}  // namespace

void ExchangeTimes::add(const Counts& counts, SteadyNs at) {
  looks_.push_back({at, counts});
  while (looks_.size() > 2 && looks_[1].at <= at - kSpan) looks_.pop_front();
}

std::optional<ExchangeTimes::Percentiles> ExchangeTimes::of(std::size_t exchange_class) const {
  if (looks_.size() < 2) return std::nullopt;
  const Buckets& first = looks_.front().counts[exchange_class].counts;
  Buckets since = looks_.back().counts[exchange_class].counts;
  for (std::size_t i = 0; i < since.size(); ++i) since[i] -= first[i];
  const std::uint64_t count = std::accumulate(since.begin(), since.end(), std::uint64_t{0});
  if (count == 0) return std::nullopt;
  constexpr double kHalf = 0.5, kMost = 0.95, kNearlyAll = 0.99;
  return Percentiles{count, percentile(since, count, kHalf), percentile(since, count, kMost),
                     percentile(since, count, kNearlyAll)};
}

}  // namespace axisgate::web
