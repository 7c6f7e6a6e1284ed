// SPDX-License-Identifier: Apache-2.0
// The stop that an axis owes, alone: what was accepted, sent and read goes in, and what is to be sent comes out.
#include "gateway/drive/motion/owed_stop.hpp"
#include "gateway/drive/state/object_store.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "tests/unit/drive/alone.hpp"

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;
using enum model::State402;
using End = OwedStop::End;

TEST(OwedStop, IsNotSentBeforeTheAxisWasReadEnabledAfterIt) {
  OwedStop owed;
  owed.accepted(StopKind::quick_stop, 10);
  EXPECT_EQ(owed.due(kStart), std::nullopt);
  EXPECT_EQ(owed.state_read(operation_enabled, 10), End::none) << "a sample from before it";
  EXPECT_EQ(owed.due(kStart), std::nullopt);
  EXPECT_EQ(owed.state_read(operation_enabled, 11), End::none);
  EXPECT_EQ(owed.due(kStart), StopKind::quick_stop);
}

TEST(OwedStop, IsSentAgainAtItsPaceAndOnlyAfterAFreshRead) {
  OwedStop owed;
  owed.accepted(StopKind::disable, 1);
  static_cast<void>(owed.state_read(operation_enabled, 2));
  owed.sending();
  EXPECT_EQ(owed.attempted(StopKind::disable, false, 5, kStart), End::none);
  EXPECT_EQ(owed.state_read(operation_enabled, 5), End::none);
  EXPECT_EQ(owed.due(kStart + 1h), std::nullopt) << "that read is older than the last sending";
  EXPECT_EQ(owed.state_read(operation_enabled, 6), End::none);
  EXPECT_EQ(owed.due(kStart + OwedStop::kPace - 1ms), std::nullopt);
  EXPECT_EQ(owed.next_deadline(kStart), kStart + OwedStop::kPace);
  EXPECT_EQ(owed.due(kStart + OwedStop::kPace), StopKind::disable);
}

TEST(OwedStop, IsDischargedByAnyStateWithoutTorque) {
  for (const model::State402 state :
       {not_ready_to_switch_on, switch_on_disabled, ready_to_switch_on, switched_on, fault}) {
    OwedStop owed;
    owed.accepted(StopKind::quick_stop, 1);
    EXPECT_EQ(owed.state_read(state, 2), End::disabled) << text(state);
    EXPECT_FALSE(owed.owed());
  }
}

TEST(OwedStop, WaitsForTheEndOfAFaultReaction) {
  OwedStop owed;
  owed.accepted(StopKind::quick_stop, 1);
  EXPECT_EQ(owed.state_read(fault_reaction_active, 2), End::none);
  EXPECT_TRUE(owed.owed());
  EXPECT_EQ(owed.due(kStart), std::nullopt);
}

TEST(OwedStop, AQuickStopThatIsShownByItsStateNeedsNothingMore) {
  OwedStop owed;
  owed.accepted(StopKind::quick_stop, 1);
  EXPECT_EQ(owed.state_read(quick_stop_active, 2), End::none) << "it was not sent: another one has led there";
  EXPECT_EQ(owed.due(kStart), StopKind::quick_stop);
  owed.sending();
  EXPECT_EQ(owed.state_read(quick_stop_active, 2), End::shown);
}

TEST(OwedStop, TorqueHeldByAQuickStopIsNoDisable) {
  OwedStop owed;
  owed.accepted(StopKind::disable, 1);
  owed.sending();
  EXPECT_EQ(owed.state_read(quick_stop_active, 2), End::none);
  EXPECT_EQ(owed.due(kStart), StopKind::disable);
}

TEST(OwedStop, TheNewestOneCountsButAHaltReplacesNothingStronger) {
  constexpr std::array kKinds{StopKind::halt, StopKind::quick_stop, StopKind::disable};
  for (const StopKind first : kKinds) {
    for (const StopKind second : kKinds) {
      OwedStop owed;
      owed.accepted(first, 1);
      owed.accepted(second, 2);
      static_cast<void>(owed.state_read(operation_enabled, 3));
      EXPECT_EQ(owed.due(kStart), second == StopKind::halt ? first : second);
    }
  }
}

