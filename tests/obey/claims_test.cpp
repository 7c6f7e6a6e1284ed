// SPDX-License-Identifier: Apache-2.0
// 3.3 What asks, and what claims: an idle PLC that scans and a panel share an axis.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/obey/dds_writers.hpp"
#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

/// A target of the axis's kind, and the command that goes there; each ends within a test's time or is a speed.
struct Aim {
  std::uint16_t row;
  std::int64_t value;
  std::int64_t command;
};
Aim aim(Subject subject, bool first) {
  if (has_positions(subject)) return {row::target_position, first ? kNear : kAway, 6};
  return {row::target_velocity, first ? kSpeed : kOtherSpeed, 8};
}

void arrives(Plant& plant, const Aim& aim) {
  if (aim.command == 8) {
    EXPECT_TRUE(plant.reaches(aim.value)) << plant.velocity() << " instead of " << aim.value;
    return;
  }
  EXPECT_TRUE(plant.stage.run_until([&] { return std::abs(plant.position() - aim.value) <= kClose; }, 10s))
      << plant.position() << " instead of " << aim.value;
}

Write idle_block(Plant& plant, const Aim& aim) {
  Rows rows = plant.profile_rows();
  rows[aim.row] = aim.value;
  return block(row::controlword, row::heartbeat, rows);
}

class Claims : public testing::TestWithParam<Subject> {
 protected:
  Claims() { plant_.ready(); }
  Plant plant_{GetParam(), with_leases()};
  Client& a_ = plant_.a;
  Client& b_ = plant_.b;
  Aim here_ = aim(GetParam(), true), there_ = aim(GetParam(), false);
};

TEST_P(Claims, AreNotMadeByAnIdleScanner) {
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(a_.write(idle_block(plant_, here_)), kOk);
    plant_.run(50ms);
  }
  EXPECT_EQ(b_.word(shown::owner), kNobody);
}

TEST_P(Claims, OfAPanelStandBesideAnIdleScanner) {
  plant_.scan(a_, idle_block(plant_, here_), 300ms);
  EXPECT_EQ(b_.row(there_.row, there_.value), kOk);
  EXPECT_EQ(b_.word(shown::owner), kMe);
  EXPECT_EQ(b_.command(there_.command), kOk);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(a_.write(idle_block(plant_, here_)), kOk);
    EXPECT_EQ(b_.word(shown::owner), kMe);  // the panel looks on
    plant_.run(50ms);
  }
  arrives(plant_, there_);
}

TEST_P(Claims, OfAPanelAreRefusedToAScannerThatAsks) {
  plant_.scan(a_, idle_block(plant_, here_), 300ms);
  ASSERT_EQ(b_.row(there_.row, there_.value), kOk);
  ASSERT_EQ(b_.command(there_.command), kOk);
  Aim other = here_;
  other.value += 1000;
  EXPECT_EQ(a_.write(idle_block(plant_, other)), kNotNow);
  EXPECT_EQ(a_.result(), kNotOwner);
  arrives(plant_, there_);
}

TEST_P(Claims, ThatAreMissingKeepSetpointsBesideARefusedCommandAway) {
  ASSERT_EQ(b_.command(0, 1), kOk);
  ASSERT_EQ(a_.row(here_.row, here_.value), kOk);
  ASSERT_EQ(a_.word(shown::owner), kMe);
  Rows rows = plant_.profile_rows();
  rows[there_.row] = there_.value;
  rows[row::command] = there_.command;
  rows[row::command_id] = 2;
  EXPECT_EQ(b_.rows(row::target_position, row::command_id, rows), kNotNow);
  EXPECT_EQ(b_.result(), kNotOwner);
  EXPECT_EQ(a_.command(here_.command), kOk);
  arrives(plant_, here_);
}

// 3.5: "from its first accepted write".
TEST_P(Claims, AreNotMadeByWhatIsRefused) {
  ASSERT_EQ(a_.row(here_.row, here_.value), kOk);
  ASSERT_EQ(a_.command(kDisable), kOk);
  ASSERT_EQ(a_.command(kRelease), kOk);
  ASSERT_EQ(a_.word(shown::owner), kNobody);
  EXPECT_EQ(b_.command(here_.command), kFailed) << "a start of an axis that is disabled";
  EXPECT_EQ(b_.result(), 9);
  EXPECT_EQ(a_.word(shown::owner), kNobody);
  ASSERT_EQ(b_.rows(row::command, row::command_id, {}), kOk);
  EXPECT_EQ(b_.rows(row::command, row::command_id, {{row::command, here_.command}}), kFailed) << "in a block";
  EXPECT_EQ(a_.word(shown::owner), kNobody);
  // What is accepted claims.
  EXPECT_EQ(a_.command(kEnable), kOk);
  EXPECT_EQ(a_.word(shown::owner), kMe);
  EXPECT_EQ(a_.row(here_.row, here_.value), kOk);
  EXPECT_EQ(a_.command(kRelease), kOk);
  EXPECT_EQ(a_.command(here_.command), kOk);
  EXPECT_EQ(a_.word(shown::owner), kMe);
}

