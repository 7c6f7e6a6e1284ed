// SPDX-License-Identifier: Apache-2.0
// When a fault is shown, and what is read before: the table of FaultWatch, without a drive.
#include "gateway/drive/state/fault_watch.hpp"

#include <gtest/gtest.h>

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;

constexpr model::ObjectId kStatus = 1, kWordOne = 2, kWordTwo = 3;

class FaultWatchTest : public testing::Test {
 protected:
  void see(bool faulted, std::uint16_t code = 0) {
    seen_.at = now_;
    seen_.known = true;
    seen_.faulted = faulted;
    seen_.statusword_exchange = ++exchange_;
    look(code);
  }
  void read_words(std::uint16_t code, std::int64_t number) {
    for (auto& word : seen_.words) {
      word.exchange = ++exchange_;
      word.number = word.object == kWordOne ? number : 0;
    }
    look(code);
  }
  void look(std::uint16_t code = 0) {
    seen_.at = now_;
    watch_.observe(seen_);
    watch_.name(code);
  }
  std::vector<model::ObjectId> reads() {
    std::vector<model::ObjectId> out;
    for (int i = 0; i < 10; ++i) {
      const auto next = watch_.next(now_);
      if (!next) break;
      out.push_back(*next);
      watch_.asked(now_);
    }
    return out;
  }
  FaultWatch watch_;
  Instant now_ = Instant{} + 1h;
  std::uint64_t exchange_ = 10;
  FaultWatch::Seen seen_{.statusword = kStatus,
                         .words = {FaultWatch::Word{.object = kWordOne}, FaultWatch::Word{.object = kWordTwo}}};
};

TEST_F(FaultWatchTest, ReadsEachWordOnceAndShowsTheFaultWithWhatTheyName) {
  see(false);
  read_words(0, 0);
  EXPECT_EQ(reads(), std::vector<model::ObjectId>{});
  see(true);
  EXPECT_TRUE(watch_.withheld());
  EXPECT_EQ(reads(), (std::vector<model::ObjectId>{kWordOne, kWordTwo}));
  read_words(0x3210, 0x20);
  EXPECT_FALSE(watch_.withheld());
  EXPECT_EQ(watch_.code(), 0x3210);
  EXPECT_EQ(reads(), std::vector<model::ObjectId>{});
}

TEST_F(FaultWatchTest, AskedInVainItAsksAgainAfterAPauseAndGivesUpAfterHalfASecond) {
  see(true);
  const Instant risen = now_;
  std::size_t asked = 0;
  for (; watch_.withheld(); now_ += 1ms, look()) asked += reads().size();
  EXPECT_EQ(now_ - risen, kCauseTime);
  EXPECT_EQ(asked, 2 * static_cast<std::size_t>(kCauseTime / kCausePause));
  EXPECT_EQ(watch_.code(), 0);
  EXPECT_EQ(watch_.deadline(), kNever);
}

TEST_F(FaultWatchTest, WordsReadBeforeTheFaultAreNoCauseOfIt) {
  see(false);
  read_words(0, 0);
  const std::uint64_t before = exchange_;
  see(true);
  EXPECT_FALSE(watch_.counts(false, before));
  EXPECT_TRUE(watch_.counts(false, exchange_ + 1));
  EXPECT_TRUE(watch_.counts(true, before)) << "what the statusword is made from";
}

TEST_F(FaultWatchTest, WordsThatAllAreRefusedAreNotAskedAndAnEmergencyIsEnough) {
  for (auto& word : seen_.words) word.refused = true;
  see(false);
  watch_.emergency(0x4210, now_, exchange_);
  see(true);
  EXPECT_EQ(reads(), std::vector<model::ObjectId>{});
  EXPECT_FALSE(watch_.withheld());
  EXPECT_EQ(watch_.code(), 0x4210);
  watch_.emergency(0, now_, exchange_);
  look();
  EXPECT_EQ(watch_.code(), 0x4210) << "as long as it is faulted that was its cause";
}

TEST_F(FaultWatchTest, AnEmergencyOfNoFaultIsForgotten) {
  for (auto& word : seen_.words) word.refused = true;
  see(false);
  watch_.emergency(0x4210, now_, exchange_);
  now_ += kCauseTime;
  see(false);
  see(true);
  EXPECT_EQ(watch_.code(), 0);
}

TEST_F(FaultWatchTest, AnEmergencyOfOneFaultIsNoCauseOfTheNextHoweverSoonThatComes) {
  for (auto& word : seen_.words) word.refused = true;
  see(false);
  watch_.emergency(0x2310, now_, exchange_);
  see(true);
  ASSERT_EQ(watch_.code(), 0x2310);
  now_ += kCauseTime / 4;
  see(false);
  now_ += kCauseTime / 4;
  see(true);
  EXPECT_EQ(watch_.code(), 0);
  EXPECT_TRUE(watch_.withheld()) << "it may still say what this one is";
  watch_.emergency(0x4210, now_, exchange_);
  look();
  EXPECT_EQ(watch_.code(), 0x4210);
}

TEST_F(FaultWatchTest, AWordBeforeItsStatuswordWaitsForItAndAWarningIsShownThen) {
  see(false);
  read_words(0x5441, 0x400);
  EXPECT_TRUE(watch_.words_ahead());
  EXPECT_EQ(reads(), std::vector<model::ObjectId>{kStatus});
  see(false, 0x5441);
  EXPECT_FALSE(watch_.words_ahead());
  read_words(0x5441, 0x400);
  EXPECT_FALSE(watch_.words_ahead()) << "it is known";
}

TEST_F(FaultWatchTest, AFaultThatIsOverBeforeItWasNamedIsMissedOnce) {
  see(true);
  see(false);
  EXPECT_TRUE(watch_.take_missed());
  EXPECT_FALSE(watch_.take_missed());
  EXPECT_TRUE(watch_.take_over());
}

}  // namespace
}  // namespace axisgate::drive
