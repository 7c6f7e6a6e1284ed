// SPDX-License-Identifier: Apache-2.0
// What a Modbus RTU line does to replies: noise, halves, glued and flipped frames, wrong units and lengths, drives that
// babble or are unresponsive. Never a wrong value, and everything comes back.
#include <gmock/gmock.h>

#include "tests/stage_drive/rtu_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::DriveFault;
using testing::IsEmpty;

bool position_valid(RtuRig& rig, AxisNumber axis) {
  return rig.online(axis) && rig.axis(axis)[Quantity::position_actual].valid;
}

class RtuLineFault : public testing::TestWithParam<std::tuple<Subject, DriveFault>> {};

TEST_P(RtuLineFault, ShowsNoWrongValueAndComesBack) {
  const auto [kind, fault] = GetParam();
  RtuRig rig(kind);
  rig.come_up_running();
  for (const double rate : {0.05, 0.3, 1.0}) {
    rig.faults().set_rate(fault, rate);
    for (int i = 0; i < 12; ++i) {
      rig.run(250ms);
      rig.ask_something();
    }
    rig.faults().clear();
    EXPECT_TRUE(rig.run_until([&] { return position_valid(rig, 1); }, 45s)) << rate;
    rig.run(500ms);
    EXPECT_TRUE(rig.online()) << rate;
  }
  EXPECT_THAT(rig.wrongs(), IsEmpty());
  EXPECT_GT(rig.looked_at(), 100U);
}

std::string fault_name(DriveFault fault) {
  std::string text(simulated::name_of(fault));
  std::erase(text, '-');
  return text;
}

INSTANTIATE_TEST_SUITE_P(
    Each, RtuLineFault,
    testing::Combine(testing::ValuesIn(kOnRtu),
                     testing::Values(DriveFault::lose, DriveFault::unresponsive, DriveFault::noise_before,
                                     DriveFault::noise_after, DriveFault::corrupt, DriveFault::split,
                                     DriveFault::wrong_station, DriveFault::half, DriveFault::wrong_length,
                                     DriveFault::glued, DriveFault::duplicate, DriveFault::restart)),
    [](const auto& of) { return name(std::get<0>(of.param)) + "_" + fault_name(std::get<1>(of.param)); });

class RtuNeighbours : public testing::TestWithParam<Subject> {};

TEST_P(RtuNeighbours, OfAnUnresponsiveDriveKeepTheirCycleAfterTheFirstMinute) {
  RtuRig rig(GetParam());
  rig.come_up_running();
  rig.run(3s);
  rig.faults().set_rate(DriveFault::unresponsive, 1);
  rig.run(60s);
  rig.forget_waits();
  rig.run(30s);
  EXPECT_LE(rig.longest_wait(), 400ms) << "the timeout of one probe, and what waited behind it";
  EXPECT_EQ(rig.axis().link_state, LinkState::offline);
  EXPECT_TRUE(position_valid(rig, 2) && position_valid(rig, 3));
  EXPECT_THAT(rig.wrongs(), IsEmpty());
  rig.faults().clear();
  EXPECT_TRUE(rig.run_until([&] { return position_valid(rig, 1); }, 45s));
}

TEST_P(RtuNeighbours, OfABabblingDriveNeverShowAWrongValueAndComeBack) {
  for (const Duration period : {7ms, 40ms, 300ms}) {
    RtuRig rig(GetParam(), {.neighbours_stay = false});
    rig.come_up_running();
    rig.faults().babble_period = period;
    rig.faults().set_rate(DriveFault::babble, 1);
    rig.run(15s);
    rig.faults().clear();
    EXPECT_TRUE(
        rig.run_until([&] { return position_valid(rig, 1) && position_valid(rig, 2) && position_valid(rig, 3); }, 60s))
        << period / 1ms << " ms";
    EXPECT_THAT(rig.wrongs(), IsEmpty()) << period / 1ms << " ms";
  }
}

INSTANTIATE_TEST_SUITE_P(Each, RtuNeighbours, testing::ValuesIn(kOnRtu), named);

}  // namespace
}  // namespace axisgate::test
