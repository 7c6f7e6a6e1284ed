// SPDX-License-Identifier: Apache-2.0
// What leaves for a motor is judged by what it could do, whoever has planned it.
#include "gateway/drive/plan/way_out.hpp"

#include <gtest/gtest.h>

#include "gateway/drive/plan/planner.hpp"
#include "gateway/profile/resolve/profile_resolve.hpp"
#include "tests/places.hpp"

namespace axisgate::drive {
namespace {

constexpr std::int64_t kEnabled = 0x0637, kDisabled = 0x0250;

class WayOut : public testing::Test {
 protected:
  using Constants = decltype(profile::ResolveInput::constants);
  explicit WayOut(const char* profile = "kinco-jd", const char* protocol = "canopen", Constants constants = {})
      : model(resolved(profile, protocol, std::move(constants))), store(model.objects) {}
  static model::DriveModel resolved(const char* profile, const char* protocol, Constants constants) {
    profile::ResolveInput input;
    input.protocol = protocol;
    input.constants = std::move(constants);
    profile::ResolveAxis axis;
    axis.number = 1;
    input.axes = {axis};
    auto model = profile::resolve(
        profile::load_profile(test::source_path("schemas/drives/" + std::string(profile) + ".json")), input);
    if (auto* faults = std::get_if<std::vector<profile::Fault>>(&model))
      throw std::runtime_error(text(faults->front()));
    return std::get<model::DriveModel>(std::move(model));
  }
  void shows(std::int64_t statusword, std::int64_t mode, std::int64_t word = 0x000F) {
    store.begin_exchange();
    store.read(core.model.statusword, statusword, turn.now);
    store.read(core.model.controlword, word, turn.now);
    store.read(core.model.mode, mode, turn.now);
    store.read(core.model.mode_display, mode, turn.now);
  }
  [[nodiscard]] Reach word(std::int64_t number) const { return reach_of(core, core.model.controlword, number); }
  [[nodiscard]] Reach target(Quantity quantity, std::int64_t number) const {
    return reach_of(core, core.object_of(quantity), number);
  }
  [[nodiscard]] Errc enable_of(const Sender& sender) const {
    return held_on_way_out(core, core.model.controlword, 0x000F, sender);
  }

