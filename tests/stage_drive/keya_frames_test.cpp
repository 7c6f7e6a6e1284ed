// SPDX-License-Identifier: Apache-2.0
// One frame commands both motors: what it says of the one that is not meant.
#include <gmock/gmock.h>

#include "tests/stage_drive/keya_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using drive::ControlFrame;
using drive::MotorShows;

KeyaOptions composed(std::int16_t mode = 3) { return {.speech = Speech::composed, .modes = {mode}}; }

/// Both motors run, A forwards and B backwards.
void both_run(KeyaRig& rig) {
  rig.online();
  rig.enable(0);
  rig.enable(1);
  rig.run_at(0, kRpm150);
  rig.run_at(1, -kRpm150);
}

TEST(KeyaFrames, EachCarriesTheWholeDesiredStateOfBothMotors) {
  KeyaRig rig(composed());
  both_run(rig);
  rig.mark();
  ASSERT_EQ(KeyaRig::code(rig.write(0, Quantity::target_velocity, 2 * kRpm150)), Errc::ok);
  ASSERT_EQ(rig.writes().size(), 1U);
  const bus::Exchange frame = rig.writes().front().exchange;
  EXPECT_EQ(frame.more.size(), 3U);
  EXPECT_EQ(KeyaRig::field(frame, kEnable, 1), 1);
  EXPECT_EQ(KeyaRig::field(frame, kEnable, 2), 1);
  EXPECT_EQ(KeyaRig::field(frame, kValue, 1), 2 * kRaw150);
  EXPECT_EQ(KeyaRig::field(frame, kValue, 2), -kRaw150);
}

TEST(KeyaFrames, AllFieldsOfAFrameCountAsTold) {
  KeyaRig rig(composed());
  rig.online();
  rig.enable(0);
  for (const std::string field : {"A.on", "A.velocity", "B.on", "B.velocity"})
    EXPECT_TRUE(rig.stored(field).cached) << field;
  EXPECT_EQ(rig.stored("A.on").number, 1);
  EXPECT_EQ(rig.stored("B.on").number, 0);
  rig.run_at(0, kRpm150);
  EXPECT_EQ(rig.stored("A.velocity").number, kRaw150);
  EXPECT_EQ(rig.stored("A.target").number, kRaw150) << "the same place, by another name";
}

