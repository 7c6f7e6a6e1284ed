// The iD286pro's inputs and its four homing modes (iD286pro 5, 6).
#include <gtest/gtest.h>

#include "tests/unit/simulated/rtu_bench.hpp"

namespace axisgate::simulated {
namespace {

constexpr int running = 3;
constexpr int stopped = 2;
constexpr int disabled = 1;

struct Case {
  const char* name;
  int mode;
  std::uint16_t function;  // of IN2
  std::int64_t place;      // of the switch, in pulses from where the motor stands
};

class Id286proHomingMode : public testing::TestWithParam<Case> {
 protected:
  static Id286proOptions options(bool with_input) {
    Id286proOptions made;
    const Case& it = GetParam();
    if (it.function == 9) made.mechanics.positive_limit = it.place;
    if (it.function == 10) made.mechanics.negative_limit = it.place;
    if (it.function == 11) {
      made.mechanics.home_from = it.place;
      made.mechanics.home_to = it.place + 5000;
    }
    made.stored = {{305, it.mode}, {309, 500}, {310, 50}};
    if (with_input) made.stored[401] = it.function;
    return made;
  }
};

TEST_P(Id286proHomingMode, EndsOnTheEdgeOfItsSignalAndReadsZeroThere) {
  RtuBench bench(options(true));
  bench.write_pair(321, 777);
  bench.write(323, 8);
  EXPECT_EQ(bench.exchange(from_hex("01 06 01 43 00 0C 79 E7")).size(), 8U);
  EXPECT_EQ(bench.word(109), running);
  ASSERT_TRUE(bench.pass_until([&] { return bench.word(109) == stopped; }));
  EXPECT_EQ(bench.pair(117), 0);
  // Where the signal was first seen: within one millisecond's way at 5 rev/s.
  const std::int64_t edge =
      GetParam().place < 0 && GetParam().function == 11 ? GetParam().place + 5000 : GetParam().place;
  EXPECT_NEAR(static_cast<double>(counts_of(bench.id286pro().axis().physical())), static_cast<double>(edge), 50);
}

TEST_P(Id286proHomingMode, RunsOnAndOnWithoutAnInputForItsSignal) {
  RtuBench bench(options(false));
  bench.write_pair(317, 1000);
  bench.write_pair(319, -1000);  // the position means nothing yet: soft limits do not end the search
  bench.write(323, 12);
  bench.pass(std::chrono::minutes(5));
  EXPECT_EQ(bench.word(109), running);
  EXPECT_GT(std::abs(bench.pair(117)), 14'000'000);
  bench.write(323, 6);
  ASSERT_TRUE(bench.pass_until([&] { return bench.word(109) == stopped; }));
  EXPECT_NE(bench.pair(117), 0);
}

INSTANTIATE_TEST_SUITE_P(Modes, Id286proHomingMode,
                         testing::Values(Case{"clockwise_to_origin", 0, 11, 20000},
                                         Case{"counter_clockwise_to_origin", 1, 11, -20000},
                                         Case{"to_positive_limit", 2, 9, 12345},
                                         Case{"to_negative_limit", 3, 10, -12345}),
                         [](const auto& it) { return std::string(it.param.name); });

TEST(Id286proHoming, ALimitOnTheWayToTheOriginEndsIt) {
  Id286proOptions options;
  options.mechanics.positive_limit = 3000;
  options.stored = {{305, 0}, {400, 9}, {401, 11}};
  RtuBench bench(options);
  bench.write(323, 12);
  ASSERT_TRUE(bench.pass_until([&] { return bench.word(109) == stopped; }, std::chrono::seconds(5)));
  EXPECT_GE(bench.pair(117), 3000);
}

TEST(Id286proHoming, TheOriginMayBeTheSimulatedInputOrTheCommand11) {
  Id286proOptions options;
  options.stored = {{305, 0}, {401, 11}};
  RtuBench by_register(options);
  by_register.write(323, 12);
  by_register.pass(milliseconds(500));
  EXPECT_EQ(by_register.word(109), running);
  EXPECT_EQ(by_register.write(411, 1), 0);
  EXPECT_TRUE(by_register.pass_until([&] { return by_register.word(109) == stopped; }, std::chrono::seconds(5)));
  EXPECT_EQ(by_register.pair(117), 0);
  RtuBench by_command(options);
  by_command.write(323, 12);
  by_command.pass(milliseconds(500));
  by_command.write(323, 11);
  EXPECT_TRUE(by_command.pass_until([&] { return by_command.word(109) == stopped; }, std::chrono::seconds(5)));
  EXPECT_EQ(by_command.pair(117), 0);
}

TEST(Id286proInput, ARisingEdgeTriggersTheFunctionOnce) {
  Id286proOptions options;
  options.stored = {{400, 2}, {402, 7}};
  RtuBench bench(options);
  bench.write_pair(313, 40000);
  bench.id286pro().set_input(1, true);
  EXPECT_EQ(bench.word(109), running);
  EXPECT_EQ(bench.id286pro().starts().back().tag, 0U);  // nobody asked over the bus
  bench.id286pro().set_input(3, true);
  EXPECT_EQ(bench.word(109), stopped);
  bench.pass(milliseconds(100));
  EXPECT_EQ(bench.word(109), stopped);  // IN1 is still on, and triggers nothing any more
}

TEST(Id286proInput, ASimulatedInputTriggersLikeARealOne) {
  RtuBench bench(Id286proOptions{});
  bench.write(400, 4);
  EXPECT_EQ(bench.word(109), stopped);
  bench.write(410, 1);
  EXPECT_EQ(bench.word(109), running);
  bench.write(401, 7);
  bench.write(411, 1);
  EXPECT_EQ(bench.word(109), stopped);
}

TEST(Id286proInput, TheEnableFunctionFreesTheMotorWhileItsInputIsOff) {
  Id286proOptions options;
  options.stored = {{402, 20}};
  RtuBench bench(options);
  EXPECT_EQ(bench.word(109), disabled);
  bench.id286pro().set_input(3, true);
  EXPECT_EQ(bench.word(109), stopped);
  bench.write(323, 4);
  bench.id286pro().set_input(3, false);
  EXPECT_EQ(bench.word(109), disabled);
}

TEST(Id286proInput, WithExternalPulsesTheThirdTerminalFreesTheMotorAndFunctionsDoNothing) {
  Id286proOptions options;
  options.internal_pulses = false;
  options.stored = {{400, 13}};
  RtuBench bench(options);
  EXPECT_EQ(bench.word(109), stopped);
  bench.id286pro().set_input(3, true);
  EXPECT_EQ(bench.word(109), disabled);
  bench.id286pro().set_input(3, false);
  EXPECT_EQ(bench.word(109), stopped);
}

}  // namespace
}  // namespace axisgate::simulated
