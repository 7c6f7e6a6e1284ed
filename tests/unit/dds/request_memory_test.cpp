// SPDX-License-Identifier: Apache-2.0
// Which requests are known, for how long, and how many of whom.
#include "gateway/upstream/dds/request_memory.hpp"

#include <gtest/gtest.h>

#include "gateway/upstream/dds/dds_session.hpp"
#include "tests/unit/dds/samples.hpp"

namespace axisgate::dds {
namespace {

using namespace std::chrono_literals;
using test::guid;
using test::kStart;
using Known = RequestMemory::Known;

struct Remembered : testing::Test {
  RequestMemory memory{RequestBounds{}, kRequestsKept};
  Known see(const RequestKey& key, Instant now) { return memory.see(key, 1, now).known; }
};

TEST_F(Remembered, ARequestThatComesAgainIsKnownForTenSeconds) {
  const RequestKey key{guid(1), 1, 7};
  EXPECT_EQ(see(key, kStart), Known::first);
  EXPECT_EQ(see(key, kStart), Known::again);
  EXPECT_EQ(see(key, kStart + 9999ms), Known::again);
  EXPECT_EQ(see(key, kStart + 15s), Known::again) << "seen in the last 10 s";
  EXPECT_EQ(see(key, kStart + 25s), Known::first);
  EXPECT_EQ(memory.size(), 1U);
}

TEST_F(Remembered, TheNewestOfAnAxisStaysItWhenAnOlderOneIsForgotten) {
  static_cast<void>(see({guid(1), 1, 7}, kStart));
  static_cast<void>(see({guid(1), 1, 8}, kStart + 5s));
  EXPECT_TRUE(memory.see({guid(1), 1, 8}, 3, kStart + 10s).newest) << "a stop that is repeated";
}

TEST_F(Remembered, WriterAxisAndIdTogetherAreARequest) {
  EXPECT_EQ(see({guid(1), 1, 7}, kStart), Known::first);
  EXPECT_EQ(see({guid(1), 1, 8}, kStart), Known::first);
  EXPECT_EQ(see({guid(1), 2, 7}, kStart), Known::first);
  EXPECT_EQ(see({guid(1, 2), 1, 7}, kStart), Known::first);
  EXPECT_EQ(see({guid(1), 1, 7}, kStart), Known::again);
}

TEST_F(Remembered, AWriterWithoutRoomIsToldSoAndNothingIsForgottenButWhatIsOld) {
  memory = RequestMemory({.of_a_writer = 3, .sure = 1, .writers = 2, .common = 9}, kRequestsKept);
  for (std::uint64_t id = 1; id <= 3; ++id) EXPECT_EQ(see({guid(1), 1, id}, kStart + id * 1s), Known::first);
  EXPECT_EQ(see({guid(1), 1, 4}, kStart + 4s), Known::full);
  EXPECT_EQ(see({guid(1), 1, 4}, kStart + 4s), Known::full) << "what was refused is not known";
  EXPECT_EQ(see({guid(1), 1, 1}, kStart + 5s), Known::again);
  EXPECT_EQ(see({guid(1), 1, 4}, kStart + 12s), Known::first) << "the second has gone";
  EXPECT_EQ(see({guid(1), 1, 1}, kStart + 12s), Known::again) << "it came last at 5 s";
}

TEST_F(Remembered, NoWriterTakesTheRoomOfTheOthers) {
  memory = RequestMemory({.of_a_writer = 8, .sure = 2, .writers = 4, .common = 9}, kRequestsKept);
  for (std::uint8_t writer = 1; writer <= 2; ++writer)
    for (std::uint64_t id = 1; id <= 8; ++id) static_cast<void>(see({guid(writer), 1, id}, kStart));
  EXPECT_EQ(memory.size(), 8U + 2 + 3) << "the second has what is sure, and what was left of the common";
  EXPECT_EQ(see({guid(3), 1, 1}, kStart), Known::first);
  EXPECT_EQ(see({guid(3), 1, 2}, kStart), Known::first);
  EXPECT_EQ(see({guid(3), 1, 3}, kStart), Known::full);
  EXPECT_EQ(see({guid(4), 1, 1}, kStart), Known::first);
  EXPECT_EQ(see({guid(5), 1, 1}, kStart), Known::full) << "too many writers";
  EXPECT_EQ(see({guid(5), 1, 1}, kStart + kRequestsKept), Known::first);
  EXPECT_EQ(memory.size(), 1U);
  for (std::uint64_t id = 2; id <= 8; ++id)
    EXPECT_EQ(see({guid(5), 1, id}, kStart + kRequestsKept), Known::first) << "all the common is back";
}

TEST_F(Remembered, OneWriterMayCommandSixtyFourAxesAHundredTimesASecond) {
  std::uint64_t id = 0;
  for (Instant now = kStart; now < kStart + 30s; now += 10ms)
    for (AxisNumber axis = 1; axis <= 64; ++axis) ASSERT_EQ(see({guid(1), axis, ++id}, now), Known::first);
  EXPECT_EQ(see({guid(2), 1, 1}, kStart + 30s), Known::first);
}

TEST_F(Remembered, NoWriterAloneFillsIt) {
  const RequestBounds all;
  EXPECT_LT(all.of_a_writer, all.common);
  EXPECT_GE(all.writers, kMaxWriters);
}

}  // namespace
}  // namespace axisgate::dds
