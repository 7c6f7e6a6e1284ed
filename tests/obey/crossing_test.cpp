// SPDX-License-Identifier: Apache-2.0
// Requests that cross, and commands beside a controlword or a jog: what comes last decides, whatever still waits, is on
// its way or has just been left.
#include <gtest/gtest.h>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::array<Duration, 5> kApart{0ms, 1ms, 5ms, 20ms, 60ms};

class Crossing : public testing::TestWithParam<Subject> {
 protected:
  struct Sent {
    RequestNumber number;
    Client* by;
  };
  void ready() {
    plant_.emplace(GetParam());
    plant_->ready();
  }
  void send(Client& by, const Write& write) { sent_.push_back({by.begin(write), &by}); }
  /// With its target, by the second of two ids: the first one of a connection is only remembered.
  void send_start(Client& by) {
    Rows start = plant_->endless_target();
    start[row::command] = plant_->endless_command();
    for (const std::int64_t id : {7, 8}) {
      start[row::command_id] = id;
      send(by, block(start.begin()->first, row::command_id, start));
    }
  }
  void all_answered() {
    const auto told = [](const Sent& one) { return one.by->answer_of(one.number).has_value(); };
    ASSERT_TRUE(plant_->stage.run_until([&] { return std::ranges::all_of(sent_, told); }));
  }
  std::string answers() {
    std::string out;
    for (const Sent& one : sent_)
      out += std::to_string(one.by->answer_of(one.number).value_or(Answer{255}).exception) + " ";
    return out;
  }
  std::optional<Plant> plant_;
  std::vector<Sent> sent_;
};
class CrossingWithDisable : public Crossing {};
class CrossingLadder : public Crossing {};  // a virtual axis has none

// The second stop was taken for the first, and the enable between them was done after both.
TEST_P(CrossingWithDisable, AnEnableBetweenTwoStopsEndsWithTheSecond) {
  for (const std::int64_t stop : {kDisable, kQuickStop})
    for (const Duration first : kApart)
      for (const Duration second : kApart) {
        SCOPED_TRACE(std::to_string(stop) + ", " + std::to_string(first / 1ms) + " ms, " +
                     std::to_string(second / 1ms));
        ready();
        sent_.clear();
        send(plant_->b, one(row::command, stop));
        plant_->run(first);
        send(plant_->a, one(row::command, kEnable));
        plant_->run(second);
        send(plant_->b, one(row::command, stop));
        all_answered();
        plant_->run(2s);
        EXPECT_FALSE(*plant_->motor().enabled) << answers();
      }
}

TEST_P(Crossing, AStartBetweenTwoHaltsEndsWithTheSecond) {
  for (const Duration first : kApart)
    for (const Duration second : kApart) {
      SCOPED_TRACE(std::to_string(first / 1ms) + " ms, " + std::to_string(second / 1ms) + " ms");
      ready();
      sent_.clear();
      ASSERT_TRUE(plant_->start_endless(plant_->a));
      send(plant_->b, one(row::command, kHalt));
      plant_->run(first);
      send(plant_->a, one(row::command, 0));
      send(plant_->a, one(row::command, plant_->endless_command()));
      plant_->run(second);
      send(plant_->b, one(row::command, kHalt));
      all_answered();
      EXPECT_TRUE(plant_->comes_to_stand()) << answers();
      plant_->run(2s);
      EXPECT_TRUE(plant_->stands()) << answers();
    }
}

// What stands beside a stop and still waits is dropped by the next one, as anything else that waits is.
TEST_P(CrossingWithDisable, AnEnableBesideADisablingControlwordEndsWithTheNextStop) {
  for (const std::int64_t word : {7, 6})
    for (const Write& stop :
         {one(row::command, kDisable), one(row::controlword, 0), block(row::controlword, row::heartbeat, {})})
      for (const Duration apart : kApart) {
        SCOPED_TRACE(text(stop) + ", " + std::to_string(word) + ", " + std::to_string(apart / 1ms) + " ms");
        plant_.emplace(GetParam(), with_leases());
        plant_->ready();
        sent_.clear();
        Client& owner = plant_->a;
        Rows rows = plant_->profile_rows();
        rows[row::controlword] = 15;
        rows[row::command] = 0;
        ASSERT_EQ(owner.rows(row::controlword, row::command, rows), kOk);
        ASSERT_EQ(owner.command(kEnable), kOk);
        ASSERT_EQ(owner.command(kQuickStop), kOk);
        rows[row::controlword] = word;  // its owner's: a stop in a block as well
        rows[row::command] = kEnable;
        send(owner, block(row::controlword, row::command, rows));
        plant_->run(apart);
        send(owner, stop);
        all_answered();
        plant_->run(1s);
        EXPECT_FALSE(*plant_->motor().enabled) << answers();
      }
}

