// SPDX-License-Identifier: Apache-2.0
// Design 3.4 What survives, for every drive and protocol: a fault, a drive's restart, a disable and a stop end every
// motion for good, and an enable after them is an enable and nothing else. A halt is none.
#include <gmock/gmock.h>

#include "tests/stage_drive/drive_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

enum class Ended : std::uint8_t { by_fault, by_restart, by_disable, by_quick_stop, by_halt };
constexpr std::array kEnds{Ended::by_fault, Ended::by_restart, Ended::by_disable, Ended::by_quick_stop, Ended::by_halt};

std::string ended_name(Ended how) {
  static const std::vector<std::string> names{"fault", "restart", "disable", "quick_stop", "halt"};
  return names.at(static_cast<std::size_t>(how));
}

class MotionEnded : public testing::TestWithParam<std::tuple<Subject, Ended>> {
 protected:
  MotionEnded() : rig(std::get<Subject>(GetParam())) {
    rig.online();
    EXPECT_EQ(code(Command::enable), Errc::ok);
    EXPECT_EQ(rig.ask(rig.motion()).outcome.code, Errc::ok);
    rig.stage.run(1s);
    EXPECT_TRUE(rig.turns());
  }
  Errc code(Command command) { return rig.command(command).outcome.code; }
  void end_it() {
    switch (std::get<Ended>(GetParam())) {
      case Ended::by_fault:
        rig.fail_the_drive();
        rig.stage.run(2s);
        EXPECT_FALSE(rig.turns());
        EXPECT_EQ(code(Command::fault_reset), Errc::ok);
        break;
      case Ended::by_restart:
        rig.restart_the_drive();
        rig.stage.run(3s);
        ASSERT_TRUE(rig.stage.come_online());
        break;
      case Ended::by_disable:
        EXPECT_EQ(code(Command::disable), Errc::ok);
        break;
      case Ended::by_quick_stop:
        EXPECT_EQ(code(Command::quick_stop), Errc::ok);
        break;
      case Ended::by_halt:
        EXPECT_EQ(code(Command::halt), Errc::ok);
        ASSERT_TRUE(rests());
        EXPECT_EQ(code(Command::end_halt), Errc::ok);
        break;
    }
  }
  bool rests() {
    return rig.stage.run_until([&] { return !rig.turns(); }, 15s);
  }
  DriveRig rig;
};

TEST_P(MotionEnded, DoesNotComeBackWithTheNextEnable) {
  end_it();
  ASSERT_TRUE(rests());
  rig.stage.run(2s);
  EXPECT_FALSE(rig.turns());
  const bool halted = std::get<Ended>(GetParam()) == Ended::by_halt;
  const bool gate = rig.subject() == Subject::id286pro && std::get<Ended>(GetParam()) == Ended::by_quick_stop;
  EXPECT_TRUE(halted || gate || !rig.powered()) << "nothing but enable enables";
  EXPECT_EQ(code(Command::enable), Errc::ok);
  EXPECT_TRUE(rig.powered());
  rig.stage.run(1500ms);
  EXPECT_FALSE(rig.turns()) << "velocity, torque and start are needed anew";
  EXPECT_EQ(rig.ask(rig.motion()).outcome.code, Errc::ok);
  rig.stage.run(500ms);
  EXPECT_TRUE(rig.turns());
}

INSTANTIATE_TEST_SUITE_P(Table, MotionEnded, testing::Combine(testing::ValuesIn(kSubjects), testing::ValuesIn(kEnds)),
                         [](const auto& case_of) {
                           return name(std::get<0>(case_of.param)) + "_" + ended_name(std::get<1>(case_of.param));
                         });

class HaltBeside : public testing::TestWithParam<Subject> {};

// Its word may be one that enables: an MD does so on 0x010F from any disabled state.
TEST_P(HaltBeside, ADisableOrAQuickStopNeverEnables) {
  const auto from = [](ClientId client, Command command) {
    WriteBatch batch = with_command(command);
    batch.client = client;
    return batch;
  };
  for (const Command other : {Command::disable, Command::quick_stop}) {
    for (const bool halt_first : {true, false}) {
      for (const Situation situation : {Situation::running, Situation::enabled}) {
        SCOPED_TRACE(std::string(text(other)) + (halt_first ? " after" : " before") + " a halt, " + name(situation));
        DriveRig rig(GetParam());
        rig.bring_to(situation);
        const auto one = rig.stage.begin(1, from(5, halt_first ? Command::halt : other));
        const auto two = rig.stage.begin(1, from(6, halt_first ? other : Command::halt));
        ASSERT_TRUE(rig.stage.run_until([&] { return one->has_value() && two->has_value(); }));
        const auto enabled = [&] { return rig.axis().has(AxisInput::enabled); };
        EXPECT_FALSE(enabled());
        EXPECT_FALSE(rig.stage.run_until(enabled, 2s));
        EXPECT_TRUE(rig.stage.run_until([&] { return !rig.turns(); }, 5s));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Table, HaltBeside, testing::ValuesIn(kSubjects), named);

}  // namespace
}  // namespace axisgate::test
