// SPDX-License-Identifier: Apache-2.0
// Lost replies of Modbus RTU are counted out: how many reads are believed in nothing, and which is believed then.
#include "gateway/drive/device/resync.hpp"

#include <gtest/gtest.h>

namespace axisgate::drive {
namespace {

constexpr Instant kStart = kLongAgo + std::chrono::hours(1);
constexpr model::ObjectId kShort = 0, kLong = 1;

bus::Exchange read(std::uint8_t bytes) { return {1, bus::Access::read, {}, bytes, 0}; }

class RtuResync : public testing::Test {
 protected:
  RtuResync() {
    objects[kShort].size = 2;
    objects[kLong].size = 4;
    facts.by_length = true;
    facts.candidates = {{kShort, 0}, {kLong, 0}};
  }
  void lose(std::uint8_t bytes, int times) {
    for (int i = 0; i < times; ++i) resync.lost(read(bytes), kStart);
  }
  /// Reads of this object that are answered and not believed before another is.
  int counted(model::ObjectId object) {
    int answers = 0;
    for (; resync.suspect() && !resync.candidate(); ++answers) {
      EXPECT_EQ(resync.counted().object, object);
      resync.counted_one();
    }
    return answers;
  }

  std::vector<model::ObjectDef> objects{2};
  model::ResyncProperties facts;
  Resync resync{facts, objects};
};

TEST_F(RtuResync, CountsOneReplyMoreThanWasLostOfTheLengthLostLeastAndBelievesTheOther) {
  lose(2, 3);
  lose(4, 2);
  ASSERT_TRUE(resync.counts_out());
  EXPECT_EQ(counted(kLong), 3);
  EXPECT_EQ(resync.candidate()->object, kShort);
  EXPECT_TRUE(resync.suspect());
}

TEST_F(RtuResync, ACountedReadThatIsLostIsNoReply) {
  lose(2, 1);
  lose(4, 1);
  EXPECT_EQ(resync.counted().object, kShort);
  resync.counted_one();
  EXPECT_EQ(resync.counted().object, kShort);
  lose(2, 5);
  EXPECT_EQ(counted(kShort), 1);
  EXPECT_EQ(resync.candidate()->object, kLong);
  // Then the believed one: of its length one is owed now, and all that was owed before is out.
  lose(4, 1);
  EXPECT_EQ(counted(kLong), 2);
  EXPECT_EQ(resync.candidate()->object, kShort);
}

TEST_F(RtuResync, BeginsAnewWhenAReadOfTheOtherLengthIsLostMeanwhile) {
  lose(2, 1);
  lose(4, 3);
  EXPECT_EQ(resync.counted().object, kShort);
  resync.counted_one();
  lose(4, 1);
  EXPECT_EQ(counted(kShort), 2);
}

TEST_F(RtuResync, AWriteThatIsLostChangesNothing) {
  lose(2, 1);
  lose(4, 3);
  EXPECT_EQ(resync.counted().object, kShort);
  resync.counted_one();
  resync.lost({1, bus::Access::write, {}, 4, 0}, kStart);
  EXPECT_EQ(counted(kShort), 1);
}

TEST_F(RtuResync, LeavesTheSilenceAloneWhereTheProfileHasOneLengthOrTheDriveRefusesTheOther) {
  lose(2, 1);
  lose(4, 1);
  resync.refused(read(4), kStart);
  EXPECT_FALSE(resync.counts_out());
  resync.answered();
  facts.candidates = {{kShort, 0}};
  lose(2, 2);
  EXPECT_FALSE(resync.counts_out());
}

TEST_F(RtuResync, CountsNoFurtherThanItsBound) {
  lose(2, 10 * Resync::kMaxOwed);
  lose(4, 10 * Resync::kMaxOwed);
  EXPECT_EQ(counted(kShort), Resync::kMaxOwed + 1);
}

}  // namespace
}  // namespace axisgate::drive
