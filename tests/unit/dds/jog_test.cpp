// SPDX-License-Identifier: Apache-2.0
// Jogging by DDS: a button that is held by saying so again and again (design 3.4 Jog).
#include <gmock/gmock.h>

#include "gateway/upstream/dds/command_batches.hpp"
#include "tests/unit/dds/dds_rig.hpp"
#include "tests/unit/drive/clients.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint8_t kForward = 31, kReverse = 32, kEnd = 33;
constexpr std::uint8_t kNotNew = 10;  // command_result not_new: held in vain

struct Jogged : testing::TestWithParam<AxisNumber> {
  DdsRig rig;
  AxisNumber axis = GetParam();
  dds::Guid writer = rig.writer(1);
  int jog(std::uint8_t number) { return jog_by(writer, number); }
  int jog_by(const dds::Guid& who, std::uint8_t number, double turns_per_s = 2) {
    dds::CommandRecord record = command(who, number, 0, axis);
    record.mask = dds::kHasJogVelocity;
    record.jog_velocity = turns_per_s * kTurn;
    return rig.ask(record).result;
  }
  /// The same command again each 100 ms; the last reply.
  int hold(std::uint8_t number, Duration time) {
    int result = 0;
    for (Duration done{}; done < time; done += 100ms) {
      result = jog(number);
      rig.run(100ms);
    }
    return result;
  }
  void enable() { ASSERT_EQ(rig.ask(writer, 1, axis).result, kDone); }
  bool stands() {
    return rig.run_until([&] { return !rig.turns(axis); }, 5s);
  }
  void die_with_the_button_held() {
    enable();
    EXPECT_EQ(jog(kForward), kDone);
    hold(kForward, 1s);
    rig.die(writer);
    rig.run(600ms);
    EXPECT_TRUE(stands());
  }
  double velocity() { return rig.state(axis).velocity / kTurn; }
};

TEST_P(Jogged, RunsWhileItsCommandComesAgainAndEndsWithItsEnd) {
  enable();
  EXPECT_EQ(jog(kReverse), kDone);
  EXPECT_EQ(hold(kReverse, 2s), kDone);
  EXPECT_NEAR(velocity(), -2, 0.1);
  EXPECT_EQ(rig.ask(writer, kEnd, axis).result, kDone);
  EXPECT_TRUE(stands());
  EXPECT_TRUE(rig.run_until([&] { return rig.state(axis).axis_state == 1; }, 1s)) << "standstill, enabled";
  EXPECT_EQ(jog(kForward), kDone);
  hold(kForward, 1s);
  EXPECT_GT(velocity(), 1);
  EXPECT_EQ(jog(kReverse), kDone) << "the other button";
  hold(kReverse, 2s);
  EXPECT_LT(velocity(), -1);
}

TEST_P(Jogged, EndsWhenItsCommandComesNoMoreThoughItsWriterLives) {
  enable();
  EXPECT_EQ(jog(kForward), kDone);
  hold(kForward, 1s);
  EXPECT_TRUE(rig.turns(axis));
  rig.run(600ms);
  EXPECT_TRUE(stands()) << "nobody holds the button, and beats are no button";
  EXPECT_EQ(hold(kForward, 1s), kNotNew) << "one that is still held after a pause starts nothing, and says so";
  EXPECT_FALSE(rig.turns(axis));
  EXPECT_EQ(rig.ask(writer, kEnd, axis).result, kDone);
  EXPECT_EQ(jog(kForward), kDone);
  hold(kForward, 500ms);
  EXPECT_TRUE(rig.turns(axis));
}

TEST_P(Jogged, ARefusedPressMayBePressedAgain) {
  EXPECT_EQ(jog(kForward), kUnsuitable) << "not enabled";
  enable();
  EXPECT_EQ(jog_by(writer, kForward, 0), kBadValue);
  EXPECT_EQ(jog(kForward), kDone);
  hold(kForward, 500ms);
  EXPECT_TRUE(rig.turns(axis));
}

TEST_P(Jogged, AButtonHeldInVainStartsNothingWhenTheAxisBecomesFree) {
  const auto owner = rig.writer(2);
  ASSERT_EQ(rig.ask(owner, 1, axis).result, kDone);
  EXPECT_EQ(jog(kForward), kNotOwner);
  EXPECT_EQ(hold(kForward, 300ms), kNotOwner);
  EXPECT_EQ(rig.ask(owner, 13, axis).result, kDone);
  EXPECT_EQ(hold(kForward, 500ms), kNotNew);
  EXPECT_FALSE(rig.turns(axis));
}

// Design 4: "never from a Modbus client". Its jog_velocity was in effect already, so what stands beside it asks for
// nothing: that took the axis, and the motor turned.
TEST_P(Jogged, AtTheVelocityThatIsInEffectTakesNoAxisFromItsOwner) {
  enable();
  EXPECT_EQ(jog(kForward), kDone);
  EXPECT_EQ(rig.ask(writer, kEnd, axis).result, kDone);
  ASSERT_TRUE(stands());
  EXPECT_EQ(rig.ask(writer, 13, axis).result, kDone);
  const auto owner = rig.writer(2);
  ASSERT_EQ(rig.ask(owner, 1, axis).result, kDone);
  EXPECT_EQ(jog(kForward), kNotOwner);
  EXPECT_FALSE(rig.turns(axis));
  EXPECT_EQ(rig.run_at(owner, 1, axis).result, kDone);
}

// Its process stood still, say, with the button held.
TEST_P(Jogged, AWriterThatComesBackHasNotPressedItsButtonAnew) {
  die_with_the_button_held();
  static_cast<void>(rig.writer(1));
  EXPECT_EQ(hold(kForward, 1s), kNotNew);
  EXPECT_FALSE(rig.turns(axis));
  EXPECT_EQ(rig.ask(writer, kEnd, axis).result, kDone);
  enable();
  EXPECT_EQ(jog(kForward), kDone);
  hold(kForward, 500ms);
  EXPECT_TRUE(rig.turns(axis));
}

INSTANTIATE_TEST_SUITE_P(Both, Jogged, testing::Values(kServo, kStepper),
                         [](const auto& each) { return std::string(each.param == kServo ? "servo" : "virtual"); });

}  // namespace
}  // namespace axisgate::test
