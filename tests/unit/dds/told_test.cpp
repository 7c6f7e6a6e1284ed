// SPDX-License-Identifier: Apache-2.0
// What log and events say of DDS writers: which writer of which participant has asked for what, and what was refused.
#include <gmock/gmock.h>

#include "gateway/core/line_bucket.hpp"
#include "tests/unit/dds/dds_rig.hpp"

namespace axisgate::test {
namespace {

constexpr const char* kFirst = "dds 192.168.1.7 010f01000000000000000000:000001: ";

TEST(ToldOfDds, WhoCommandedWhatWithItsTarget) {
  DdsRig rig;
  const auto writer = rig.writer(1);
  ASSERT_EQ(rig.ask(writer, 1).result, kDone);
  EXPECT_TRUE(rig.has_event(std::string(kFirst) + "enable"));
  ASSERT_EQ(rig.run_at(writer, 5).result, kDone);
  EXPECT_TRUE(rig.has_event(std::string(kFirst) + "run_velocity, target_velocity 300000 (300 rpm)"));
  ASSERT_EQ(rig.ask(writer, 3).result, kDone);
  EXPECT_TRUE(rig.has_event(std::string(kFirst) + "quick_stop"));
}

TEST(ToldOfDds, WhatComesToNoAxisIsALineOfTheLogAndNoFlood) {
  DdsRig rig;
  const auto writer = rig.writer(1);
  ASSERT_EQ(rig.ask(writer, 1, 99).result, 20);
  ASSERT_EQ(rig.told.size(), 1U);
  EXPECT_EQ(rig.told.front(), std::string(kFirst) +
                                  "enable of axis 99 is refused: result 20 no such axis (DDS): there is "
                                  "no axis of this number, or it cannot be reached");
  for (int i = 0; i < 200; ++i) ASSERT_EQ(rig.ask(writer, 1, 99).result, 20);
  EXPECT_LE(rig.told.size(), static_cast<std::size_t>(LineBucket::kBurst) + 2);
}

}  // namespace
}  // namespace axisgate::test
