// SPDX-License-Identifier: Apache-2.0
// Which lines the log takes.
#include "gateway/core/log_limit.hpp"

#include <gmock/gmock.h>

#include "gateway/core/log.hpp"

namespace axisgate {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::SizeIs;

struct LimitedLog : testing::Test {
  LimitedLog() {
    log.limit([this] { return now; });
  }
  void say(const std::string& message, LogPace pace = LogPace::minute, std::string_view source = "axis 1") {
    log.write(LogLevel::info, source, message, pace);
  }
  void pass(Duration time) {
    for (const Instant until = now + time; now < until;) {
      now += 10s;
      log.tell_left_out();
    }
  }
  Instant now{1000s};
  std::vector<std::string> lines;
  Log log{[this](LogLevel, std::string_view source, std::string_view message) {
            lines.push_back(std::string(source) + ": " + std::string(message));
          },
          LogLevel::debug};
};

TEST_F(LimitedLog, TellsTheFirstLineOfAKindAndCountsTheOthersInTheNext) {
  for (int i = 0; i < 100; ++i) {
    say("link online -> suspect");
    now += 100ms;
  }
  EXPECT_THAT(lines, ElementsAre("axis 1: link online -> suspect"));
  now += 50s;
  say("link online -> suspect");
  EXPECT_EQ(lines.back(), "axis 1: link online -> suspect (and 99 more since the last such line)");
}

TEST_F(LimitedLog, TellsWhatWasLeftOutWhenItsMinuteIsOver) {
  say("12 bad frames");
  for (int i = 13; i < 40; ++i) say(std::to_string(i) + " bad frames");
  pass(50s);
  EXPECT_THAT(lines, SizeIs(1));
  pass(10s);
  EXPECT_EQ(lines.back(), "axis 1: 39 bad frames (the newest of 27 left out)");
  pass(600s);
  EXPECT_THAT(lines, SizeIs(2)) << "once";
}

TEST_F(LimitedLog, TellsOneThatWasLeftOutAsItIs) {
  say("link suspect -> offline");
  say("link suspect -> offline");
  pass(60s);
  EXPECT_EQ(lines.back(), "axis 1: link suspect -> offline (told late)");
}

// However long it goes on: two lines of this kind are a minute apart at least.
TEST_F(LimitedLog, TakesOneLineAMinuteOfAKindForEver) {
  for (int second = 0; second < 3600; ++second) {
    say("link online -> suspect");
    if (second % 10 == 0) log.tell_left_out();
    now += 1s;
  }
  EXPECT_LE(lines.size(), 60U);
  EXPECT_GE(lines.size(), 50U);
}

TEST_F(LimitedLog, KnowsKindsSubjectsAndPlacesApart) {
  say("link online -> suspect");
  say("link suspect -> online");
  say("link online -> suspect", LogPace::minute, "axis 2");
  say("refused 10.0.0.1: full", LogPace::minute, "modbus");
  say("refused 10.0.0.2: full", LogPace::minute, "modbus");
  say("node 5: noise 3 times", LogPace::minute, "bus lift");
  say("node 6: noise 3 times", LogPace::minute, "bus lift");
  say("/modbus_tcp/0/listen: no", LogPace::minute, "gateway");
  say("/modbus_tcp/1/listen: no", LogPace::minute, "gateway");
  EXPECT_THAT(lines, SizeIs(9));
}

TEST_F(LimitedLog, TellsWhatWasCommandedOnceASecond) {
  for (int i = 0; i < 20; ++i) {
    say("10.0.0.1:50000: move to " + std::to_string(i), LogPace::second);
    now += 100ms;
  }
  EXPECT_THAT(lines, ElementsAre("axis 1: 10.0.0.1:50000: move to 0",
                                 "axis 1: 10.0.0.1:50000: move to 10 (and 9 more since the last such line)"));
  pass(60s);
  EXPECT_EQ(lines.back(), "axis 1: 10.0.0.1:50000: move to 19 (the newest of 9 left out)");
}

TEST_F(LimitedLog, LeavesOutNothingThatAPersonHasAskedFor) {
  for (int i = 0; i < 20; ++i) say("-> 01 03 " + std::to_string(i), LogPace::each);
  for (int i = 0; i < 20; ++i) log.write(LogLevel::debug, "modbus", "closed");
  EXPECT_THAT(lines, SizeIs(40));
}

TEST_F(LimitedLog, IsBoundedWhateverIsSaid) {
  const auto kind = [](std::size_t number) {
    std::string word;
    for (std::size_t rest = number + 1; rest > 0; rest /= 26) word += static_cast<char>('g' + rest % 20);
    return word + std::string(number % 300, 'x');
  };
  for (std::size_t i = 0; i < 4 * LogLimit::kMaxKinds; ++i) say(kind(i));
  EXPECT_LE(lines.size(), LogLimit::kMaxKinds);
  say("fault 0x3210", LogPace::second, "axis 2");
  EXPECT_EQ(lines.back(), "axis 2: fault 0x3210") << "there is always room for what an axis did";
  log.tell_left_out();
  EXPECT_TRUE(lines.back().starts_with("log: more kinds of lines within a minute than are told apart (the newest of "));
  pass(60s);
  say("something else");
  EXPECT_EQ(lines.back(), "axis 1: something else") << "there is room again";
}

TEST(LogKind, IsALineWithoutItsNumbers) {
  EXPECT_EQ(log_kind("position 12345 after 0.5 s"), log_kind("position 9 after 10.25 s"));
  EXPECT_EQ(log_kind("frame 01 03 FF A2"), log_kind("frame 0A B3 12 FE 77 C0"));
  EXPECT_EQ(log_kind("EMCY 0x8130 of register 0x11"), log_kind("EMCY 0xFF01 of register 0xA1"));
  EXPECT_EQ(log_kind("10.0.0.1:50000 wrote"), log_kind("10.0.0.1:50001 wrote"));
  EXPECT_EQ(log_kind("dds 10.0.0.1 010f1a2b00000000c0ffee01:00010c: first command"),
            log_kind("dds 10.0.0.1 010f77aa11111111deadbee5:000203: first command"));
  EXPECT_NE(log_kind("10.0.0.1:50000 wrote"), log_kind("10.0.0.2:50000 wrote"));
  EXPECT_NE(log_kind("link down: no device"), log_kind("link down: no answer"));
}

}  // namespace
}  // namespace axisgate