TEST(KeyaFrames, AMotorThatHasTrippedIsNeverTurnedOnByItsNeighboursFrame) {
  KeyaRig rig(composed());
  both_run(rig);
  rig.motor(1).enabled = false;
  rig.motor(1).faults = 0x0040;
  ASSERT_TRUE(rig.run_until([&] { return rig.axis(1).has(AxisInput::fault); }));
  rig.motor(1).faults = 0;  // it could be turned on again
  const int enables = rig.motor(1).enables;
  for (int i = 1; i <= 20; ++i) {
    ASSERT_EQ(KeyaRig::code(rig.write(0, Quantity::target_velocity, i * 15'000)), Errc::ok);
    rig.run(7ms);
  }
  EXPECT_EQ(rig.motor(1).enables, enables);
  EXPECT_FALSE(rig.motor(1).enabled);
  EXPECT_TRUE(rig.motor(0).enabled);
}

TEST(KeyaFrames, AMotorThatIsDisabledIsNotTurnedOnByItsNeighboursFrame) {
  KeyaRig rig(composed());
  both_run(rig);
  const int enables = rig.motor(1).enables;
  const auto stop = rig.begin(1, KeyaRig::batch_of(Command::disable));
  const auto faster = rig.begin(0, KeyaRig::batch_of(Command::none, {{Quantity::target_velocity, 2 * kRpm150}}));
  ASSERT_TRUE(rig.run_until([&] { return stop->has_value() && faster->has_value(); }));
  EXPECT_EQ(KeyaRig::code(**stop), Errc::ok);
  EXPECT_EQ(KeyaRig::code(**faster), Errc::ok);
  rig.run(500ms);
  EXPECT_EQ(rig.motor(1).enables, enables);
  EXPECT_FALSE(rig.motor(1).enabled);
  EXPECT_EQ(rig.motor(1).value, 0) << "whether an off motor's value counts is not printed";
}

TEST(KeyaFrames, AMotorThatIsNoAxisIsOffAndAtZero) {
  KeyaRig rig({.speech = Speech::composed, .axes = 1});
  rig.online();
  rig.enable(0);
  rig.run_at(0, kRpm150);
  for (const Sent& s : rig.writes()) {
    EXPECT_EQ(KeyaRig::field(s.exchange, kEnable, 2), 0);
    EXPECT_EQ(KeyaRig::field(s.exchange, kValue, 2), 0);
  }
}

TEST(KeyaFrames, AnInvalidatedNeighbourIsLookedAtBeforeTheFrameAndNotTurnedOffByIt) {
  KeyaRig rig(composed());
  both_run(rig);
  // A timeout invalidates everything; a frame goes as soon as the resynchronisation read is answered.
  bool once = true;
  rig.wire->fate = [&](const bus::Exchange& e) {
    return e.object.index == kSpeedQuery && std::exchange(once, false) ? Fate::muted : Fate::answered;
  };
  ASSERT_TRUE(rig.run_until([&] { return rig.axis(0).link_state == LinkState::suspect; }));
  const auto faster = rig.begin(0, KeyaRig::batch_of(Command::none, {{Quantity::target_velocity, 2 * kRpm150}}));
  ASSERT_TRUE(rig.run_until([&] { return faster->has_value(); }));
  EXPECT_EQ(KeyaRig::code(**faster), Errc::ok);
  EXPECT_TRUE(rig.motor(1).enabled);
  EXPECT_EQ(rig.motor(1).enables, 1);
  EXPECT_EQ(rig.motor(1).value, -kRaw150);
}

TEST(KeyaFrames, OfASuspectDriveOnlyAStopIsSentAndItTurnsOnNobody) {
  KeyaRig rig(composed());
  both_run(rig);
  rig.wire->fate = [](const bus::Exchange& e) { return e.access == bus::Access::read ? Fate::muted : Fate::answered; };
  ASSERT_TRUE(rig.run_until([&] { return rig.axis(0).link_state == LinkState::suspect; }));
  rig.motor(1).enabled = false;  // it trips, and nobody can know
  rig.mark();
  const auto stop = rig.begin(0, KeyaRig::batch_of(Command::quick_stop));
  rig.run(5ms);
  rig.wire->fate = {};
  ASSERT_TRUE(rig.run_until([&] { return stop->has_value(); }));
  ASSERT_FALSE(rig.writes().empty());
  for (const Sent& s : rig.writes()) EXPECT_EQ(KeyaRig::field(s.exchange, kEnable, 2), 0);
  EXPECT_FALSE(rig.motor(0).enabled);
  EXPECT_EQ(rig.motor(1).enables, 1);
}

TEST(KeyaFrames, WithADriveFoundEnabledTheFirstFrameMovesNeitherMotor) {
  KeyaRig rig(composed(1));
  for (const std::size_t i : {0U, 1U}) {
    rig.motor(i).enabled = true;
    rig.motor(i).commanded = rig.runtime.now();
    rig.motor(i).value = rig.motor(i).enabled ? 40'000 : 0;
    rig.motor(i).position = 40'000;
  }
  rig.online();
  rig.mark();
  ASSERT_EQ(KeyaRig::code(rig.command(0, Command::quick_stop)), Errc::ok);
  EXPECT_FALSE(rig.motor(0).enabled);
  EXPECT_TRUE(rig.motor(1).enabled) << "nobody asked for that";
  rig.run(100ms);
  EXPECT_EQ(rig.motor(1).position, 40'000);
  EXPECT_EQ(KeyaRig::field(rig.writes().front().exchange, kValue, 2), 40'000) << "0 would be a place to go to";
}

TEST(KeyaFrames, ANeighbourFoundRunningKeepsAllButStopsFromBeingSent) {
  KeyaRig rig(composed());
  rig.motor(1).enabled = true;
  rig.motor(1).commanded = rig.runtime.now();
  rig.motor(1).value = 3'000;
  rig.online();
  rig.run(100ms);
  rig.mark();
  const BatchResult result = rig.command(0, Command::enable);
  EXPECT_EQ(KeyaRig::code(result), Errc::state_unsuitable) << "nobody knows what the other motor was told";
  EXPECT_EQ(result.outcome.detail, kDetailDeviceState);
  EXPECT_TRUE(rig.writes().empty());
  EXPECT_EQ(rig.motor(1).value, 3'000);
  ASSERT_EQ(KeyaRig::code(rig.command(1, Command::quick_stop)), Errc::ok);
  EXPECT_FALSE(rig.motor(1).enabled);
  EXPECT_EQ(KeyaRig::code(rig.command(0, Command::enable)), Errc::ok);
}

TEST(KeyaFrames, AfterTheLinksReturnNothingThatWasToldBeforeIsToldAgain) {
  KeyaRig rig(composed());
  both_run(rig);
  rig.wire->cut();
  rig.motor(0).enabled = rig.motor(1).enabled = false;
  rig.run(100ms);
  rig.wire->plug();
  rig.online();
  rig.mark();
  rig.enable(0);
  EXPECT_FALSE(rig.motor(1).enabled);
  EXPECT_EQ(rig.motor(0).value, 0);
}

// --- The rule alone ------------------------------------------------------------------------------------------------

struct Rule {
  model::DriveModel model = keya_model(composed());
  drive::ObjectStore store{model.objects};
  ControlFrame frame{model};
  std::vector<MotorShows> motors = std::vector<MotorShows>(2);

  [[nodiscard]] model::ObjectId id(const std::string& name) const {
    const auto at =
        std::find_if(model.objects.begin(), model.objects.end(), [&](const auto& o) { return o.name == name; });
    return static_cast<model::ObjectId>(at - model.objects.begin());
  }
  void told(const std::string& name, std::int64_t number) { store.acknowledged(id(name), number, Instant{} + 1h); }
  [[nodiscard]] std::optional<bus::Exchange> of(const std::string& name, std::int64_t number, bool stop = false) const {
    const model::ObjectDef& def = model.object(id(name));
    return frame.complete({1, bus::Access::write, def.address, 4, static_cast<std::uint32_t>(number)}, store, motors,
                          stop);
  }
};

TEST(KeyaFrameRule, AMotorIsOnOnlyIfItWasToldSoAndShowsIt) {
  for (const bool told : {false, true}) {
    for (const bool shows : {false, true}) {
      for (const bool disabling : {false, true}) {
        Rule rule;
        rule.motors[0].mode = rule.motors[1].mode = 3;
        rule.told("B.on", told ? 1 : 0);
        rule.motors[1].enabled = shows;
        rule.motors[1].disabling = disabling;
        const auto frame = rule.of("A.velocity", 5);
        ASSERT_TRUE(frame);
        EXPECT_EQ(KeyaRig::field(*frame, kEnable, 2), told && shows && !disabling ? 1 : 0);
      }
    }
  }
}

TEST(KeyaFrameRule, TheWriteItselfDecidesOfItsOwnMotor) {
  Rule rule;
  rule.motors[0].mode = rule.motors[1].mode = 3;
  EXPECT_EQ(KeyaRig::field(*rule.of("A.on", 1), kEnable, 1), 1);
  rule.told("A.on", 1);
  rule.told("A.velocity", 500);
  rule.motors[0].enabled = true;
  const auto off = rule.of("A.on", 0);
  EXPECT_EQ(KeyaRig::field(*off, kEnable, 1), 0);
  EXPECT_EQ(KeyaRig::field(*off, kValue, 1), 0);
}

TEST(KeyaFrameRule, AfterALostFrameWhatItAskedForIsAskedForAgain) {
  Rule rule;
  rule.motors[0].mode = rule.motors[1].mode = 3;
  rule.motors[1].enabled = true;
  rule.told("B.on", 1);
  rule.told("B.velocity", 700);
  rule.store.invalidate_all();
  EXPECT_EQ(KeyaRig::field(*rule.of("A.velocity", 1), kValue, 2), 700);
  rule.store.asked(rule.id("B.velocity"), 0, Instant{} + 2h);
  EXPECT_EQ(KeyaRig::field(*rule.of("A.velocity", 1), kValue, 2), 0) << "a stop that may not have arrived";
}

TEST(KeyaFrameRule, APositionIsNeverMadeUp) {
  Rule rule;
  rule.motors[0].mode = rule.motors[1].mode = 1;
  rule.motors[1].enabled = true;
  EXPECT_FALSE(rule.of("A.on", 1)) << "where motor B stands is not known";
  rule.motors[1].position = -9'000;
  EXPECT_EQ(KeyaRig::field(*rule.of("A.on", 0), kValue, 2), -9'000);
  rule.motors[1].moving = true;
  EXPECT_FALSE(rule.of("A.on", 0));
  EXPECT_EQ(KeyaRig::field(*rule.of("A.on", 0, true), kValue, 2), -9'000) << "a stop is sent all the same";
  rule.told("B.velocity", 1'234);
  EXPECT_EQ(KeyaRig::field(*rule.of("A.on", 0), kValue, 2), 1'234);
}

}  // namespace
}  // namespace axisgate::test
