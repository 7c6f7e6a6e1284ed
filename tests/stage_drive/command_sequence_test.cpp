// SPDX-License-Identifier: Apache-2.0
// A command sequence alone, against a drive made of a table: what only an unlucky order of events brings about.
#include <gmock/gmock.h>

#include <map>

#include "gateway/drive/command_sequence/command_sequence.hpp"
#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using Move = drive::CommandSequence::Move;

/// The shipped model of a drive, and a table that answers for it.
struct Table {
  Rig rig;
  const model::DriveModel& model;
  drive::ObjectStore store;
  drive::Turn turn{.now = Instant{} + 1h, .link = LinkState::online};
  AxisRecord record;
  drive::AxisCore core;
  std::map<ObjectAddress, std::uint32_t> held;
  std::vector<bus::Exchange> sent;

  explicit Table(KincoType type)
      : rig(type),
        model(rig.stage.gateway().drive_of(1)->model()),
        store(model.objects.size()),
        core{model, model.axes[0], store, turn, drive::Motion{model.axes[0].velocity_lag, record}} {
    held[{0x6041, 0}] = 0x4637;  // enabled, target reached
    held[{0x6040, 0}] = 0x000F;
    held[{0x6060, 0}] = held[{0x6061, 0}] = 1;
    for (model::ObjectId id = 0; id < model.objects.size(); ++id) {
      store.begin_exchange();
      store.read(id, model.object(id).number(held[model.object(id).address]), turn.now);
    }
  }
  bus::ExchangeResult answer(const bus::Exchange& exchange) {
    if (exchange.access == bus::Access::write) {
      held[exchange.object] = exchange.raw;
      return {};
    }
    const model::ObjectId id = model.find(exchange.object);
    store.read(id, model.object(id).number(held[exchange.object]), turn.now);
    bus::ExchangeResult result;
    result.fields.push_back({exchange.object, model.object(id).size, held[exchange.object]});
    return result;
  }
  bus::Exchange grant(drive::CommandSequence& talk) {
    turn.now += 5ms;
    const Move move = talk.granted();
    EXPECT_EQ(move.kind, Move::Kind::exchange);
    store.begin_exchange();
    sent.push_back(move.exchange);
    return move.exchange;
  }
  /// Grants and answers until the exchange for which `at` holds is on the wire, and gives it; none: it ended before.
  std::optional<bus::Exchange> run_to(drive::CommandSequence& talk,
                                      const std::function<bool(const bus::Exchange&)>& at) {
    for (int i = 0; i < 60 && !talk.finished(); ++i) {
      turn.now += 5ms;
      const Move move = talk.granted();
      if (move.kind == Move::Kind::wait) continue;
      if (move.kind == Move::Kind::finished) break;
      store.begin_exchange();
      sent.push_back(move.exchange);
      if (at(move.exchange)) return move.exchange;
      talk.on_result(answer(move.exchange), turn.now, true);
      static_cast<void>(talk.advance());
    }
    return std::nullopt;
  }
};

auto writes(std::uint16_t index, std::uint32_t raw) {
  return
      [=](const bus::Exchange& e) { return e.access == bus::Access::write && e.object.index == index && e.raw == raw; };
}