TEST(OwedStop, AWeakerOneThatWasShownDischargesNoStrongerOne) {
  OwedStop owed;
  owed.accepted(StopKind::disable, 1);
  EXPECT_EQ(owed.attempted(StopKind::halt, true, 2, kStart), End::none);
  EXPECT_EQ(owed.attempted(StopKind::quick_stop, true, 3, kStart), End::none);
  EXPECT_EQ(owed.attempted(StopKind::disable, true, 4, kStart), End::shown);
}

TEST(OwedStop, ALaterEnableTakesItBackUnlessTheDriveWasLostSince) {
  OwedStop owed;
  owed.accepted(StopKind::quick_stop, 1);
  EXPECT_EQ(owed.enabled_later(), End::enabled);
  owed.accepted(StopKind::quick_stop, 1);
  owed.link_lost(kStart, 1);
  owed.link_back(kStart + 1s);
  EXPECT_EQ(owed.enabled_later(), End::none);
  EXPECT_TRUE(owed.owed());
}

TEST(OwedStop, ALaterStartTakesBackAHaltAlone) {
  OwedStop owed;
  owed.accepted(StopKind::halt, 1);
  EXPECT_EQ(owed.started_later(), End::enabled);
  owed.accepted(StopKind::disable, 1);
  EXPECT_EQ(owed.started_later(), End::none);
}

TEST(OwedStop, GatesFromALossUntilItIsDischarged) {
  OwedStop owed;
  owed.accepted(StopKind::quick_stop, 1);
  EXPECT_FALSE(owed.gates()) << "nothing was lost";
  owed.link_lost(kStart, 2);
  owed.link_back(kStart + 100ms);
  EXPECT_TRUE(owed.gates());
  EXPECT_EQ(owed.state_read(switch_on_disabled, 3), End::disabled);
  EXPECT_FALSE(owed.gates());
}

TEST(OwedStop, OfALossIsNotSentBeforeTheDriveIsBackAndWasRead) {
  OwedStop owed;
  owed.link_lost(kStart, 1);
  owed.accepted(StopKind::quick_stop, 1);
  EXPECT_TRUE(owed.gates());
  EXPECT_EQ(owed.state_read(operation_enabled, 1), End::none);
  owed.link_back(kStart + 300ms);
  EXPECT_EQ(owed.due(kStart + 300ms), std::nullopt);
  EXPECT_EQ(owed.state_read(operation_enabled, 2), End::none);
  EXPECT_EQ(owed.due(kStart + 300ms), StopKind::quick_stop);
}

TEST(OwedStop, AHaltBecomesAQuickStopAfterALongLossOrARestart) {
  const auto after = [](Duration gap, bool restarted) {
    OwedStop owed;
    owed.link_lost(kStart, 1);
    owed.accepted(StopKind::halt, 1);
    if (restarted) owed.restarted();
    owed.link_back(kStart + gap);
    static_cast<void>(owed.state_read(operation_enabled, 2));
    return owed.due(kStart + gap);
  };
  EXPECT_EQ(after(OwedStop::kShortLoss, false), StopKind::halt);
  EXPECT_EQ(after(OwedStop::kShortLoss + 1ms, false), StopKind::quick_stop);
  EXPECT_EQ(after(100ms, true), StopKind::quick_stop);
}

