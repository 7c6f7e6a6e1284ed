// SPDX-License-Identifier: Apache-2.0
// Two programs at one address that are one client (3.3 Edges): a coil that one of them holds starts nothing, whatever
// the other has written to it since; a coil that is let go always stops.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

class HeldCoils : public testing::TestWithParam<Subject> {
 protected:
  HeldCoils() { plant_.ready(); }
  static PlantOptions options() {
    PlantOptions options;
    options.listener.client_is_address = true;
    return options;
  }
  static Write row_of(std::uint16_t coil, bool on) {
    return coil_block(coil, on ? std::vector<std::uint16_t>{1, 0} : std::vector<std::uint16_t>{0, 0});
  }
  void presses_in_its_row(std::uint16_t coil) {
    ASSERT_EQ(plc_.write(row_of(coil, false)), kOk);
    ASSERT_EQ(plc_.write(row_of(coil, true)), kOk);
  }
  void runs_by_its_coil() {
    ASSERT_EQ(plant_.set_endless(plc_), kOk);
    presses_in_its_row(coil::run_velocity);
    ASSERT_TRUE(plant_.keeps_turning());
  }
  void holds(std::uint16_t coil) {
    plant_.scan(plc_, row_of(coil, true), 1s);
    EXPECT_EQ(plc_.coil(coil, true), kNotNow) << "alone it is told";
  }
  Plant plant_{GetParam(), options()};
  Client& plc_ = plant_.a;
  std::unique_ptr<Client> panel_ = plant_.connection_from(Plant::kHostOfA);
};
using HeldLevels = HeldCoils;

TEST_P(HeldCoils, DoNotEnableAgainWhereTheOtherHasDisabled) {
  ASSERT_EQ(plc_.write(row_of(coil::enable, false)), kOk);
  ASSERT_EQ(plc_.write(row_of(coil::enable, true)), kOk);
  ASSERT_EQ(plc_.word(shown::axis_state), kStandstill);
  ASSERT_EQ(panel_->coil(coil::enable, false), kOk);
  const std::int64_t disabled = plc_.word(shown::axis_state);
  ASSERT_NE(disabled, kStandstill);
  holds(coil::enable);
  EXPECT_EQ(plc_.word(shown::axis_state), disabled);
  presses_in_its_row(coil::enable);
  EXPECT_EQ(plc_.word(shown::axis_state), kStandstill);
}

TEST_P(HeldCoils, AddNoRelativeMoveWhereTheOtherHasWrittenZero) {
  if (!has_positions(GetParam())) return;
  ASSERT_EQ(plc_.row(row::target_position, kNear), kOk);
  presses_in_its_row(coil::start_relative);
  const std::int64_t there = plant_.comes_to_rest_at();
  ASSERT_EQ(panel_->coil(coil::start_relative, false), kOk);
  plant_.scan(plc_, row_of(coil::start_relative, true), 1s);
  EXPECT_LE(std::abs(plant_.comes_to_rest_at() - there), kClose);
}

TEST_P(HeldLevels, DoNotRunAgainWhereTheOtherHasStopped) {
  runs_by_its_coil();
  ASSERT_EQ(panel_->coil(coil::run_velocity, false), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  holds(coil::run_velocity);
  EXPECT_TRUE(plant_.stands());
  runs_by_its_coil();
}

TEST_P(HeldLevels, DoNotJogAgainWhereTheOtherHasLetGo) {
  ASSERT_EQ(plc_.row(row::jog_velocity, kSpeed), kOk);
  presses_in_its_row(coil::jog_forward);
  ASSERT_TRUE(plant_.turns_within(400ms));
  ASSERT_EQ(panel_->coil(coil::jog_forward, false), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  holds(coil::jog_forward);
  EXPECT_TRUE(plant_.stands());
  presses_in_its_row(coil::jog_forward);
  EXPECT_TRUE(plant_.turns_within(400ms));
}

TEST_P(HeldLevels, StopWhenTheyAreLetGoWhateverTheOtherHasWrittenBefore) {
  runs_by_its_coil();
  ASSERT_EQ(panel_->coil(coil::run_velocity, false), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  ASSERT_EQ(plant_.set_endless(*panel_), kOk);
  ASSERT_EQ(panel_->command(8), kOk);
  ASSERT_TRUE(plant_.keeps_turning());
  EXPECT_EQ(plc_.write(row_of(coil::run_velocity, false)), kOk);
  EXPECT_TRUE(plant_.comes_to_stand());
}

// What a connection held ends with it: a tool that connects anew for each write presses each time.
TEST_P(HeldLevels, AreForgottenWithTheirConnection) {
  runs_by_its_coil();
  plc_.disconnect();
  plc_.connect();
  ASSERT_EQ(panel_->coil(coil::run_velocity, false), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  ASSERT_EQ(plant_.set_endless(plc_), kOk);
  EXPECT_EQ(plc_.coil(coil::run_velocity, true), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
}

INSTANTIATE_TEST_SUITE_P(Every, HeldCoils, testing::ValuesIn(kSubjects), named);
INSTANTIATE_TEST_SUITE_P(Every, HeldLevels, testing::ValuesIn(subjects(has_speeds)), named);

}  // namespace
}  // namespace axisgate::test::obey
