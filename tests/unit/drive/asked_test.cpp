// SPDX-License-Identifier: Apache-2.0
// What was asked of an axis, and what of it holds after whatever came between (design 3.4 What survives, G1).
#include "gateway/drive/motion/asked.hpp"

#include <gmock/gmock.h>

#include <utility>

#include "gateway/drive/plan/planner.hpp"
#include "tests/unit/drive/kinco.hpp"

namespace axisgate::drive {
namespace {

using enum Quantity;
using testing::Optional;
constexpr ClientId kClient = 7;

WriteBatch batch_of(std::initializer_list<Setpoint> setpoints, Command command = Command::none) {
  WriteBatch batch;
  batch.client = kClient;
  batch.command = command;
  for (const Setpoint& sp : setpoints) batch.setpoints.push_back(sp);
  return batch;
}

class WhatWasAsked : public testing::Test {
 protected:
  static constexpr std::array kAll{target_position,  target_velocity, target_torque, max_torque,
                                   profile_velocity, homing_method,   homing_offset, max_velocity};
  void ask_all() {
    for (const Quantity each : kAll) {
      asked.accept(batch_of({{each, 5}}));
      asked.take(each, {.value = 5, .by = kClient});
    }
  }
  [[nodiscard]] std::vector<Quantity> accepted() const {
    std::vector<Quantity> out;
    for (const Quantity each : kAll)
      if (asked.accepted(each)) out.push_back(each);
    return out;
  }
  [[nodiscard]] std::vector<Quantity> taken() const {
    std::vector<Quantity> out;
    for (const Quantity each : kAll)
      if (asked.taken(each)) out.push_back(each);
    return out;
  }
  /// Of the velocity: a raw word on an enabled axis may run by it.
  [[nodiscard]] bool runs_by_word() const { return !record.set_aside_since(asked.taken(target_velocity)->at); }