// Every sequence of so many events: what must hold whatever happens.
TEST(OwedStop, KeepsItsPromisesThroughEveryShortSequence) {
  constexpr int kEvents = 13, kLength = 5;
  int total = 1;
  for (int i = 0; i < kLength; ++i) total *= kEvents;
  for (int sequence = 0; sequence < total; ++sequence) {
    OwedStop owed;
    Instant now = kStart;
    std::uint64_t exchange = 1;
    bool away = false, owes = false, lost_since = false, read_since = false;
    std::string story;
    for (int rest = sequence, i = 0; i < kLength; ++i, rest /= kEvents) {
      now += 200ms;
      ++exchange;
      End end = End::none;
      const int event = rest % kEvents;
      story += std::to_string(event) + " ";
      const bool gated = owed.gates();
      switch (event) {
        case 0:
        case 1:
        case 2:
          owed.accepted(static_cast<StopKind>(event), exchange);
          owes = true;
          lost_since = lost_since || away;
          read_since = false;
          break;
        case 3:
          owed.sending();
          break;
        case 4:
        case 5:
          end = owed.attempted(StopKind::disable, event == 4, exchange, now);
          read_since = false;
          break;
        case 6:
          end = owed.state_read(operation_enabled, exchange);
          read_since = read_since || owes;
          break;
        case 7:
          end = owed.state_read(switch_on_disabled, exchange);
          break;
        case 8:
          end = owed.enabled_later();
          EXPECT_TRUE(!gated || end == End::none) << story << ": an enable passed the gate";
          break;
        case 9:
          owed.link_lost(now, exchange);
          away = true;
          lost_since = lost_since || owes;
          read_since = false;
          break;
        case 10:
          owed.link_back(now);
          away = false;
          break;
        case 11:
          owed.restarted();
          break;
        default:
          end = owed.started_later();
          break;
      }
      if (end != End::none) owes = lost_since = read_since = false;
      ASSERT_EQ(owed.owed(), owes) << story;
      ASSERT_EQ(owed.gates(), owes && lost_since) << story;
      if (owed.due(now)) {
        ASSERT_TRUE(owes && read_since && !away) << story << ": sent without a fresh read of a drive that is there";
      }
    }
  }
}

// --- A state may show a stop that stops nothing ----------------------------------------------------------------------

TEST(OwedStop, IsNotShownByAStateInWhichTheMotorTurns) {
  for (const model::State402 state : {model::State402::quick_stop_active, model::State402::switch_on_disabled}) {
    OwedStop owed;
    owed.accepted(StopKind::quick_stop, 1);
    owed.sending();
    EXPECT_EQ(owed.state_read(state, 2, true), OwedStop::End::none);
    EXPECT_EQ(owed.due(Instant{}), StopKind::quick_stop) << "it is sent again";
    EXPECT_NE(owed.state_read(state, 3, false), OwedStop::End::none);
    EXPECT_FALSE(owed.owed());
  }
}

TEST(OwedStop, ThatWasShownIsOwedAnewWhereTheMotorTurnsOn) {
  OwedStop owed;
  owed.unheeded(StopKind::quick_stop, 5);
  EXPECT_EQ(owed.state_read(model::State402::quick_stop_active, 5, false), OwedStop::End::none) << "of before";
  EXPECT_EQ(owed.state_read(model::State402::quick_stop_active, 6, true), OwedStop::End::none);
  EXPECT_EQ(owed.due(Instant{}), StopKind::quick_stop);
}

// --- What was read before a sending shows nothing of it
// ----------------------------------------------------------------

TEST(ObjectStore, WhatWasReadBeforeTheLastSendingIsNotOfNow) {
  ObjectStore store(2);
  EXPECT_FALSE(store.shows_now(0)) << "nothing is known";
  store.begin_exchange();
  store.read(0, 5, {});
  EXPECT_TRUE(store.shows_now(0));
  store.begin_exchange(true);
  EXPECT_FALSE(store.shows_now(0));
  store.acknowledged(1, 6, {});
  EXPECT_FALSE(store.shows_now(0));
  store.begin_exchange();
  store.read(0, 5, {});
  EXPECT_TRUE(store.shows_now(0));
  store.invalidate_all();
  EXPECT_FALSE(store.shows_now(0));
}

TEST(ObjectStore, TheFirstValueThatComesByItselfMayBeOfBefore) {
  ObjectStore store(1);
  store.begin_exchange();
  store.received(0, 5, {});
  EXPECT_TRUE(store.shows_now(0));
  store.begin_exchange(true);
  store.begin_exchange();
  store.received(0, 5, {});
  EXPECT_FALSE(store.shows_now(0));
  store.received(0, 5, {});
  EXPECT_TRUE(store.shows_now(0));
}

}  // namespace
}  // namespace axisgate::drive
