#include "adapters/can/can_filter_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace axisgate::can {
namespace {

CanFrame extended(std::uint32_t id) {
  CanFrame frame;
  frame.extended = true;
  frame.id = id;
  return frame;
}

/// All ids of CANopen nodes 1 to `nodes`.
std::vector<CanFilter> canopen(std::uint32_t nodes) {
  std::vector<CanFilter> filters;
  for (std::uint32_t node = 1; node <= nodes; ++node) {
    for (const std::uint32_t function : {0x080U, 0x180U, 0x280U, 0x380U, 0x480U, 0x580U, 0x700U}) {
      filters.push_back({.id = function + node});
    }
  }
  return filters;
}

bool let_through(const std::vector<CanFilter>& filters, const CanFrame& frame) {
  return std::any_of(filters.begin(), filters.end(), [&](const CanFilter& filter) { return filter.passes(frame); });
}

TEST(FilterSet, without_filters_nothing_passes) {
  const FilterSet none;
  EXPECT_FALSE(none.passes(data_frame(0, {})));
  EXPECT_FALSE(none.passes(extended(0)));
  EXPECT_TRUE(none.for_kernel().empty());
}

TEST(FilterSet, passes_the_ids_asked_for_and_their_remote_frames_alone) {
  const FilterSet set(canopen(3));
  EXPECT_TRUE(set.passes(data_frame(0x183, {})));
  EXPECT_TRUE(set.passes(remote_frame(0x703, 1)));
  EXPECT_FALSE(set.passes(data_frame(0x184, {})));
  EXPECT_FALSE(set.passes(data_frame(0x603, {})));
  EXPECT_FALSE(set.passes(extended(0x183)));
}

TEST(FilterSet, a_mask_opens_a_range) {
  const FilterSet set({{.id = 0x700, .mask = 0x780}});
  EXPECT_TRUE(set.passes(data_frame(0x77F, {})));
  EXPECT_FALSE(set.passes(data_frame(0x6FF, {})));
}

TEST(FilterSet, extended_ids_have_filters_of_their_own) {
  const FilterSet set({{.id = 0x0601, .mask = kMaxExtendedId, .extended = true}});
  EXPECT_TRUE(set.passes(extended(0x0601)));
  EXPECT_FALSE(set.passes(extended(0x10000601)));
  EXPECT_FALSE(set.passes(data_frame(0x601, {})));
}

TEST(FilterSet, as_many_filters_as_the_kernel_takes_go_to_it_as_they_are) {
  const std::vector<CanFilter> filters = canopen(73);  // 511
  std::vector<CanFilter> told = FilterSet(filters).for_kernel();
  EXPECT_EQ(told.size(), filters.size());
  for (const CanFilter& filter : told) EXPECT_EQ(filter.mask, kMaxStandardId);
}

TEST(FilterSet, more_are_widened_until_they_are_few_enough_and_lose_nothing) {
  const FilterSet set(canopen(127));
  const std::vector<CanFilter> told = set.for_kernel();
  EXPECT_LE(told.size(), kMaxKernelFilters);
  EXPECT_GT(told.size(), 2) << "no wider than needed";
  for (std::uint32_t id = 0; id <= kMaxStandardId; ++id) {
    const CanFrame frame = data_frame(id, {});
    EXPECT_TRUE(!set.passes(frame) || let_through(told, frame)) << id;
  }
  EXPECT_FALSE(let_through(told, data_frame(0x605, {}))) << "requests of others stay outside";
}

TEST(FilterSet, both_widths_of_id_survive_the_narrowest_limit) {
  std::vector<CanFilter> filters = canopen(10);
  for (std::uint32_t id = 0; id < 20; ++id) {
    filters.push_back({.id = id << 20, .mask = kMaxExtendedId, .extended = true});
  }
  const std::vector<CanFilter> told = FilterSet(filters).for_kernel(2);
  EXPECT_EQ(told.size(), 2);
  for (const CanFilter& filter : filters) {
    CanFrame frame = extended(filter.id);
    frame.extended = filter.extended;
    EXPECT_TRUE(let_through(told, frame));
  }
}

}  // namespace
}  // namespace axisgate::can
