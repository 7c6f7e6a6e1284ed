// SPDX-License-Identifier: Apache-2.0
// What names a fault, and what is read for it: the table of FaultWatch, without a drive.
#include "gateway/drive/state/fault_watch.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;

constexpr model::ObjectId kWordOne = 2, kWordTwo = 3;
constexpr std::uint16_t kSent = 0x4210, kRead = 0x3210;

class FaultWatchTest : public testing::Test {
 protected:
  void see(bool faulted, std::uint16_t code = 0) {
    seen_.at = now_;
    seen_.known = true;
    seen_.faulted = faulted;
    seen_.statusword_exchange = ++exchange_;
    look(code);
  }
  void read_word(std::size_t word, std::uint16_t code) {
    seen_.words.at(word).exchange = ++exchange_;
    look(code);
  }
  void read_words(std::uint16_t code) {
    read_word(0, code);
    read_word(1, code);
  }
  void look(std::uint16_t code = 0) {
    seen_.at = now_;
    watch_.observe(seen_);
    watch_.name(code);
  }
  void pass(Duration time, std::uint16_t code = 0) {
    now_ += time;
    look(code);
  }
  void send(std::uint16_t code) {
    watch_.emergency(code, now_, exchange_);
    look();
  }
  void refuse_words() {
    for (auto& word : seen_.words) word.refused = true;
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
  FaultWatch::Seen seen_{.words = {FaultWatch::Word{.object = kWordOne}, FaultWatch::Word{.object = kWordTwo}}};
};

TEST_F(FaultWatchTest, ReadsEachWordOnceAndTheyNameTheFaultOnceAllWereRead) {
  see(false);
  read_words(0);
  EXPECT_EQ(reads(), std::vector<model::ObjectId>{});
  see(true);
  EXPECT_FALSE(watch_.cause_known());
  EXPECT_EQ(reads(), (std::vector<model::ObjectId>{kWordOne, kWordTwo}));
  read_word(0, kRead);
  EXPECT_FALSE(watch_.cause_known()) << "the second may say more";
  read_word(1, kRead + 1);
  EXPECT_TRUE(watch_.cause_known() && watch_.settled());
  EXPECT_EQ(watch_.code(), kRead + 1);
  EXPECT_EQ(reads(), std::vector<model::ObjectId>{});
}

TEST_F(FaultWatchTest, AskedInVainItAsksAgainAfterAPauseAndGivesUpAfterHalfASecond) {
  see(true);
  const Instant risen = now_;
  std::size_t asked = 0;
  for (; !watch_.cause_known(); pass(1ms)) asked += reads().size();
  EXPECT_EQ(now_ - risen, kCauseTime);
  EXPECT_EQ(asked, 2 * static_cast<std::size_t>(kCauseTime / kCausePause));
  EXPECT_TRUE(watch_.settled());
  EXPECT_EQ(watch_.code(), 0);
  EXPECT_EQ(watch_.deadline(), kNever);
}

TEST_F(FaultWatchTest, ACauseThatComesAfterHalfASecondIsNamedAllTheSame) {
  see(true);
  pass(kCauseTime);
  read_word(0, kRead);
  EXPECT_EQ(watch_.code(), kRead);
  see(false);
  see(true);
  pass(kCauseTime);
  send(kSent);
  EXPECT_EQ(watch_.code(), kSent);
}

TEST_F(FaultWatchTest, ItSaysWhenItMustBeLookedAtAgain) {
  see(true);
  EXPECT_EQ(watch_.deadline(), now_ + kCauseTime);
  EXPECT_EQ(reads().size(), 2U);
  EXPECT_EQ(watch_.deadline(), now_ + kCausePause);
}

TEST_F(FaultWatchTest, WordsReadBeforeTheFaultAreNoCauseOfIt) {
  see(false);
  read_words(kRead);
  const std::uint64_t before = exchange_;
  see(true, kRead);
  EXPECT_FALSE(watch_.counts(false, before));
  EXPECT_TRUE(watch_.counts(false, exchange_ + 1));
  EXPECT_TRUE(watch_.counts(true, before)) << "what the statusword is made from";
  EXPECT_FALSE(watch_.cause_known());
}

TEST_F(FaultWatchTest, AnEmergencyNamesTheFaultAtOnceAndItsWordsAreReadAllTheSame) {
  see(false);
  send(kSent);
  see(true);
  EXPECT_TRUE(watch_.cause_known());
  EXPECT_EQ(watch_.code(), kSent);
  EXPECT_FALSE(watch_.settled());
  EXPECT_EQ(reads(), (std::vector<model::ObjectId>{kWordOne, kWordTwo}));
  read_words(kRead);
  EXPECT_TRUE(watch_.settled());
  EXPECT_EQ(watch_.code(), kRead) << "what it holds says more than what it has sent";
  send(kSent);
  EXPECT_EQ(watch_.code(), kRead);
}

TEST_F(FaultWatchTest, WordsThatAllAreRefusedAreNotAskedAndAnEmergencyIsEnough) {
  refuse_words();
  see(false);
  send(kSent);
  see(true);
  EXPECT_EQ(reads(), std::vector<model::ObjectId>{});
  EXPECT_TRUE(watch_.settled());
  EXPECT_EQ(watch_.code(), kSent);
  send(0);
  EXPECT_EQ(watch_.code(), kSent) << "as long as it is faulted that was its cause";
  send(kSent + 1);
  EXPECT_EQ(watch_.code(), kSent + 1) << "a second one behind the first";
}

TEST_F(FaultWatchTest, AnEmergencyOfNoFaultIsForgotten) {
  refuse_words();
  see(false);
  send(kSent);
  now_ += kCauseTime;
  see(false);
  see(true);
  EXPECT_EQ(watch_.code(), 0);
}

TEST_F(FaultWatchTest, AnEmergencyOfOneFaultIsNoCauseOfTheNextHoweverSoonThatComes) {
  refuse_words();
  see(false);
  send(kSent);
  see(true);
  ASSERT_EQ(watch_.code(), kSent);
  now_ += kCauseTime / 4;
  see(false);
  now_ += kCauseTime / 4;
  see(true);
  EXPECT_EQ(watch_.code(), 0);
  EXPECT_FALSE(watch_.cause_known()) << "it may still say what this one is";
  send(kRead);
  EXPECT_EQ(watch_.code(), kRead);
}

TEST_F(FaultWatchTest, WordsOfOneFaultAreNoCauseOfTheNext) {
  see(true);
  read_words(kRead);
  ASSERT_EQ(watch_.code(), kRead);
  see(false);
  EXPECT_TRUE(watch_.take_over());
  EXPECT_FALSE(watch_.take_over());
  EXPECT_EQ(watch_.code(), 0);
  see(true);
  EXPECT_FALSE(watch_.cause_known());
  EXPECT_EQ(reads(), (std::vector<model::ObjectId>{kWordOne, kWordTwo}));
}

TEST_F(FaultWatchTest, ABringUpBeginsAnewButForWhatTheDriveHasSent) {
  see(true);
  read_words(kRead);
  seen_.known = false;
  send(kSent);
  EXPECT_FALSE(watch_.cause_known());
  see(true);
  EXPECT_EQ(watch_.code(), kSent);
}

}  // namespace
}  // namespace axisgate::drive