// The disable did not arrive, the enable behind it was never sent: what is owed when the wire is back is the disable.
TEST_P(CrossingWithDisable, AnEnableThatWasNeverSentLeavesTheStopBeforeItOwed) {
  for (const std::int64_t stop : {kDisable, kQuickStop}) {
    SCOPED_TRACE(stop);
    ready();
    sent_.clear();
    ASSERT_EQ(plant_->a.command(kEnable), kOk);
    plant_->cut_wire();
    send(plant_->b, one(row::command, stop));
    plant_->run(20ms);
    send(plant_->a, one(row::command, 0));
    send(plant_->a, one(row::command, kEnable));
    all_answered();
    plant_->mend_wire();
    ASSERT_TRUE(plant_->stage.run_until([&] { return plant_->stage.axis(1).link_state == LinkState::online; }));
    plant_->run(1s);
    EXPECT_FALSE(*plant_->motor().enabled) << answers();
  }
}

// What the old owner asked while the halt of a take-over was under way began behind the halt, under the new owner.
TEST_P(Crossing, WhatItsOwnerAsksDuringATakeOverDoesNotBeginUnderTheNewOne) {
  for (const bool runs : {true, false})
    for (const Duration apart : {0ms, 1ms, 2ms, 5ms, 20ms, 60ms}) {
      SCOPED_TRACE((runs ? "it runs, " : "it is enabled, ") + std::to_string(apart / 1ms) + " ms");
      plant_.emplace(GetParam(), with_leases());
      plant_->ready();
      Client& before = plant_->a;
      const auto after = plant_->connection_from(Plant::kHostOfA);
      ASSERT_EQ(plant_->set_endless(before), kOk);
      if (runs) {
        ASSERT_EQ(before.command(plant_->endless_command()), kOk);
      }
      sent_.clear();
      send(*after, one(row::command, kTakeOver));
      plant_->run(apart);
      send_start(before);
      all_answered();
      EXPECT_EQ(after->word(shown::owner), kMe) << answers();
      plant_->run(1s);
      EXPECT_TRUE(plant_->stands()) << answers() << plant_->velocity();
      static_cast<void>(after->row(row::target_velocity, kOtherSpeed));  // where it has one: no start
      plant_->run(500ms);
      EXPECT_TRUE(plant_->stands()) << answers() << plant_->velocity();
    }
}

// And what had begun already was carried on.
TEST_P(Crossing, AnEnableAndAStartEndWithATakeOver) {
  for (const Duration apart : {0ms, 1ms, 5ms, 20ms, 60ms, 150ms}) {
    SCOPED_TRACE(std::to_string(apart / 1ms) + " ms");
    plant_.emplace(GetParam(), with_leases());
    plant_->ready_but_disabled();
    Client& before = plant_->a;
    const auto after = plant_->connection_from(Plant::kHostOfA);
    ASSERT_EQ(plant_->set_endless(before), kOk);
    sent_.clear();
    send(before, one(row::command, kEnable));
    send_start(before);
    plant_->run(apart);
    send(*after, one(row::command, kTakeOver));
    ASSERT_TRUE(plant_->stage.run_until([&] { return after->answer_of(sent_.back().number).has_value(); }));
    const bool enabled = plant_->motor().enabled.value_or(false);
    all_answered();
    EXPECT_EQ(after->word(shown::owner), kMe) << answers();
    EXPECT_LE(plant_->motor().enabled.value_or(false), enabled) << answers();
    ASSERT_TRUE(plant_->comes_to_stand()) << answers();
    plant_->run(1s);
    EXPECT_TRUE(plant_->stands()) << answers() << plant_->velocity();
    EXPECT_LE(plant_->motor().enabled.value_or(false), enabled) << answers();
  }
}