TEST(CommandSequence, AStartThatAStopHasOvertakenIsNoMotion) {
  Table t(KincoType::md);
  drive::CommandSequence talk(t.core, with_command(Command::run_velocity, {{Quantity::target_velocity, 60'000}}),
                              false);
  const auto last = t.run_to(talk, [](const bus::Exchange& e) {
    return e.access == bus::Access::write && e.object.index == kTargetVelocity && e.raw != 0;
  });
  ASSERT_TRUE(last);
  // The stop was accepted while the last write was on the wire; its acknowledgement is delivered before anybody is
  // told.
  t.core.motion.stop(true, t.turn.now);
  talk.on_result(t.answer(*last), t.turn.now, true);
  static_cast<void>(talk.advance());
  EXPECT_EQ(t.core.motion.running(), drive::MotionKind::none);
  EXPECT_FALSE(t.core.motion.target_acts_now(Quantity::target_velocity, t.core.facts(), false));
  EXPECT_TRUE(t.core.motion.latched());
}

TEST(CommandSequence, WhatIsOnlyPlannedIsPlannedAnewWhenItsTurnComes) {
  Table t(KincoType::md);
  drive::CommandSequence talk(t.core, with_command(Command::move_absolute, {{Quantity::profile_velocity, 60'000}}),
                              false);
  const bus::Exchange parameter = t.grant(talk);
  talk.on_result(t.answer(parameter), t.turn.now, true);
  const Move ahead = talk.advance();
  ASSERT_EQ(ahead.kind, Move::Kind::exchange) << "the start is planned";
  // A poll shows a fault before the wire is free for it.
  t.held[{0x6041, 0}] = 0x0008;
  t.store.begin_exchange();
  t.store.read(t.core.model.statusword, 0x0008, t.turn.now);
  EXPECT_EQ(talk.granted().kind, Move::Kind::finished);
  EXPECT_EQ(talk.result().outcome.code, Errc::state_unsuitable);
}

TEST(CommandSequence, AHaltThatWasLostIsLookedAtBeforeItIsSentAgain) {
  Table t(KincoType::md);
  drive::CommandSequence talk(t.core, with_command(Command::halt), true);
  const bus::Exchange halt = t.grant(talk);
  EXPECT_EQ(halt.raw, 0x010FU);
  talk.on_result({.code = Errc::timed_out}, t.turn.now, true);
  t.turn.link = LinkState::suspect;
  EXPECT_FALSE(talk.passes_resync()) << "0x010F would enable a drive that has just restarted";
  // It has: the resynchronisation read is answered, the controlword reads 0, the state is disabled.
  t.turn.link = LinkState::online;
  t.held[{0x6040, 0}] = 0;
  t.held[{0x6041, 0}] = 0x0040;
  EXPECT_EQ(t.run_to(talk, writes(kControlword, 0x010F)), std::nullopt);
  EXPECT_EQ(talk.result().outcome.code, Errc::ok);
}

TEST(CommandSequence, AQuickStopThatWasLostGoesOutAgainAtOnce) {
  Table t(KincoType::md);
  drive::CommandSequence talk(t.core, with_command(Command::quick_stop), true);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(talk.passes_resync());
    EXPECT_EQ(t.grant(talk).raw, 0x000BU);
    talk.on_result({.code = Errc::timed_out}, t.turn.now, false);
    t.turn.link = LinkState::suspect;
  }
  EXPECT_TRUE(talk.finished()) << "three times at most";
  EXPECT_EQ(talk.result().outcome.code, Errc::timed_out);
}

TEST(CommandSequence, AWaitThatAResynchronisationKeptFromLookingLooksOnceBeforeItFails) {
  Table t(KincoType::md);
  drive::CommandSequence talk(t.core, with_command(Command::move_absolute), false);
  const auto start = t.run_to(talk, writes(kControlword, 0x003F));
  ASSERT_TRUE(start);
  talk.on_result(t.answer(*start), t.turn.now, true);
  static_cast<void>(talk.advance());  // the wait for the acknowledgement begins
  t.turn.now += 3s;
  t.held[{0x6041, 0}] = 0x5237;
  EXPECT_FALSE(t.run_to(talk, [](const bus::Exchange&) { return false; }));
  EXPECT_EQ(talk.result().outcome.code, Errc::ok);
  EXPECT_EQ(t.core.motion.running(), drive::MotionKind::discrete);
}

TEST(CommandSequence, TheRestOfAStopsBatchIsNeverCalledUnsent) {
  for (int delay = 0; delay < 60; ++delay) {
    Rig rig(KincoType::md);
    rig.bring_to(Situation::running);
    const auto ahead = rig.stage.begin(1, setpoints({{Quantity::profile_acceleration, 5'000},
                                                     {Quantity::profile_deceleration, 6'000},
                                                     {Quantity::homing_offset, 70}}));
    rig.stage.run(1ms);
    const auto stop = rig.stage.begin(1, with_command(Command::quick_stop, {{Quantity::profile_velocity, 70'000}}));
    rig.stage.run(std::chrono::milliseconds(delay));
    rig.stage.link(0).unplug();
    rig.stage.run(2ms);
    ASSERT_TRUE(ahead->has_value() && stop->has_value());
    if (rig.count(kControlword, 0x0B) > 0) {
      EXPECT_NE((*stop)->outcome.code, Errc::offline) << delay << " ms: the stop was sent";
    }
  }
}

}  // namespace
}  // namespace axisgate::test
