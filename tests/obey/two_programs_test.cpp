// SPDX-License-Identifier: Apache-2.0
// Two programs at one address, each on a connection of its own (3.3 Edges): what one of them scans unchanged, or brings
// again on a new connection, starts nothing that the other has stopped.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr Duration kTwentyScans = 20 * 50ms;

class TwoPrograms : public testing::TestWithParam<std::tuple<Subject, bool>> {
 protected:
  TwoPrograms() { plant_.ready(); }
  static PlantOptions options() {
    PlantOptions options;
    options.listener.client_is_address = std::get<1>(GetParam());
    return options;
  }
  Write pair(std::int64_t command, std::int64_t id) {
    Rows rows = plant_.profile_rows();
    rows.merge(plant_.endless_target());
    rows[row::command] = command;
    rows[row::command_id] = id;
    return block(row::target_position, row::command_id, rows);
  }
  void nothing_moves_by_scans_of(const Write& unchanged) {
    plant_.run(2s);  // the halt of some drives first overshoots, and comes back
    const std::int64_t rests_at = plant_.comes_to_rest_at();
    plant_.scan(plc_, unchanged, kTwentyScans);
    EXPECT_LE(std::abs(plant_.comes_to_rest_at() - rests_at), kClose);
  }
  Plant plant_{std::get<0>(GetParam()), options()};
  Client& plc_ = plant_.a;
  std::unique_ptr<Client> panel_ = plant_.connection_from(Plant::kHostOfA);
  std::int64_t start_ = plant_.endless_command();
};

TEST_P(TwoPrograms, OfWhichOneHaltsTheMotorTheOthersUnchangedScanLeavesAtRest) {
  ASSERT_EQ(plc_.command(0, 3), kOk);
  ASSERT_EQ(plc_.write(pair(start_, 4)), kOk);
  ASSERT_TRUE(plant_.keeps_turning());
  ASSERT_EQ(panel_->command(kHalt, 900), kOk);
  nothing_moves_by_scans_of(pair(start_, 4));
  EXPECT_EQ(plc_.write(pair(start_, 5)), kOk);
  EXPECT_TRUE(plant_.keeps_turning()) << "another id is new";
}

