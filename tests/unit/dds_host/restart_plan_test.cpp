// SPDX-License-Identifier: Apache-2.0
// When axisgate-dds is started again, and what is told of its ends.
#include "gateway/upstream/host/restart_plan.hpp"

#include <gmock/gmock.h>

#include <csignal>

#include "gateway/core/line_bucket.hpp"
#include "gateway/upstream/dds_host/dds_program.hpp"
#include "gateway/upstream/host/taking_watch.hpp"
#include "gateway/upstream/link/exit_codes.hpp"

namespace axisgate::dds {
namespace {

using namespace host;

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Optional;

const ProcessEnd kNoParticipant{ProcessEnd::How::exited, link::kExitCannotServe};
const ProcessEnd kCrash{ProcessEnd::How::killed, SIGSEGV};
constexpr Instant kStart{seconds(1000)};

std::vector<std::int64_t> pauses_ms(RestartPlan& plan, int count, const ProcessEnd& end) {
  std::vector<std::int64_t> out;
  for (int i = 0; i < count; ++i)
    out.push_back(std::chrono::duration_cast<milliseconds>(plan.on_end(end, kStart).pause).count());
  return out;
}

TEST(RestartPlan, DoublesItsPausesUpToHalfAMinute) {
  RestartPlan plan(kProgram);
  EXPECT_THAT(pauses_ms(plan, 10, kCrash), ElementsAre(200, 400, 800, 1600, 3200, 6400, 12800, 25600, 30000, 30000));
}

TEST(RestartPlan, BeginsAnewAfterAMinuteThatItRanWell) {
  RestartPlan plan(kProgram);
  static_cast<void>(pauses_ms(plan, 9, kCrash));
  static_cast<void>(plan.on_ready("1", kStart));
  EXPECT_EQ(plan.on_end(kCrash, kStart + kRanWell).pause, kFirstPause);
}

TEST(RestartPlan, GoesOnDoublingWhereItCrashesSoonAfterItWasReady) {
  RestartPlan plan(kProgram);
  static_cast<void>(pauses_ms(plan, 3, kCrash));
  static_cast<void>(plan.on_ready("1", kStart));
  EXPECT_EQ(plan.on_end(kCrash, kStart + kRanWell - Duration(1)).pause, milliseconds(1600));
}

TEST(RestartPlan, DoesNotCountTheTimeInWhichItWasNotReady) {
  RestartPlan plan(kProgram);
  static_cast<void>(plan.on_ready("1", kStart));
  static_cast<void>(plan.on_end(kCrash, kStart + seconds(1)));
  EXPECT_EQ(plan.on_end(kCrash, kStart + seconds(1000)).pause, milliseconds(400));
}

TEST(RestartPlan, TellsAnEndAndWhenItGoesOn) {
  RestartPlan plan(kProgram);
  EXPECT_THAT(plan.on_end(kCrash, kStart).report,
              Optional(std::string("axisgate-dds crashed: signal 11 (SEGV); started again in 0.2 s")));
}

TEST(RestartPlan, TellsAnotherEndAndTheSameOneAfterItWasReady) {
  RestartPlan plan(kProgram);
  EXPECT_TRUE(plan.on_end(kNoParticipant, kStart).report);
  EXPECT_FALSE(plan.on_end(kNoParticipant, kStart).report) << "once";
  EXPECT_TRUE(plan.on_end(kCrash, kStart).report);
  EXPECT_EQ(plan.on_ready("1.2", kStart), "axisgate-dds 1.2 runs, after 3 ends");
  EXPECT_TRUE(plan.on_end(kCrash, kStart).report);
  EXPECT_EQ(plan.on_ready("1.2", kStart), "axisgate-dds 1.2 runs");
}

TEST(RestartPlan, SaysThatAMissingProgramIsLookedForAgain) {
  RestartPlan plan(kProgram);
  EXPECT_THAT(plan.on_end({ProcessEnd::How::not_found, 0, "there is no /usr/bin/axisgate-dds"}, kStart).report,
              Optional(std::string("axisgate-dds is not installed: there is no /usr/bin/axisgate-dds; it is looked for "
                                   "again from time to time")));
}

TEST(RestartPlan, LooksEachSecondForAnInterfaceThatIsNotThereYet) {
  const ProcessEnd no_address{ProcessEnd::How::exited, link::kExitNoAddress};
  RestartPlan plan(kProgram);
  EXPECT_THAT(plan.on_end(no_address, kStart).report,
              Optional(std::string("axisgate-dds has no address yet on one of its `interfaces`, which its own line of "
                                   "the log names; trying again each second")));
  EXPECT_THAT(pauses_ms(plan, 9, no_address), Each(1000));
  EXPECT_FALSE(plan.on_end(no_address, kStart).report) << "once";
  EXPECT_EQ(plan.on_end(kCrash, kStart).pause, kFirstPause) << "it has failed in nothing";
}

TEST(ProcessEnd, HasWordsOfItsOwnForEachWay) {
  std::vector<std::string> words;
  for (const int code : {link::kExitGatewayGone, 1, link::kExitUsage, link::kExitInternal, link::kExitCannotServe,
                         link::kExitProtocol, link::kExitMemory, link::kExitNoAddress})
    words.push_back(text(kProgram, {ProcessEnd::How::exited, code}));
  for (const int signal : {SIGKILL, SIGBUS, SIGSEGV, SIGTERM})
    words.push_back(text(kProgram, {ProcessEnd::How::killed, signal}));
  for (auto how = ProcessEnd::How::unknown; how <= ProcessEnd::How::closed;
       how = static_cast<ProcessEnd::How>(static_cast<int>(how) + 1))
    words.push_back(text(kProgram, {how, 2, "x"}));
  for (const std::string& word : words) {
    EXPECT_EQ(std::count(words.begin(), words.end(), word), 1) << word;
    EXPECT_TRUE(word.starts_with("axisgate-dds ")) << word;
  }
}

TEST(LineBucket, TakesABurstThenAFewAndCountsTheRest) {
  LineBucket limit;
  int taken = 0;
  for (int i = 0; i < 100; ++i) taken += limit.takes(kStart) ? 1 : 0;
  EXPECT_EQ(taken, LineBucket::kBurst);
  EXPECT_EQ(limit.left_out(), 80U);
  EXPECT_EQ(limit.left_out(), 0U);
  EXPECT_TRUE(limit.takes(kStart + LineBucket::kEach));
  EXPECT_FALSE(limit.takes(kStart + LineBucket::kEach));
}

TEST(LineBucket, NeverSavesUpMoreThanABurst) {
  LineBucket limit;
  static_cast<void>(limit.takes(kStart));
  int taken = 0;
  for (int i = 0; i < 100; ++i) taken += limit.takes(kStart + seconds(3600)) ? 1 : 0;
  EXPECT_EQ(taken, LineBucket::kBurst);
}

// Each packet of 100 bytes is 300 to the system.
TEST(TakingWatch, FindsAReaderStuckThatTookNothingForTenSeconds) {
  TakingWatch watch;
  watch.on_ready(kStart);
  for (int second = 1; second < 10; ++second) {
    watch.on_sent(100);
    EXPECT_FALSE(watch.stuck(300U * static_cast<unsigned>(second), kStart + seconds(second)));
  }
  EXPECT_TRUE(watch.stuck(2700, kStart + seconds(10))) << "also where nothing more was sent";
}

TEST(TakingWatch, LeavesAReaderAloneThatHasNothingToRead) {
  TakingWatch watch;
  watch.on_ready(kStart);
  EXPECT_FALSE(watch.stuck(0, kStart + seconds(100)));
}

TEST(TakingWatch, LeavesAReaderAloneThatIsAlwaysBehind) {
  TakingWatch watch;
  watch.on_ready(kStart);
  for (int second = 1; second < 100; ++second) {
    watch.on_sent(1000);
    EXPECT_FALSE(watch.stuck(90000, kStart + seconds(second)));
  }
}

TEST(TakingWatch, BeginsAnewWithEachProcess) {
  TakingWatch watch;
  watch.on_ready(kStart);
  EXPECT_FALSE(watch.stuck(300, kStart + seconds(9)));
  watch.on_ready(kStart + seconds(9));
  EXPECT_FALSE(watch.stuck(300, kStart + seconds(10)));
}

}  // namespace
}  // namespace axisgate::dds