// The enable is by the gateway's word, although a stop stands beside it: it holds, and what starts is accepted.
TEST_P(CrossingWithDisable, AnEnableBesideAStoppingControlwordHolds) {
  for (const std::int64_t word : {0, 6, 7}) {
    SCOPED_TRACE(word);
    plant_.emplace(GetParam(), with_leases());
    plant_->ready();
    Client& owner = plant_->a;
    ASSERT_EQ(owner.row(row::controlword, 15), kOk);
    ASSERT_EQ(plant_->set_endless(owner), kOk);
    ASSERT_EQ(owner.write(block(row::controlword, row::command, {{row::controlword, 15}})), kOk);
    const std::int64_t mode = has_speeds(GetParam()) ? kVelocityMode : 1;
    const Write both =
        block(row::controlword, row::command, {{row::controlword, word}, {row::mode, mode}, {row::command, kEnable}});
    ASSERT_EQ(owner.write(both), kOk);
    plant_->run(1500ms);  // longer than any drive waits for its master
    EXPECT_TRUE(*plant_->motor().enabled);
    EXPECT_EQ(plant_->set_endless(owner), kOk);
    EXPECT_EQ(owner.command(plant_->endless_command()), kOk);
    EXPECT_TRUE(plant_->turns_within(1s));
  }
}

// It has no more time than one that comes alone, and is withdrawn as that is; a later one is not.
TEST_P(CrossingWithDisable, AnEnableBesideAStoppingControlwordNeverComesLate) {
  plant_.emplace(GetParam());
  plant_->ready_but_disabled();
  Client& owner = plant_->a;
  const auto both = [](std::int64_t word, std::int64_t command, std::int64_t id) {
    return block(row::controlword, row::command_id,
                 {{row::controlword, word}, {row::command, command}, {row::command_id, id}});
  };
  ASSERT_EQ(owner.write(both(15, 0, 1)), kOk);
  lock(plant_->stage, GetParam(), true);
  const Instant asked_at = plant_->stage.runtime().now();
  EXPECT_EQ(owner.write(both(0, kEnable, 2)), kFailed);
  EXPECT_LE(plant_->stage.runtime().now() - asked_at, plant_->listener.reply_deadline);
  plant_->run(1s);
  lock(plant_->stage, GetParam(), false);
  plant_->run(3s);
  EXPECT_FALSE(*plant_->motor().enabled);
  EXPECT_EQ(owner.write(both(1, kEnable, 3)), kOk);
  plant_->run(1s);
  EXPECT_TRUE(*plant_->motor().enabled);
  EXPECT_EQ(owner.word(shown::axis_state), kStandstill);
}

// A disabling controlword beside an enable: the order of one request is the controlword, then the command.
TEST_P(CrossingWithDisable, AnEnableBehindADisablingControlwordIsDoneOrNotAnswered) {
  for (const std::int64_t word : {7, 6}) {
    SCOPED_TRACE(word);
    ready();
    Client& b = plant_->b;
    const bool speeds = has_speeds(GetParam());
    const Rows target = plant_->endless_target();
    const auto scan = [&](std::int64_t controlword, std::int64_t command) {
      Rows rows = target;
      rows[row::controlword] = controlword;
      rows[row::mode] = speeds ? kVelocityMode : 1;
      rows[row::command] = command;
      return b.rows(row::controlword, row::command_id, rows);
    };
    ASSERT_EQ(plant_->a.row(row::mode, speeds ? kVelocityMode : 1), kOk);
    ASSERT_EQ(scan(15, 0), kOk);
    const Answer answer = scan(word, kEnable);
    plant_->run(2s);
    EXPECT_EQ(answer.ok(), *plant_->motor().enabled) << int{answer.exception};
  }
}

// JD's sheet knows of no halt bit: the word was answered as done, and the motor ran on.
TEST_P(CrossingLadder, TheHaltBitHaltsWhateverTheDriveKnowsOfIt) {
  ready();
  Client& a = plant_->a;
  ASSERT_TRUE(plant_->start_endless(a));
  EXPECT_EQ(a.row(row::controlword, 0x010F), kOk);
  EXPECT_TRUE(plant_->comes_to_stand()) << plant_->velocity();
  EXPECT_NE(a.word(shown::motion_state), 1) << "it is over";
}

// The enable took a drive that the word had enabled for disabled, and its ladder dropped the torque.
TEST_P(CrossingLadder, AnEnableBehindAnEnablingControlwordDropsNoTorque) {
  ready();
  Client& b = plant_->b;
  for (const std::int64_t word : {6, 7}) ASSERT_EQ(b.row(row::controlword, word), kOk);
  bool was_on = false, dropped = false;
  send(b, block(row::controlword, row::command_id,
                {{row::controlword, 15}, {row::mode, 1}, {row::command, 0}, {row::command_id, 1}}));
  all_answered();
  for (const std::int64_t word : {6, 7}) ASSERT_EQ(b.row(row::controlword, word), kOk);
  send(b, block(row::controlword, row::command_id,
                {{row::controlword, 15}, {row::mode, 1}, {row::command, kEnable}, {row::command_id, 2}}));
  for (int i = 0; i < 1000; ++i) {
    plant_->run(1ms);
    const bool on = *plant_->motor().enabled;
    dropped = dropped || (was_on && !on);
    was_on = on;
  }
  EXPECT_TRUE(was_on) << answers();
  EXPECT_FALSE(dropped);
}