  AxisRecord record;
  Asked asked{record};
};

TEST_F(WhatWasAsked, HoldsWithItsClientAndItsPoint) {
  EXPECT_FALSE(asked.accepted(target_velocity) || asked.taken(target_velocity));
  ask_all();
  EXPECT_THAT(accepted(), testing::ElementsAreArray(kAll));
  EXPECT_THAT(taken(), testing::ElementsAreArray(kAll));
  EXPECT_EQ(asked.taken(target_velocity)->by, kClient);
  EXPECT_LT(asked.taken(target_position)->at, asked.taken(target_velocity)->at) << "the later one is greater";
}

TEST_F(WhatWasAsked, VelocityAndTorqueEndWithEveryMotionThatEndsForGood) {
  ask_all();
  record.end();
  const std::vector<Quantity> left{target_position, max_torque,    profile_velocity,
                                   homing_method,   homing_offset, max_velocity};
  EXPECT_EQ(accepted(), left);
  EXPECT_EQ(taken(), left);
  ask_all();
  EXPECT_THAT(taken(), testing::ElementsAreArray(kAll)) << "asked for anew";
}

TEST_F(WhatWasAsked, ARestartLeavesTargetsAndWhatEachStartGoesBy) {
  ask_all();
  record.restarted();
  EXPECT_THAT(accepted(), testing::ElementsAre(target_position, target_velocity, target_torque))
      << "a parameter is what the drive holds";
  EXPECT_THAT(taken(),
              testing::ElementsAre(target_position, target_velocity, target_torque, max_torque, profile_velocity));
}

TEST_F(WhatWasAsked, WhatWasAcceptedMayWaitForItsTurn) {
  asked.take(target_velocity, {.value = 1});
  const WriteBatch waits = batch_of({{target_velocity, 2}});
  asked.accept(waits);
  EXPECT_THAT(asked.accepted(target_velocity), Optional(2));
  EXPECT_EQ(asked.taken(target_velocity)->value, 1) << "a start before it goes by the one before";
  asked.withdraw(waits);
  EXPECT_FALSE(asked.accepted(target_velocity)) << "nobody knows any more";
  EXPECT_EQ(asked.taken(target_velocity)->value, 1);
}

TEST_F(WhatWasAsked, AJogsSpeedIsNoTargetOfItsClient) {
  WriteBatch jog = batch_of({{target_velocity, 2}}, Command::run_velocity);
  jog.jogs = true;
  asked.accept(jog);
  EXPECT_FALSE(asked.accepted(target_velocity));
}

TEST_F(WhatWasAsked, ANumberOfTheMailboxIsExactUntilTheDriveCountsOtherwise) {
  asked.take(target_velocity, {.value = 1, .exact = 1234});
  EXPECT_THAT(asked.taken(target_velocity)->exact, Optional(1234));
  record.rescaled();
  EXPECT_EQ(asked.taken(target_velocity)->exact, std::nullopt);
  EXPECT_EQ(asked.taken(target_velocity)->value, 1);
  asked.take(target_velocity, {.value = 1, .exact = 2468});
  EXPECT_THAT(asked.taken(target_velocity)->exact, Optional(2468));
}

TEST_F(WhatWasAsked, WhatCameBesideAStopOrFromAnotherOwnerRunsByAStartAlone) {
  asked.take(target_velocity, {.value = 1});
  EXPECT_TRUE(runs_by_word());
  asked.take(target_velocity, {.value = 1}, true);
  EXPECT_FALSE(runs_by_word()) << "beside a stop";
  record.run();
  EXPECT_TRUE(runs_by_word()) << "it was started";
  record.set_aside();
  EXPECT_FALSE(runs_by_word()) << "another owner, while it stands";
  asked.take(target_position, {.value = 1}, true);
  asked.take(target_velocity, {.value = 1});
  EXPECT_TRUE(runs_by_word()) << "asked for by the new one";
  asked.take(target_position, {.value = 1}, true);
  EXPECT_TRUE(runs_by_word()) << "a position runs by no word";
}

TEST_F(WhatWasAsked, WhatTheGatewayHasChangedForAMomentIsOwed) {
  asked.owe(homing_offset, std::nullopt);
  EXPECT_EQ(asked.owed(homing_offset), std::nullopt) << "nobody knows what it was";
  asked.owe(homing_offset, 70);
  asked.owe(homing_offset, 0);
  EXPECT_THAT(asked.owed(homing_offset), Optional(70)) << "not what it was changed to";
  asked.forget(homing_offset);
  EXPECT_EQ(asked.owed(homing_offset), std::nullopt);
  asked.owe(homing_offset, 70);
  asked.take(homing_offset, {.value = 80, .by = kClient});
  EXPECT_EQ(asked.owed(homing_offset), std::nullopt) << "a client wants another one";
  asked.owe(homing_offset, 80);
  record.restarted();
  EXPECT_EQ(asked.owed(homing_offset), std::nullopt);
}

// With a drive beside it: what a start goes by.
class AskedOfADrive : public testing::Test {
 protected:
  AskedOfADrive() : model(kinco_jd()), store(model.objects) {}
  void ask(std::initializer_list<Setpoint> setpoints, Command command = Command::none) {
    remember_setpoints(core, batch_of(setpoints, command));
  }
  void press() { core.jog.start(Command::jog_forward, kClient, turn.now, std::chrono::seconds(1), record.accepted()); }
  void jog(std::int64_t speed) {
    press();
    WriteBatch batch = batch_of({{target_velocity, speed}}, Command::run_velocity);
    batch.jogs = true;
    remember_setpoints(core, batch);
    core.started(MotionKind::velocity, false, {});
  }
  [[nodiscard]] std::int64_t runs_at() const { return core.running_target(target_velocity).value_or(Wanted{}).value; }
  [[nodiscard]] bool writes_speed(std::int64_t raw) const {
    Plan plan;
    add_speeds(core, 1, plan);
    return std::ranges::any_of(
        plan.actions, [&](const Action& a) { return a.object == core.object_of(profile_velocity) && a.number == raw; });
  }

