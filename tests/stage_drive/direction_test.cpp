// SPDX-License-Identifier: Apache-2.0
// Numbers that a drive has in more than one object, behind the shipped core: a speed whose direction stands beside it,
// and a motion that goes to the drive in one request. Judged by what the simulated motor was told and does.
#include <gmock/gmock.h>

#include "tests/places.hpp"
#include "tests/stage_drive/drive_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::DirectData;
using simulated::Inverter;
using ::testing::ElementsAre;

constexpr std::int64_t kHertz = 30'000;  // register units of 1 Hz at two pole pairs: 30 rpm

GatewayStage::Line line_of(const simulated::RtuDriveOptions& drive, const std::string& profile, bool inverted = false) {
  GatewayStage::Line line = rtu_line_of({drive}, 1);
  line.rtu_drives.front().profile = source_path("tests/profiles/valid/" + profile + ".json");
  line.rtu_drives.front().axis.inverted = inverted;
  return line;
}

class InverterRig {
 public:
  explicit InverterRig(const std::string& profile, bool inverted = false)
      : stage({line_of(simulated::InverterOptions{}, profile, inverted)}) {
    expect(stage.come_online(), "never online");
    expect(ask(Command::enable) == Errc::ok, "not enabled");
  }

  GatewayStage stage;

  [[nodiscard]] Inverter& motor() {
    stage.rtu_link(0).advance_drives();
    return dynamic_cast<Inverter&>(stage.rtu_link(0).line().slave(0));
  }
  [[nodiscard]] const AxisImage& axis() { return stage.axis(1); }
  Errc ask(Command command, std::initializer_list<Setpoint> with = {}) {
    return stage.ask(1, with_command(command, with)).outcome.code;
  }
  Errc run(std::int64_t hertz) { return ask(Command::run_velocity, {{Quantity::target_velocity, hertz * kHertz}}); }
};

class WithADirection : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(In, WithADirection, ::testing::Values("inverter", "inverter-bit"), [](const auto& tested) {
  return std::string(tested.param) == "inverter" ? "ItsCommand" : "ARegister";
});

TEST_P(WithADirection, TheMotorIsNeverToldToTurnTheWrongWay) {
  InverterRig rig(GetParam());
  EXPECT_FALSE(rig.motor().runs()) << "enabled only";
  ASSERT_EQ(rig.run(-20), Errc::ok);
  rig.stage.run(1s);
  EXPECT_EQ(rig.motor().speed(), -2000);
  EXPECT_EQ(rig.axis()[Quantity::velocity_actual].value, -20 * kHertz);
  EXPECT_EQ(rig.axis()[Quantity::target_velocity].value, -20 * kHertz);
  // Set-points alone, while it turns.
  ASSERT_EQ(rig.ask(Command::none, {{Quantity::target_velocity, -25 * kHertz}}), Errc::ok);
  ASSERT_EQ(rig.ask(Command::none, {{Quantity::target_velocity, 10 * kHertz}}), Errc::ok);
  rig.stage.run(1s);
  EXPECT_EQ(rig.motor().speed(), 1000);
  EXPECT_EQ(rig.axis()[Quantity::velocity_actual].value, 10 * kHertz);
  ASSERT_EQ(rig.run(-30), Errc::ok);
  ASSERT_EQ(rig.ask(Command::none, {{Quantity::target_velocity, 0}}), Errc::ok);
  ASSERT_EQ(rig.ask(Command::none, {{Quantity::target_velocity, -5 * kHertz}}), Errc::ok);
  EXPECT_THAT(rig.motor().demands(), ElementsAre(0, -2000, -2500, 0, 1000, 0, -3000, 0, -500));
}

TEST_P(WithADirection, AStopOnItsWayEndsInAStop) {
  InverterRig rig(GetParam());
  ASSERT_EQ(rig.run(20), Errc::ok);
  rig.stage.run(1s);
  auto reversal = rig.stage.begin(1, with_command(Command::none, {{Quantity::target_velocity, -20 * kHertz}}));
  rig.stage.run(12ms);  // somewhere between its writes
  ASSERT_EQ(rig.ask(Command::quick_stop), Errc::ok);
  EXPECT_FALSE(rig.motor().runs());
  EXPECT_EQ(rig.motor().speed(), 0);
  EXPECT_NE(rig.run(20), Errc::ok) << "latched";
  ASSERT_EQ(rig.ask(Command::enable), Errc::ok);
  EXPECT_FALSE(rig.motor().runs());
  ASSERT_EQ(rig.run(5), Errc::ok);
  rig.stage.run(1s);
  EXPECT_EQ(rig.motor().speed(), 500);
}