class CrossingSpeeds : public Crossing {
 protected:
  /// How far it turns the other way, at most, in the next second.
  std::int64_t most_against(std::int64_t wanted) {
    std::int64_t most = 0;
    for (int i = 0; i < 500; ++i) {
      plant_->run(2ms);
      const std::int64_t velocity = plant_->velocity();
      if ((velocity > 0) != (wanted > 0)) most = std::max(most, std::abs(velocity));
    }
    return most;
  }
};

class CrossingMovesAndSpeeds : public CrossingSpeeds {};

// The drive was put into its velocity mode while it still held the speed of the jog before.
TEST_P(CrossingSpeeds, ARunBeginsWithNoSpeedOfBefore) {
  for (const bool jogs : {true, false})
    for (const bool moves : {true, false}) {
      SCOPED_TRACE(std::string(jogs ? "after a jog" : "after a run") + (moves ? " and a move" : " and a halt"));
      ready();
      Client& a = plant_->a;
      if (moves && (!has_positions(GetParam()) || GetParam() == Subject::id286pro)) continue;
      ASSERT_EQ(a.row(row::jog_velocity, 45'000), kOk);
      if (jogs) {
        ASSERT_EQ(a.coil(coil::jog_forward, false), kOk);
        ASSERT_EQ(a.coil(coil::jog_forward, true), kOk);
      } else {
        ASSERT_EQ(a.row(row::target_velocity, kSpeed), kOk);
        ASSERT_EQ(a.command(kRun), kOk);
      }
      plant_->run(300ms);
      ASSERT_GT(plant_->velocity(), 0);
      if (moves) {
        ASSERT_EQ(a.row(row::target_position, kNear), kOk);
        ASSERT_EQ(a.command(kMove), kOk);
      } else {
        ASSERT_EQ(a.command(kHalt), kOk);
      }
      static_cast<void>(plant_->comes_to_rest_at());
      ASSERT_EQ(a.row(row::target_velocity, kOtherSpeed), kOk);
      send(a, one(row::command, kRun));
      EXPECT_LE(most_against(kOtherSpeed), 1'500) << "0.001 rpm";
      EXPECT_TRUE(plant_->reaches(kOtherSpeed)) << plant_->velocity();
    }
}

// A velocity that came with the move that ended a jog was forgotten.
TEST_P(CrossingMovesAndSpeeds, AVelocityBesideTheMoveThatEndsAJogIsKept) {
  ready();
  Client& a = plant_->a;
  ASSERT_EQ(a.row(row::jog_velocity, 45'000), kOk);
  ASSERT_EQ(a.row(row::target_velocity, kSpeed), kOk);
  ASSERT_EQ(a.command(0), kOk);
  ASSERT_EQ(a.coil(coil::jog_forward, false), kOk);
  ASSERT_EQ(a.coil(coil::jog_forward, true), kOk);
  plant_->run(200ms);
  ASSERT_EQ(a.rows(row::target_position, row::command_id,
                   {{row::target_position, kNear}, {row::target_velocity, kOtherSpeed}, {row::command, kMove}}),
            kOk);
  EXPECT_EQ(plant_->comes_to_rest_at(), kNear);
  send(a, one(row::command, kRun));
  EXPECT_LE(most_against(kOtherSpeed), 1'500) << "0.001 rpm";
  EXPECT_TRUE(plant_->reaches(kOtherSpeed)) << plant_->velocity();
}

INSTANTIATE_TEST_SUITE_P(Every, CrossingMovesAndSpeeds, testing::ValuesIn(subjects([](Subject s) {
                           return has_speeds(s) && has_positions(s) && s != Subject::id286pro;
                         })),
                         named);
INSTANTIATE_TEST_SUITE_P(Every, CrossingSpeeds, testing::ValuesIn(subjects(has_speeds)), named);
INSTANTIATE_TEST_SUITE_P(Every, CrossingLadder, testing::ValuesIn(subjects(is_cia402)), named);
INSTANTIATE_TEST_SUITE_P(Every, Crossing, testing::ValuesIn(kSubjects), named);
INSTANTIATE_TEST_SUITE_P(Every, CrossingWithDisable,
                         testing::ValuesIn(subjects([](Subject s) { return s != Subject::id286pro; })), named);

}  // namespace
}  // namespace axisgate::test::obey
