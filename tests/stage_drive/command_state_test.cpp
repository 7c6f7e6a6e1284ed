// SPDX-License-Identifier: Apache-2.0
// Design 3.3 and 3.4 as one table: each command in each situation, on both drives.
#include <gmock/gmock.h>

#include <map>

#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using enum Situation;

/// What each command comes to; `silent`: and nothing is written for it.
struct Row {
  Situation situation;
  Errc enable, disable, quick_stop, halt, fault_reset, absolute, relative, velocity, torque, home, set_position, save;
};
// clang-format off
std::vector<Row> table() {
  constexpr Errc yes = Errc::ok, state = Errc::state_unsuitable, busy = Errc::busy, setup = Errc::still_in_setup,
                 away = Errc::offline;
  return {
    // situation  enable disable quick  halt  reset  abs    rel    vel    torque home   setpos save
    {disabled,    yes,   yes,    yes,   yes,  yes,   state, state, state, state, state, state, yes},
    {enabled,     yes,   yes,    yes,   yes,  yes,   yes,   yes,   yes,   yes,   yes,   yes,   busy},
    {moving,      yes,   yes,    yes,   yes,  yes,   yes,   busy,  yes,   yes,   yes,   busy,  busy},
    {running,     yes,   yes,    yes,   yes,  yes,   yes,   busy,  yes,   yes,   yes,   busy,  busy},
    {homing,      yes,   yes,    yes,   yes,  yes,   yes,   busy,  yes,   yes,   yes,   busy,  busy},
    {halted,      yes,   yes,    yes,   yes,  yes,   yes,   yes,   yes,   yes,   yes,   yes,   busy},
    {latched,     yes,   yes,    yes,   yes,  yes,   state, state, state, state, state, state, yes},
    {faulted,     state, yes,    yes,   yes,  yes,   state, state, state, state, state, state, yes},
    {in_setup,    setup, yes,    yes,   yes,  setup, setup, setup, setup, setup, setup, setup, setup},
    {suspect,     yes,   yes,    yes,   yes,  yes,   yes,   yes,   yes,   yes,   yes,   yes,   busy},
    {offline,     away,  away,   away,  away, away,  away,  away,  away,  away,  away,  away,  away},
    {link_down,   away,  away,   away,  away, away,  away,  away,  away,  away,  away,  away,  away},
};
}
// clang-format on

Errc expected(const Row& row, Command command) {
  const std::map<Command, Errc> codes{{Command::enable, row.enable},
                                      {Command::disable, row.disable},
                                      {Command::quick_stop, row.quick_stop},
                                      {Command::halt, row.halt},
                                      {Command::fault_reset, row.fault_reset},
                                      {Command::move_absolute, row.absolute},
                                      {Command::move_relative, row.relative},
                                      {Command::run_velocity, row.velocity},
                                      {Command::run_torque, row.torque},
                                      {Command::home, row.home},
                                      {Command::set_position, row.set_position},
                                      {Command::save_parameters, row.save}};
  return codes.at(command);
}

class CommandInSituation : public testing::TestWithParam<std::tuple<KincoType, Row, Command>> {};