TEST_P(WithADirection, EachStartIsToldEvenWhereTheDriveHoldsItsWord) {
  InverterRig rig(GetParam());
  ASSERT_EQ(rig.run(20), Errc::ok);
  rig.stage.run(1s);
  rig.motor().stop_at_panel();
  ASSERT_TRUE(rig.stage.run_until([&] { return !rig.axis().has(AxisInput::moving); }));
  ASSERT_EQ(rig.run(20), Errc::ok);
  rig.stage.run(1s);
  EXPECT_EQ(rig.motor().speed(), 2000);
}

TEST(ADirection, OfAnInvertedAxisIsTheOther) {
  InverterRig rig("inverter", true);
  ASSERT_EQ(rig.run(20), Errc::ok);
  rig.stage.run(1s);
  EXPECT_EQ(rig.motor().speed(), -2000);
  EXPECT_EQ(rig.axis()[Quantity::velocity_actual].value, 20 * kHertz);
  EXPECT_THAT(rig.motor().demands(), ElementsAre(0, -2000));
}

TEST(ADirection, BeyondTheMagnitudeIsRefused) {
  InverterRig rig("inverter");
  EXPECT_EQ(rig.run(-401), Errc::bad_value) << "400 Hz is its highest";
  EXPECT_FALSE(rig.motor().runs());
}

class DirectDataRig {
 public:
  DirectDataRig() : stage({line_of(simulated::DirectDataOptions{}, "direct-data")}) {
    expect(stage.come_online(), "never online");
  }

  GatewayStage stage;

  [[nodiscard]] DirectData& motor() {
    stage.rtu_link(0).advance_drives();
    return dynamic_cast<DirectData&>(stage.rtu_link(0).line().slave(0));
  }
  Errc ask(Command command, std::initializer_list<Setpoint> with = {}) {
    return stage.ask(1, with_command(command, with)).outcome.code;
  }
  bool completed() {
    const AxisImage& axis = stage.axis(1);
    return stage.run_until([&] { return axis.motion_state != MotionState::active; }, 60s) &&
           axis.motion_state == MotionState::completed;
  }
};

// The simulated drive goes by what came in the request of the trigger alone.
TEST(DirectDataOperation, AWholeMotionGoesInOneRequest) {
  DirectDataRig rig;
  ASSERT_EQ(rig.ask(Command::none, {{Quantity::profile_velocity, 120'000},
                                    {Quantity::profile_acceleration, 100'000},
                                    {Quantity::profile_deceleration, 100'000},
                                    {Quantity::max_torque, 500}}),
            Errc::ok);
  ASSERT_EQ(rig.ask(Command::enable), Errc::ok);
  for (const std::int64_t place : {25'000, -5'000}) {
    ASSERT_EQ(rig.ask(Command::move_absolute, {{Quantity::target_position, place}}), Errc::ok);
    EXPECT_TRUE(rig.completed());
    EXPECT_EQ(rig.motor().place(), place / 10);
    EXPECT_TRUE(rig.stage.run_until([&] { return rig.stage.axis(1)[Quantity::position_actual].value == place; }));
  }
  EXPECT_EQ(rig.motor().starts(), 2U);
  EXPECT_EQ(rig.motor().writes(DirectData::trigger + 1), 2U);
  EXPECT_EQ(rig.motor().writes(DirectData::way + 1), 2U) << "also what the drive holds already";
}

TEST(DirectDataOperation, AQuickStopEndsItAndOfAnAnswerThatIsLostNothingIsRepeated) {
  DirectDataRig rig;
  ASSERT_EQ(rig.ask(Command::none, {{Quantity::profile_velocity, 60'000},
                                    {Quantity::profile_acceleration, 100'000},
                                    {Quantity::profile_deceleration, 100'000}}),
            Errc::ok);
  ASSERT_EQ(rig.ask(Command::enable), Errc::ok);
  ASSERT_EQ(rig.ask(Command::move_absolute, {{Quantity::target_position, 100'000}}), Errc::ok);
  rig.stage.run(1s);
  EXPECT_TRUE(rig.motor().moves());
  ASSERT_EQ(rig.ask(Command::quick_stop), Errc::ok);
  EXPECT_FALSE(rig.motor().moves());
  EXPECT_LT(rig.motor().place(), 2'000);
  ASSERT_EQ(rig.ask(Command::enable), Errc::ok);
  auto move = rig.stage.begin(1, with_command(Command::move_absolute, {{Quantity::target_position, 50'000}}));
  const std::uint64_t before = rig.motor().starts();
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.motor().starts() > before; }));
  rig.stage.rtu_link(0).line().cut();
  ASSERT_TRUE(rig.stage.run_until([&] { return move->has_value(); }));
  EXPECT_EQ((*move)->outcome.code, Errc::timed_out);
  rig.stage.run(2s);
  EXPECT_EQ(rig.motor().starts(), before + 1);
}

}  // namespace
}  // namespace axisgate::test