TEST_P(Claims, AreNotMadeByAStartWhileTheStopIsLatched) {
  ASSERT_EQ(a_.command(kQuickStop), kOk);
  ASSERT_EQ(b_.command(here_.command), kFailed);
  EXPECT_EQ(a_.word(shown::owner), kNobody);
  EXPECT_EQ(a_.command(kEnable), kOk);
  EXPECT_EQ(a_.word(shown::owner), kMe);
}

// 3.2: "sequence steps when any value, valid bit, link_state, owner or error of the axis changes".
TEST_P(Claims, StepTheSequence) {
  const auto sequence = [this] { return plant_.stage.axis(1).sequence; };
  ASSERT_EQ(a_.row(here_.row, here_.value), kOk);
  plant_.run(1s);
  const auto owned = sequence();
  ASSERT_EQ(a_.command(kRelease), kOk);
  const auto released = sequence();
  EXPECT_NE(released, owned);
  plant_.run(100ms);
  const auto free = sequence();
  ASSERT_EQ(b_.row(here_.row, here_.value), kOk) << "what it holds already";
  EXPECT_NE(sequence(), free);
}

/// A DDS writer beside a_, which owns the axis.
class StrangersJog : public Claims {
 protected:
  void SetUp() override {
    ASSERT_EQ(a_.row(row::jog_velocity, kSpeed), kOk);
    ASSERT_EQ(a_.word(shown::owner), kMe);
  }
  std::uint8_t answer_to(const Rows& sample) {
    const std::uint64_t request = stranger_.begin({.function = fc::sample, .sample = sample});
    EXPECT_TRUE(plant_.stage.run_until([&] { return stranger_.result_of(request).has_value(); }));
    return stranger_.result_of(request).value_or(0);
  }
  DdsWriters stranger_{plant_.stage, 1};
};

// 3.5: "from its first accepted write"; a level that was refused goes on being written (3.4 Jog).
TEST_P(StrangersJog, ClaimsNothingWhenItIsHeldAfterItsRefusal) {
  constexpr std::uint8_t kNotNew = 10;
  EXPECT_EQ(answer_to({{row::command, kJogForward}}), kNotOwner);
  for (int i = 0; i < 5; ++i) {
    plant_.run(200ms);
    EXPECT_EQ(answer_to({{row::command, kJogForward}}), kNotNew);
    EXPECT_EQ(a_.word(shown::owner), kMe);
  }
  EXPECT_EQ(answer_to({{row::target_velocity, kSpeed}, {row::command, 0}}), kNotOwner);
  EXPECT_EQ(answer_to({{row::command, kRun}}), kNotOwner);
  plant_.run(1s);
  EXPECT_TRUE(plant_.stands());
  EXPECT_EQ(a_.word(shown::owner), kMe);
}

TEST_P(StrangersJog, ClaimsNothingWithTheVelocityThatTheAxisHolds) {
  EXPECT_EQ(answer_to({{row::jog_velocity, kSpeed}, {row::command, kJogForward}}), kNotOwner);
  plant_.run(1s);
  EXPECT_TRUE(plant_.stands());
  EXPECT_EQ(a_.word(shown::owner), kMe);
  EXPECT_EQ(answer_to({{row::jog_velocity, kSpeed}, {row::command, 0}}), kNotOwner);
  EXPECT_EQ(a_.word(shown::owner), kMe);
}

// Whoever asks for the end of a jog by its name is not told done while the motor turns on.
TEST_P(StrangersJog, IsEndedByWhoeverAsksForItsEnd) {
  constexpr std::uint8_t kDone = 2;
  constexpr std::int64_t kJogEnd = 33;
  ASSERT_EQ(a_.coil(coil::jog_forward, false), kOk);
  ASSERT_EQ(a_.coil(coil::jog_forward, true), kOk);
  ASSERT_TRUE(plant_.turns_within(300ms));
  EXPECT_EQ(answer_to({{row::command, kJogEnd}}), kDone);
  for (int i = 0; i < 10; ++i) {
    plant_.run(100ms);
    static_cast<void>(a_.coil(coil::jog_forward, true));  // it is held on
  }
  EXPECT_TRUE(plant_.stands());
  EXPECT_EQ(a_.word(shown::owner), kMe);
}

/// A DDS writer that owns the axis, and a stronger one.
class StrongersRefusal : public Claims {
 protected:
  std::uint8_t answer_to(std::size_t writer, const Rows& sample) {
    const std::uint64_t request = writers_.begin({.function = fc::sample, .sample = sample}, writer);
    EXPECT_TRUE(plant_.stage.run_until([&] { return writers_.result_of(request).has_value(); }));
    return writers_.result_of(request).value_or(0);
  }
  DdsWriters writers_{plant_.stage, 1, {1, 5}};
};

