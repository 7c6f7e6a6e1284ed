// SPDX-License-Identifier: Apache-2.0
// What a drive is told beside one's own commands, without a wire: who is told again, what is looked at before, and what
// a frame's answer says of both motors.
#include "gateway/drive/device/drive_control.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>

#include "tests/stage_drive/keya_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using drive::DriveControl;
using model::ObjectId;

constexpr Duration kPeriod = 800ms;
constexpr Instant kNow = Instant{} + 1h;

/// Two motors that show enabled and still, read at kNow; nobody has told them anything.
struct Told {
  explicit Told(Speech speech) : model(keya_model({.speech = speech, .keep_alive = kPeriod})) {
    for (std::size_t slot = 0; slot < 2; ++slot)
      cores.push_back({.drive = model,
                       .model = model.axes[slot],
                       .store = store,
                       .turn = in_sight,
                       .motion = drive::Motion(model.axes[slot].velocity_lag, records.at(slot))});
    store.begin_exchange();
    for (drive::AxisCore& core : cores) core.begin_mode();
    show(kNow);
    for (drive::AxisCore& core : cores) {
      core.refresh_virtual();
      core.motion.start(drive::MotionKind::velocity, 0, kNow, store.exchange());  // else no speed is told again
    }
  }
  [[nodiscard]] ObjectId id(const std::string& name) const {
    const auto at =
        std::find_if(model.objects.begin(), model.objects.end(), [&](const auto& o) { return o.name == name; });
    return static_cast<ObjectId>(at - model.objects.begin());
  }
  void show(Instant sent_at) {
    for (const char* name : {"A.fault", "B.fault", "A.speed", "B.speed"}) store.read(id(name), 0, sent_at);
  }
  [[nodiscard]] DriveControl::Turn turn(Instant now = kNow) const {
    DriveControl::Turn out{.now = now, .online = true, .suspect = false, .adopted = false, .axes = {}};
    for (const drive::AxisCore& core : cores) out.axes.push_back({.core = core, .live = true});
    return out;
  }
  [[nodiscard]] bus::Exchange write(const std::string& name, std::uint32_t raw) const {
    return {model.node, bus::Access::write, model.object(id(name)).address, 4, raw};
  }

  model::DriveModel model;
  drive::ObjectStore store{model.objects};
  drive::Turn in_sight{.now = kNow, .link = LinkState::online};
  std::array<AxisRecord, 2> records{};
  std::vector<drive::AxisCore> cores;
  DriveControl control{model, store};
};

TEST(DriveControl, ADriveThatNeedsNeitherIsNotConcerned) {
  const model::DriveModel model = keya_model({});
  drive::ObjectStore store(model.objects);
  EXPECT_FALSE(DriveControl(model, store).concerned());
  EXPECT_TRUE(Told(Speech::single).control.concerned());
  EXPECT_TRUE(Told(Speech::composed).control.concerned());
}

TEST(DriveControl, AnEnabledMotorIsToldAgainWhatItWasToldLast) {
  Told told(Speech::single);
  told.store.acknowledged(told.id("A.velocity"), 100, kNow);
  const auto due = told.control.due(told.turn());
  ASSERT_TRUE(due);
  EXPECT_EQ(due->axis, 0);
  EXPECT_EQ(due->exchange, told.write("A.velocity", 100));
  EXPECT_LE(told.control.next_due(told.turn()), kNow);
  told.control.on_result(due->exchange, {}, due->axis, kNow, true, kNow);
  EXPECT_FALSE(told.control.due(told.turn()));
  EXPECT_EQ(told.control.next_due(told.turn()), kNow + kPeriod / 2);
}

TEST(DriveControl, NothingIsToldAgainToADriveThatIsAdoptedOrOwesAReplyOrForWhichNobodyAnswers) {
  Told told(Speech::single);
  told.store.acknowledged(told.id("A.velocity"), 100, kNow);
  const auto none = [&](auto change) {
    DriveControl::Turn turn = told.turn();
    change(turn);
    return !told.control.due(turn) && told.control.next_due(turn) == kNever;
  };
  EXPECT_TRUE(none([](DriveControl::Turn& turn) { turn.adopted = true; }));
  EXPECT_TRUE(none([](DriveControl::Turn& turn) { turn.suspect = true; }));
  EXPECT_TRUE(none([](DriveControl::Turn& turn) { turn.online = false; }));
  EXPECT_TRUE(none([](DriveControl::Turn& turn) { turn.axes[0].live = false; }));
  EXPECT_TRUE(none([](DriveControl::Turn& turn) { turn.axes[0].stopping = true; }));
}

TEST(DriveControl, WhatWasShownLongAgoIsLookedAtBeforeAFrame) {
  Told told(Speech::composed);
  EXPECT_FALSE(told.control.look_before(told.turn(kNow + DriveControl::kShownFor), false));
  const Instant late = kNow + DriveControl::kShownFor + 1ms;
  EXPECT_TRUE(told.control.look_before(told.turn(late), false));
  EXPECT_TRUE(told.control.look_before(told.turn(late), true)) << "nothing but time has passed";
}

TEST(DriveControl, AStopIsWorthNoLookAtADriveThatOwesAReply) {
  Told told(Speech::composed);
  DriveControl::Turn turn = told.turn(kNow + 10s);
  turn.suspect = true;
  EXPECT_TRUE(told.control.look_before(turn, false));
  EXPECT_FALSE(told.control.look_before(turn, true));
}

TEST(DriveControl, WhereMotorsHaveAFrameEachNothingIsLookedAt) {
  Told told(Speech::single);
  EXPECT_FALSE(told.control.look_before(told.turn(kNow + 10s), false));
  const bus::Exchange alone = told.write("A.velocity", 5);
  EXPECT_EQ(told.control.whole(told.turn(), alone, false), alone);
}

TEST(DriveControl, AFrameThatWasAnsweredWasToldToBothMotors) {
  Told told(Speech::composed);
  const auto frame = told.control.whole(told.turn(), told.write("A.velocity", 5), false);
  ASSERT_TRUE(frame);
  ASSERT_FALSE(frame->more.empty());
  told.control.on_result(*frame, {}, std::nullopt, kNow, true, kNow);
  for (const auto& [name, number] : std::map<std::string, int>{{"A.velocity", 5}, {"B.velocity", 0}, {"B.on", 1}}) {
    const drive::ObjectState& state = told.store[told.id(name)];
    EXPECT_TRUE(state.known && !state.unsure) << name;
    EXPECT_EQ(state.number, number) << name;
  }
}

TEST(DriveControl, AFrameOfWhichNobodyKnowsWhetherItArrivedLeavesBothUnsure) {
  Told told(Speech::composed);
  const auto frame = told.control.whole(told.turn(), told.write("A.velocity", 5), false);
  ASSERT_TRUE(frame);
  bus::ExchangeResult lost;
  lost.code = Errc::timed_out;
  told.control.on_result(*frame, lost, std::nullopt, kNow, true, kNow);
  EXPECT_TRUE(told.store[told.id("A.velocity")].unsure);
  EXPECT_TRUE(told.store[told.id("B.velocity")].unsure);
}

}  // namespace
}  // namespace axisgate::test
