// SPDX-License-Identifier: Apache-2.0
// What lay in the sockets of a program that stood still counts as received when the standstill began.
#include "gateway/upstream/dds_process/system/standstill.hpp"

#include <gtest/gtest.h>

namespace axisgate::dds {
namespace {

constexpr SteadyNs kMs = 1'000'000, kBegin = 1'000 * kMs, kGap = 5'000 * kMs, kEnd = kBegin + kGap;

struct AfterAStandstill : testing::Test {
  Standstill standstill;
  AfterAStandstill() {
    standstill.turn(kBegin - 250 * kMs);
    standstill.turn(kBegin);
    standstill.turn(kEnd);
  }
};

TEST_F(AfterAStandstill, WhatIsReadThenCameWhenItBegan) {
  EXPECT_EQ(standstill.came(kEnd), kBegin);
  EXPECT_LE(standstill.came(kEnd + 900 * kMs), kBegin + 900 * kMs);
  EXPECT_LE(standstill.came(kEnd - 3 * kMs), kBegin) << "by a thread of the library, before the loop came round";
}

TEST_F(AfterAStandstill, SamplesKeepTheirOrder) {
  SteadyNs before = 0;
  for (const SteadyNs at : {kBegin - kMs, kBegin, kEnd + 1, kEnd + 2, kEnd + 1'000 * kMs, kEnd + 1'000 * kMs + 1}) {
    EXPECT_GT(standstill.came(at), before) << at;
    before = standstill.came(at);
  }
}

TEST_F(AfterAStandstill, WhatCameBeforeOrLaterKeepsItsTime) {
  EXPECT_EQ(standstill.came(kBegin), kBegin);
  EXPECT_EQ(standstill.came(kEnd + 1'001 * kMs), kEnd + 1'001 * kMs);
}

TEST(NoStandstill, ALoopThatIsLateChangesNothing) {
  Standstill standstill;
  for (SteadyNs now = kBegin; now < kEnd; now += 1'900 * kMs) {
    standstill.turn(now);
    EXPECT_EQ(standstill.came(now), now);
  }
}

}  // namespace
}  // namespace axisgate::dds
