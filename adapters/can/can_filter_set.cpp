// SPDX-License-Identifier: Apache-2.0
#include "adapters/can/can_filter_set.hpp"

#include <algorithm>
#include <cassert>
#include <tuple>

namespace axisgate::can {
namespace {

constexpr std::uint32_t kExtendedIdBits = 29;

std::uint32_t widest(const CanFilter& filter) { return filter.extended ? kMaxExtendedId : kMaxStandardId; }

void remove_doubles(std::vector<CanFilter>& filters) {
  const auto key = [](const CanFilter& filter) { return std::tuple(filter.extended, filter.mask, filter.id); };
  std::ranges::sort(filters, [key](const CanFilter& a, const CanFilter& b) { return key(a) < key(b); });
  filters.erase(std::unique(filters.begin(), filters.end()), filters.end());
}

}  // namespace

FilterSet::FilterSet(std::vector<CanFilter> filters) : filters_(std::move(filters)) {
  assert(filters_.size() <= kMaxFilters);
  for (CanFilter& filter : filters_) {
    filter.mask &= widest(filter);
    filter.id &= filter.mask;
  }
  remove_doubles(filters_);
  for (const CanFilter& filter : filters_) {
    if (filter.extended) {
      extended_.push_back(filter);
      continue;
    }
    for (std::uint32_t id = 0; id <= kMaxStandardId; ++id) {
      if ((id & filter.mask) == filter.id) standard_.set(id);
    }
  }
}

bool FilterSet::passes(const CanFrame& frame) const {
  if (!frame.extended) return frame.id <= kMaxStandardId && standard_.test(frame.id);
  return std::ranges::any_of(extended_, [&frame](const CanFilter& filter) { return filter.passes(frame); });
}

std::vector<CanFilter> FilterSet::for_kernel(std::size_t most) const {
  assert(most >= 2);  // one for each width of id
  std::vector<CanFilter> wide = filters_;
  for (std::uint32_t bits = 1; wide.size() > most && bits <= kExtendedIdBits; ++bits) {
    const std::uint32_t low = (1U << bits) - 1;
    for (CanFilter& filter : wide) {
      filter.mask &= ~low;
      filter.id &= filter.mask;
    }
    remove_doubles(wide);
  }
  return wide;
}

}  // namespace axisgate::can