TEST_P(StrongersRefusal, TakesNothingAway) {
  constexpr std::uint8_t kDone = 2;
  constexpr std::int64_t kSetPosition = 11;
  Rows start = plant_.endless_target();
  start[row::command] = plant_.endless_command();
  ASSERT_EQ(answer_to(0, start), kDone);
  ASSERT_TRUE(plant_.turns_within(1s));
  const std::uint8_t refused = answer_to(1, {{row::set_position_value, 0}, {row::command, kSetPosition}});
  EXPECT_NE(refused, kDone) << "it moves";
  EXPECT_NE(refused, kNotOwner) << "it is the stronger one";
  EXPECT_TRUE(plant_.keeps_turning());
  EXPECT_EQ(answer_to(0, {{row::command, kRelease}}), kDone) << "its axis as before";
}

class WithoutLeases : public testing::TestWithParam<Subject> {
 protected:
  WithoutLeases() { plant_.ready(); }
  Plant plant_{GetParam()};
  Client& a_ = plant_.a;
  Client& b_ = plant_.b;
  Aim here_ = aim(GetParam(), true), there_ = aim(GetParam(), false);
};

TEST_P(WithoutLeases, AnIdleScannerDoesNotUndoAPanelsTarget) {
  // Without 40 and 54: its first block asks, the later ones do not.
  const auto last = static_cast<std::uint16_t>(here_.row + 1);
  const Write scanned = block(here_.row, last, {{here_.row, here_.value}}, fc::read_write);
  plant_.scan(a_, scanned, 300ms);
  ASSERT_EQ(b_.row(there_.row, there_.value), kOk);
  plant_.scan(a_, scanned, 300ms);
  ASSERT_EQ(b_.command(there_.command), kOk);
  plant_.scan(a_, scanned, 200ms);
  arrives(plant_, there_);
}

TEST_P(WithoutLeases, AScannedBlockThatOnlyRemembersIsNoTarget) {
  ASSERT_EQ(b_.row(there_.row, there_.value), kOk);
  plant_.scan(a_, idle_block(plant_, here_), 300ms);
  ASSERT_EQ(b_.command(there_.command), kOk);
  plant_.scan(a_, idle_block(plant_, here_), 200ms);
  arrives(plant_, there_);
}

TEST_P(WithoutLeases, TargetsThatChangeAreTakenFromEveryone) {
  ASSERT_EQ(b_.row(there_.row, there_.value), kOk);
  ASSERT_EQ(a_.row(here_.row, here_.value), kOk);
  ASSERT_EQ(b_.command(there_.command), kOk);
  arrives(plant_, here_);
}

TEST_P(WithoutLeases, SetpointsBesideACommandThatIsRefusedAreTakenOnlyIfTheyWouldBeWithoutIt) {
  ASSERT_EQ(b_.command(0, 1), kOk);
  Rows rows = plant_.profile_rows();
  rows[there_.row] = there_.value;
  ASSERT_EQ(b_.rows(there_.row, 53,
                    [&] {
                      Rows few;
                      for (const auto& [offset, value] : rows)
                        if (offset >= there_.row) few.emplace(offset, value);
                      return few;
                    }()),
            kOk);
  ASSERT_EQ(a_.row(here_.row, here_.value), kOk);
  ASSERT_EQ(a_.command(kDisable), kOk);
  // The same row as b wrote last, beside a start that the disabled axis refuses.
  rows[row::command] = there_.command;
  rows[row::command_id] = 2;
  EXPECT_EQ(b_.rows(row::target_position, row::command_id, rows), kFailed);
  ASSERT_EQ(a_.command(0), kOk);
  ASSERT_EQ(a_.command(kEnable), kOk);
  // 3.4: "velocity ... needed anew" after a disable.
  if (here_.command == kRun) {
    EXPECT_EQ(a_.command(kRun), kFailed);
    plant_.run(1s);
    EXPECT_TRUE(plant_.stands()) << plant_.velocity();
  } else {
    ASSERT_EQ(a_.command(here_.command), kOk);
    arrives(plant_, here_);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, Claims, testing::ValuesIn(kSubjects), named);
INSTANTIATE_TEST_SUITE_P(Every, StrangersJog, testing::ValuesIn(subjects(has_speeds)), named);
INSTANTIATE_TEST_SUITE_P(Every, StrongersRefusal, testing::ValuesIn(kSubjects), named);
INSTANTIATE_TEST_SUITE_P(Every, WithoutLeases, testing::ValuesIn(kSubjects), named);

}  // namespace
}  // namespace axisgate::test::obey