  model::DriveModel model;
  ObjectStore store;
  Turn turn{.now = kLongAgo, .link = LinkState::online};
  AxisRecord record;
  AxisCore core{model, model.axes[0], store, turn, Motion{model.axes[0].velocity_lag, record}};
};

TEST_F(WayOut, AWordEnablesByItsLowBitsWhateverElseStandsInIt) {
  shows(kDisabled, 1, 6);
  for (const std::int64_t enables : {0x000F, 0x001F, 0x010F, 0x103F}) EXPECT_EQ(word(enables), Reach::enables);
  for (const std::int64_t harmless : {0x0000, 0x0002, 0x0006, 0x0007, 0x0080, 0x0086})
    EXPECT_EQ(word(harmless), Reach::nothing);
}

TEST_F(WayOut, ATargetMovesWhereTheDriveFollowsItAndIsEnabled) {
  shows(kEnabled, 3);
  EXPECT_EQ(target(Quantity::target_velocity, 1000), Reach::moves);
  EXPECT_EQ(target(Quantity::target_velocity, 0), Reach::nothing);
  EXPECT_EQ(target(Quantity::profile_velocity, 1000), Reach::nothing);
  shows(kEnabled, 1);
  EXPECT_EQ(target(Quantity::target_velocity, 1000), Reach::nothing);
  EXPECT_EQ(target(Quantity::target_position, 1000), Reach::nothing) << "a start is still to come";
  shows(kDisabled, 3);
  EXPECT_EQ(target(Quantity::target_velocity, 1000), Reach::nothing);
}

TEST_F(WayOut, WhatComesTooLateGivesNoTorqueAndAStopIsNeverTooLate) {
  shows(kDisabled, 1, 6);
  turn.now = kLongAgo + std::chrono::seconds(1);
  EXPECT_EQ(enable_of({.asked = record.now(), .begins = true, .by = turn.now}), Errc::ok);
  turn.now += std::chrono::milliseconds(1);
  EXPECT_EQ(enable_of({.asked = record.now(), .begins = true, .by = kLongAgo + std::chrono::seconds(1)}),
            Errc::never_started);
  EXPECT_EQ(held_on_way_out(core, core.model.controlword, 6, {.asked = record.now(), .by = kLongAgo}), Errc::ok)
      << "it gives none";
  shows(kEnabled, 1);
  EXPECT_EQ(
      held_on_way_out(core, core.model.controlword, 0x010F, {.asked = record.now(), .stops = true, .by = kLongAgo}),
      Errc::ok);
}

TEST_F(WayOut, NoMoveStartsToATargetBeyondItsLimitsOrAtAnotherSpeedThanWasAskedFor) {
  const auto start = [this](std::int64_t word) {
    return held_on_way_out(core, core.model.controlword, word, {.asked = record.now(), .begins = true});
  };
  shows(kEnabled, 1);
  auto& target = const_cast<model::Binding&>(*core.model.binding(Quantity::target_position));
  target.limits = {-1000, 1000};
  store.read(target.object, *target.to_raw(1000, core.object(target.object)), turn.now);
  EXPECT_EQ(start(0x3F), Errc::ok);
  store.read(target.object, *target.to_raw(1001, core.object(target.object)), turn.now);
  EXPECT_EQ(start(0x3F), Errc::bad_value);
  EXPECT_EQ(start(0x7F), Errc::ok) << "a distance";
  EXPECT_EQ(start(0x2F), Errc::ok) << "no start";
  EXPECT_EQ(start(0x13F), Errc::ok) << "it halts";
  store.read(target.object, 0, turn.now);
  const model::Binding& speed = *core.model.binding(Quantity::profile_velocity);
  core.asked.take(Quantity::profile_velocity, {.value = 50'000});
  store.read(speed.object, *speed.to_raw(50'000, core.object(speed.object)), turn.now);
  EXPECT_EQ(start(0x3F), Errc::ok);
  store.read(speed.object, *speed.to_raw(60'000, core.object(speed.object)), turn.now);
  EXPECT_EQ(start(0x3F), Errc::bad_value);
}

TEST_F(WayOut, NoTargetBeyondItsLimitsReachesARun) {
  shows(kEnabled, 3);
  auto& target = const_cast<model::Binding&>(*core.model.binding(Quantity::target_velocity));
  target.limits = {-1000, 1000};
  const auto write = [&](std::int64_t value) {
    return held_on_way_out(core, target.object, *target.to_raw(value, core.object(target.object)),
                           {.asked = record.now(), .begins = true});
  };
  EXPECT_EQ(write(1000), Errc::ok);
  EXPECT_EQ(write(-1000), Errc::ok);
  EXPECT_EQ(write(1100), Errc::bad_value);
}

TEST_F(WayOut, AnEnablePassesForWhoeverHasAskedForItAfterTheNewestStop) {
  shows(kDisabled, 1, 6);
  record.stop(record.accepted());
  const auto after = record.now();
  EXPECT_EQ(enable_of({.asked = after, .begins = true}), Errc::ok);
  EXPECT_EQ(enable_of({.asked = after}), Errc::state_unsuitable) << "a parameter's batch asks for no torque";
  EXPECT_EQ(enable_of({}), Errc::state_unsuitable) << "neither does the gateway itself";
  record.stop(record.accepted());
  EXPECT_EQ(enable_of({.asked = after, .begins = true}), Errc::dropped_by_stop);
}

// Bit 8 halts, and the bits below it enable.
TEST_F(WayOut, AStopHoldsTorqueAndNeverGivesIt) {
  const Sender stop{.asked = record.now(), .stops = true};
  shows(kEnabled, 1);
  EXPECT_EQ(held_on_way_out(core, core.model.controlword, 0x010F, stop), Errc::ok);
  shows(kEnabled, 1, 6);
  EXPECT_EQ(held_on_way_out(core, core.model.controlword, 0x010F, stop), Errc::state_unsuitable)
      << "it is on its way out";
  shows(kDisabled, 1, 0x000F);
  EXPECT_EQ(held_on_way_out(core, core.model.controlword, 0x010F, stop), Errc::state_unsuitable);
  EXPECT_EQ(held_on_way_out(core, core.model.controlword, 0x0002, stop), Errc::ok);
}

TEST_F(WayOut, ASetPointAloneChangesARunAndBeginsNone) {
  shows(kEnabled, 3);
  const auto write = [&] {
    return held_on_way_out(core, core.object_of(Quantity::target_velocity), 1000, {.asked = record.now()});
  };
  core.motion.observe(core.facts(), std::chrono::seconds(60));
  core.motion.stop(false, turn.now);
  EXPECT_EQ(write(), Errc::state_unsuitable);
  core.motion.start(MotionKind::velocity, 1, turn.now, store.exchange());
  EXPECT_EQ(write(), Errc::ok);
}

TEST_F(WayOut, TheKeepAliveRepeatsWhatTheDriveWasLastKnownToTake) {
  shows(kEnabled, 3);
  store.read(core.object_of(Quantity::target_velocity), 1000, turn.now);
  const auto repeat = [&](std::int64_t number) {
    return held_on_way_out(core, core.object_of(Quantity::target_velocity), number, {.keeps = true});
  };
  EXPECT_EQ(repeat(1000), Errc::ok);
  EXPECT_EQ(repeat(2000), Errc::state_unsuitable);
}

class WayOutOfAStepper : public WayOut {
 protected:
  WayOutOfAStepper() : WayOut("id286pro", "modbus-rtu", {{"pulses_per_rev", Rational(10000)}}) {}
  [[nodiscard]] Reach most_of(Command command) const {
    Reach most = Reach::nothing;
    for (const model::Step& step : core.model.command(command)->steps)
      if (step.verb == model::Step::Verb::write && step.source == model::Step::Source::literal)
        most = std::max(most, reach_of(core, step.object, step.literal));
    return most;
  }
};

// It has no controlword: its profile's steps say what starts and what stops.
TEST_F(WayOutOfAStepper, TheStepsOfItsProfileSayWhatMoves) {
  for (const Command start : {Command::move_absolute, Command::run_velocity, Command::home})
    EXPECT_EQ(most_of(start), Reach::moves) << text(start);
  for (const Command stop : {Command::halt, Command::quick_stop, Command::fault_reset})
    EXPECT_EQ(most_of(stop), Reach::nothing) << text(stop);
}

}  // namespace
}  // namespace axisgate::drive
