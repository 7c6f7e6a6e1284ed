// SPDX-License-Identifier: Apache-2.0
// Which requests are known, for how long, and how many.
#include "gateway/upstream/dds/request_memory.hpp"

#include <gtest/gtest.h>

#include "gateway/upstream/dds/dds_session.hpp"
#include "tests/unit/dds/samples.hpp"

namespace axisgate::dds {
namespace {

using namespace std::chrono_literals;
using test::guid;
using test::kStart;
using Seen = RequestMemory::Seen;

TEST(RequestMemory, ARequestThatComesAgainIsKnownForTenSeconds) {
  RequestMemory memory(kMaxRequestsKept, kRequestsKept);
  const RequestKey key{guid(1), 1, 7};
  EXPECT_EQ(memory.see(key, kStart), Seen::first);
  EXPECT_EQ(memory.see(key, kStart), Seen::again);
  EXPECT_EQ(memory.see(key, kStart + 9999ms), Seen::again);
  EXPECT_EQ(memory.see(key, kStart + 15s), Seen::again) << "seen in the last 10 s";
  EXPECT_EQ(memory.see(key, kStart + 25s), Seen::first);
}

TEST(RequestMemory, WriterAxisAndIdTogetherAreARequest) {
  RequestMemory memory(kMaxRequestsKept, kRequestsKept);
  EXPECT_EQ(memory.see({guid(1), 1, 7}, kStart), Seen::first);
  EXPECT_EQ(memory.see({guid(1), 1, 8}, kStart), Seen::first);
  EXPECT_EQ(memory.see({guid(1), 2, 7}, kStart), Seen::first);
  EXPECT_EQ(memory.see({guid(1, 2), 1, 7}, kStart), Seen::first);
  EXPECT_EQ(memory.see({guid(1), 1, 7}, kStart), Seen::again);
}

TEST(RequestMemory, WhenItIsFullItSaysSoAndForgetsNothingButWhatIsOld) {
  RequestMemory memory(3, kRequestsKept);
  for (std::uint64_t id = 1; id <= 3; ++id) EXPECT_EQ(memory.see({guid(1), 1, id}, kStart + id * 1s), Seen::first);
  EXPECT_EQ(memory.see({guid(1), 1, 4}, kStart + 4s), Seen::full);
  EXPECT_EQ(memory.see({guid(1), 1, 4}, kStart + 4s), Seen::full) << "what was refused is not known";
  EXPECT_EQ(memory.see({guid(1), 1, 1}, kStart + 5s), Seen::again);
  EXPECT_EQ(memory.see({guid(1), 1, 4}, kStart + 12s), Seen::first) << "the second has gone";
  EXPECT_EQ(memory.see({guid(1), 1, 1}, kStart + 12s), Seen::again) << "it came last at 5 s";
}

}  // namespace
}  // namespace axisgate::dds