  model::DriveModel model;
  ObjectStore store;
  Turn turn{.now = kLongAgo, .link = LinkState::online};
  AxisRecord record;
  AxisCore core{model, model.axes[0], store, turn, Motion{model.axes[0].velocity_lag, record}};
};

TEST_F(AskedOfADrive, AJogRunsAtItsOwnSpeedAndLeavesTheClientsTarget) {
  ask({{target_velocity, 1}});
  press();
  EXPECT_EQ(runs_at(), 1) << "its turn has not come";
  core.jog.end();
  jog(50);
  EXPECT_EQ(runs_at(), 50);
  ask({{target_velocity, 2}});
  EXPECT_EQ(runs_at(), 50) << "beside it";
  core.jog.end();
  EXPECT_EQ(runs_at(), 2);
  press();
  EXPECT_EQ(runs_at(), 2) << "a new press has no speed of the one before";
}

TEST_F(AskedOfADrive, ARunThatFollowsAJogHasTheClientsTarget) {
  jog(50);
  ask({}, Command::run_velocity);
  EXPECT_EQ(runs_at(), 0) << "none was asked for";
  jog(50);
  ask({{target_velocity, 3}}, Command::run_velocity);
  EXPECT_EQ(runs_at(), 3);
}

TEST_F(AskedOfADrive, WhatEndsAMotionForGoodEndsTheSpeedOfAJog) {
  ask({{target_velocity, 1}});
  jog(50);
  record.end();
  EXPECT_EQ(runs_at(), 0);
  core.jog.end();
  EXPECT_EQ(runs_at(), 0) << "and the target of before";
}

TEST_F(AskedOfADrive, AJogStartsNothingOfTheOwnerBefore) {
  ask({{target_velocity, 1}});
  core.motion.owner_changed();
  jog(50);
  core.jog.end();
  EXPECT_TRUE(record.set_aside_since(core.running_target(target_velocity)->at));
  core.started(MotionKind::velocity, false, {});
  EXPECT_FALSE(record.set_aside_since(core.running_target(target_velocity)->at)) << "but a command does";
}

TEST_F(AskedOfADrive, AHomingGoesByTheMethodAskedForSinceTheDriveCameUpElseByTheConfiguredOne) {
  EXPECT_EQ(core.homing_method(), std::nullopt);
  ask({{homing_method, 17}});
  EXPECT_THAT(core.homing_method(), Optional(17));
  record.restarted();
  EXPECT_EQ(core.homing_method(), std::nullopt);
  model.axes[0].homing_method = 35;
  EXPECT_THAT(core.homing_method(), Optional(35));
  ask({{homing_method, 17}});
  EXPECT_THAT(core.homing_method(), Optional(17));
}

TEST_F(AskedOfADrive, ASpeedThatHasFailedOrDoesNotFitAnyMoreIsForgotten) {
  const Setpoint speed{.quantity = profile_velocity, .value = 1000, .exact = 4321};
  ask({speed});
  EXPECT_TRUE(writes_speed(4321));
  forget_speeds(core, batch_of({speed}));
  EXPECT_FALSE(writes_speed(4321));
  ask({speed});
  auto& binding = *std::ranges::find(model.axes[0].bindings, profile_velocity, &model::Binding::quantity);
  const Rational before = std::exchange(binding.raw_per_unit, Rational(2));
  rescale(core);
  EXPECT_TRUE(writes_speed(2000)) << "what was asked for, in the numbers of now";
  binding.raw_per_unit = Rational(1'000'000'000);
  rescale(core);
  binding.raw_per_unit = before;
  rescale(core);
  EXPECT_TRUE(core.asked.taken(profile_velocity) == std::nullopt) << "it did not fit once";
}

// A drive with one ramp for both: the later of the two is the one.
TEST_F(AskedOfADrive, WhereTwoSpeedsAreOneObjectTheLaterCounts) {
  auto& bindings = model.axes[0].bindings;
  const auto object = core.model.binding(profile_velocity)->object;
  std::ranges::find(bindings, profile_acceleration, &model::Binding::quantity)->object = object;
  const Setpoint velocity{.quantity = profile_velocity, .value = 0, .exact = 1000};
  const Setpoint ramp{.quantity = profile_acceleration, .value = 0, .exact = 2000};
  ask({velocity, ramp});
  EXPECT_FALSE(writes_speed(1000));
  EXPECT_TRUE(writes_speed(2000));
  ask({velocity});
  EXPECT_TRUE(writes_speed(1000));
  EXPECT_FALSE(writes_speed(2000));
  forget_speeds(core, batch_of({ramp}));
  EXPECT_FALSE(writes_speed(1000) || writes_speed(2000)) << "what it holds now is not known";
}

}  // namespace
}  // namespace axisgate::drive