TEST_P(CommandInSituation, EndsAsTheContractSays) {
  const auto& [type, row, command] = GetParam();
  Rig rig(type);
  rig.bring_to(row.situation);
  const bool was_enabled = rig.motor_enabled();
  WriteBatch batch = with_command(command);
  if (command == Command::move_absolute || command == Command::move_relative)
    batch.setpoints.push_back({Quantity::target_position, 5'000});
  if (command == Command::run_velocity) batch.setpoints.push_back({Quantity::target_velocity, 100'000});
  if (command == Command::home) batch.setpoints.push_back({Quantity::homing_method, 19});
  const BatchResult result = rig.ask(batch);
  const Errc code = expected(row, command);
  EXPECT_EQ(result.outcome.code, code) << text(result.outcome.code);

  const auto words = rig.writes_of(kControlword);
  if (code == Errc::offline || code == Errc::still_in_setup) {
    EXPECT_TRUE(rig.writes().empty());
  }
  if (code == Errc::state_unsuitable) {
    EXPECT_EQ(result.outcome.detail, kDetailDeviceState);
    EXPECT_TRUE(words.empty());
  }
  if (command == Command::enable && was_enabled) {
    EXPECT_TRUE(rig.writes().empty()) << "already enabled: nothing is sent";
  }
  if (command == Command::fault_reset && row.situation != faulted) {
    EXPECT_TRUE(rig.writes().empty());
  }
  if (result.outcome.code != Errc::ok) {
    if (command == Command::quick_stop) {
      EXPECT_TRUE(rig.axis().has(AxisInput::stop_latched)) << "accepted in every state";
    }
    return;
  }
  switch (command) {
    case Command::enable:
      EXPECT_TRUE(rig.motor_enabled());
      EXPECT_FALSE(rig.axis().has(AxisInput::stop_latched));
      break;
    case Command::disable:
      EXPECT_FALSE(rig.motor_enabled());
      EXPECT_EQ(rig.axis().axis_state, row.situation == faulted    ? AxisState::error_stop
                                       : row.situation == latched  ? AxisState::stopping
                                       : row.situation == in_setup ? rig.axis().axis_state
                                                                   : AxisState::disabled);
      break;
    case Command::quick_stop:
      rig.stage.run(1s);
      EXPECT_FALSE(rig.motor_enabled());
      EXPECT_TRUE(rig.axis().has(AxisInput::stop_latched));
      if (row.situation != faulted) {
        EXPECT_EQ(rig.axis().axis_state, AxisState::stopping);
      }
      break;
    case Command::halt: {
      rig.stage.run(2s);
      EXPECT_FALSE(rig.turns());
      if (!was_enabled) {
        EXPECT_FALSE(rig.motor_enabled()) << "a halt never enables";
      }
      const bool quick = rig.axis().has(AxisInput::stop_latched);
      if (was_enabled && !quick) {
        EXPECT_TRUE(rig.motor_enabled()) << "stays enabled";
      }
      // The JD has a halt in the velocity modes alone.
      if (type == KincoType::jd && row.situation == moving) {
        EXPECT_TRUE(quick);
      }
      if (row.situation == running) {
        EXPECT_FALSE(quick);
      }
      if (type == KincoType::md && row.situation == moving) {
        EXPECT_FALSE(quick);
      }
      break;
    }
    case Command::fault_reset:
      EXPECT_FALSE(rig.axis().has(AxisInput::fault));
      EXPECT_EQ(rig.motor_enabled(), was_enabled) << "clears, never enables";
      break;
    case Command::move_absolute:
      EXPECT_EQ(rig.axis().axis_state, AxisState::discrete_motion);
      EXPECT_EQ(rig.axis().motion_state, MotionState::active);
      EXPECT_TRUE(rig.stage.run_until([&] { return rig.axis().motion_state == MotionState::completed; }));
      rig.stage.run(300ms);  // from inside the target window to its middle
      EXPECT_NEAR(static_cast<double>(rig.axis()[Quantity::position_actual].value), 5'000, 20);
      break;
    case Command::move_relative: {
      EXPECT_TRUE(rig.stage.run_until([&] { return rig.axis().motion_state == MotionState::completed; }));
      EXPECT_EQ(rig.axis().axis_state, AxisState::standstill);
      break;
    }
    case Command::run_velocity:
      EXPECT_EQ(rig.axis().axis_state, AxisState::continuous_motion);
      EXPECT_TRUE(
          rig.stage.run_until([&] { return std::abs(rig.axis()[Quantity::velocity_actual].value - 100'000) < 2'000; }));
      break;
    case Command::run_torque:
      EXPECT_EQ(rig.object(kMode), 4);
      EXPECT_EQ(rig.axis().axis_state, AxisState::continuous_motion);
      EXPECT_EQ(rig.object(0x60F6, 8), 0) << "no torque was asked for";
      break;
    case Command::home:
      EXPECT_EQ(rig.axis().axis_state, AxisState::homing);
      EXPECT_TRUE(rig.turns());
      break;
    case Command::set_position:
      EXPECT_NEAR(static_cast<double>(rig.axis()[Quantity::position_actual].value), 0, 20);
      EXPECT_TRUE(rig.axis().has(AxisInput::homed));
      break;
    case Command::save_parameters:
      EXPECT_EQ(rig.motor().stores(), 1U);
      break;
    default:
      break;
  }
}

INSTANTIATE_TEST_SUITE_P(Table, CommandInSituation,
                         testing::Combine(testing::Values(KincoType::jd, KincoType::md), testing::ValuesIn(table()),
                                          testing::Values(Command::enable, Command::disable, Command::quick_stop,
                                                          Command::halt, Command::fault_reset, Command::move_absolute,
                                                          Command::move_relative, Command::run_velocity,
                                                          Command::run_torque, Command::home, Command::set_position,
                                                          Command::save_parameters)),
                         [](const auto& case_of) {
                           std::string out = name(std::get<0>(case_of.param)) + "_" +
                                             name(std::get<1>(case_of.param).situation) + "_" +
                                             std::string(text(std::get<2>(case_of.param)));
                           std::ranges::replace_if(
                               out, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
                           return out;
                         });

}  // namespace
}  // namespace axisgate::test