TEST_P(TwoPrograms, OfWhichOneStopsTheMotorTheOthersUnchangedEnableLeavesLatched) {
  ASSERT_EQ(plc_.command(0, 9), kOk);
  const Write enable = pair(kEnable, 10);
  ASSERT_EQ(plc_.write(enable), kOk);
  ASSERT_EQ(panel_->command(kQuickStop, 901), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  plant_.scan(plc_, enable, kTwentyScans);
  EXPECT_EQ(plc_.word(shown::axis_state), kStopLatched);
  EXPECT_FALSE(plant_.motor().enabled.value_or(false));
  EXPECT_EQ(plc_.write(pair(kEnable, 11)), kOk);
  EXPECT_TRUE(plant_.motor().enabled.value_or(true));
}

TEST_P(TwoPrograms, OfWhichOneWritesAnIdTheOthersUnchangedRelativeMoveIsNotAdded) {
  if (!has_positions(plant_.subject)) return;
  ASSERT_EQ(plc_.command(0, 3), kOk);
  Rows rows = plant_.profile_rows();
  rows[row::target_position] = kNear;
  rows[row::command] = kRelative;
  rows[row::command_id] = 4;
  const Write move = block(row::target_position, row::command_id, rows);
  ASSERT_EQ(plc_.write(move), kOk);
  ASSERT_LE(std::abs(plant_.comes_to_rest_at() - kNear), kClose);
  ASSERT_EQ(panel_->command(0, 700), kOk);
  nothing_moves_by_scans_of(move);
  static_cast<void>(panel_->command(12, 701));  // refused while the axis is enabled
  nothing_moves_by_scans_of(move);
}

// Of one client, where "client" is "address", and of two, where it is "connection".
TEST_P(TwoPrograms, WithoutIdsStartNothingByWhatTheyRepeat) {
  ASSERT_EQ(plc_.command(0), kOk);
  ASSERT_EQ(plc_.write(pair(start_, 0)), kOk);
  ASSERT_TRUE(plant_.keeps_turning());
  ASSERT_EQ(panel_->command(kHalt), kOk);
  nothing_moves_by_scans_of(pair(start_, 0));
  ASSERT_EQ(plc_.write(pair(0, 0)), kOk);
  EXPECT_EQ(plc_.write(pair(start_, 0)), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
}

// A stop too many is the smaller harm.
TEST_P(TwoPrograms, StopByAnIdThatTheOtherHasUsedOrThatTheyUsedBeforeTheOther) {
  ASSERT_EQ(panel_->write(pair(kQuickStop, 900)), kOk);
  ASSERT_EQ(plc_.command(kEnable, 4), kOk);
  ASSERT_EQ(plc_.write(pair(start_, 5)), kOk);
  ASSERT_TRUE(plant_.turns_within(2s));
  EXPECT_EQ(panel_->write(pair(kQuickStop, 5)), kOk);
  EXPECT_TRUE(plant_.comes_to_stand());
  ASSERT_EQ(plc_.command(kEnable, 6), kOk);
  ASSERT_EQ(plc_.write(pair(start_, 7)), kOk);
  ASSERT_TRUE(plant_.turns_within(2s));
  EXPECT_EQ(panel_->write(pair(kQuickStop, 5)), kOk);
  EXPECT_TRUE(plant_.comes_to_stand());
}

/// One that connects anew and brings its old pair of command and id; where no other program was there the id of the
/// address decides alone.
class Reconnected : public TwoPrograms {
 protected:
  void runs() {
    ASSERT_EQ(plc_.command(0, 3), kOk);
    plant_.scan(plc_, pair(start_, 4), 500ms);
    ASSERT_TRUE(plant_.keeps_turning());
  }
  void connects_anew() {
    plc_.disconnect();
    plc_.connect();
  }
  /// At rest, and enabled: some drives are disabled where their client leaves.
  void is_ready_again() {
    plant_.run(2s);  // the halt of some drives first overshoots, and comes back
    plant_.comes_to_rest_at();
    ASSERT_EQ(panel_->command(kEnable), kOk);
  }
  void starts_nothing_by(const Write& old_pair) {
    plant_.run(2s);
    const std::int64_t rests_at = plant_.comes_to_rest_at();
    EXPECT_EQ(plc_.write(old_pair), kOk);
    EXPECT_EQ(plc_.result(), kNotNew);
    plant_.scan(plc_, old_pair, 1s);
    EXPECT_LE(std::abs(plant_.comes_to_rest_at() - rests_at), kClose);
  }
};

TEST_P(Reconnected, BringsAnOldStartThatTheOtherHasHalted) {
  runs();
  plc_.disconnect();
  ASSERT_EQ(panel_->command(kHalt, 900), kOk);
  plc_.connect();
  starts_nothing_by(pair(start_, 4));
  connects_anew();
  ASSERT_EQ(panel_->command(kHalt, 901), kOk);
  starts_nothing_by(pair(start_, 4));
  is_ready_again();
  EXPECT_EQ(plc_.write(pair(start_, 5)), kOk);
  EXPECT_TRUE(plant_.keeps_turning()) << "another id is new";
}

TEST_P(Reconnected, BringsAnOldEnableThatTheOtherHasStopped) {
  ASSERT_EQ(plc_.command(0, 9), kOk);
  plant_.scan(plc_, pair(kEnable, 10), 500ms);
  plc_.disconnect();
  ASSERT_EQ(panel_->command(kQuickStop, 901), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  plc_.connect();
  starts_nothing_by(pair(kEnable, 10));
  EXPECT_EQ(plc_.word(shown::axis_state), kStopLatched);
  EXPECT_FALSE(plant_.motor().enabled.value_or(false));
}

TEST_P(Reconnected, StopsByAnOldStopAllTheSame) {
  ASSERT_EQ(plc_.command(0, 3), kOk);
  plant_.scan(plc_, pair(kHalt, 4), 500ms);
  plc_.disconnect();
  ASSERT_EQ(panel_->command(kHalt, 900), kOk);
  is_ready_again();
  ASSERT_EQ(panel_->write(pair(start_, 901)), kOk);
  ASSERT_TRUE(plant_.turns_within(2s));
  plc_.connect();
  EXPECT_EQ(plc_.write(pair(kHalt, 4)), kOk);
  EXPECT_TRUE(plant_.comes_to_stand());
}

// A tool that connects for each command: who follows is the same program.
TEST_P(Reconnected, OneAfterTheOtherTheIdOfTheAddressDecides) {
  runs();
  connects_anew();
  ASSERT_EQ(plc_.write(pair(kHalt, 5)), kOk);
  connects_anew();
  is_ready_again();
  EXPECT_EQ(plc_.write(pair(start_, 4)), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
}

constexpr auto named_by_clients = [](const auto& tested) {
  return name(std::get<0>(tested.param)) + (std::get<1>(tested.param) ? "_one_client" : "_two_clients");
};
INSTANTIATE_TEST_SUITE_P(Every, TwoPrograms, testing::Combine(testing::ValuesIn(kSubjects), testing::Bool()),
                         named_by_clients);
INSTANTIATE_TEST_SUITE_P(Every, Reconnected, testing::Combine(testing::ValuesIn(kSubjects), testing::Bool()),
                         named_by_clients);

}  // namespace
}  // namespace axisgate::test::obey
