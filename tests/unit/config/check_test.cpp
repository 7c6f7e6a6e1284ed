// SPDX-License-Identifier: Apache-2.0
#include "gateway/check/check.hpp"

#include <gmock/gmock.h>

namespace axisgate::config {
namespace {

using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// One Kinco-like drive with one axis that has a position, read in class fast.
LoadedConfig one_axis() {
  LoadedConfig loaded;
  loaded.config.file = "gateway.json";
  BusConfig bus;
  bus.name = "lift-serial";
  bus.adapter = "kinco-serial";
  bus.device = "/dev/ttyUSB0";
  bus.timeout = milliseconds(100);
  DriveConfig drive;
  AxisConfig axis;
  axis.number = 7;
  axis.name = "lift";
  drive.axes.push_back(axis);
  bus.drives.push_back(drive);
  loaded.config.buses.push_back(bus);

  model::DriveModel model;
  model.title = "Kinco JD";
  model.protocol = "kinco-serial";
  model.objects.push_back({});
  model::AxisModel axis_model;
  axis_model.binding_of.fill(-1);
  axis_model.statusword = 0;
  axis_model.state_sources = {0};
  axis_model.supported = bit(Quantity::statusword) | bit(Quantity::position_actual);
  axis_model.supported_commands = 1U << static_cast<unsigned>(Command::enable);
  model.axes.push_back(axis_model);
  loaded.models.push_back({model});
  return loaded;
}

TEST(Check, SaysThatTheFileIsValidAndPlansEachBus) {
  const check::CheckReport report = check::report(one_axis());
  EXPECT_THAT(report.text, HasSubstr("gateway.json is valid.\n"));
  EXPECT_THAT(report.text, HasSubstr("Bus lift-serial: kinco-serial on /dev/ttyUSB0, 38400 baud\n"));
  EXPECT_THAT(report.text, HasSubstr("fast 1 each 20 ms"));
  EXPECT_THAT(report.text,
              HasSubstr("planned load    51.1 % with drives that answer after 5 ms, 26.1 % on the wire alone"));
  EXPECT_THAT(report.text, HasSubstr("stop waits      at most 10.2 ms; beside an unresponsive drive at most 100.0 ms"));
  EXPECT_FALSE(report.overloaded);
}

TEST(Check, SaysHowFarFloatsTellUnitsApart) {
  LoadedConfig loaded = one_axis();
  loaded.config.modbus_tcp.resize(2);
  EXPECT_THAT(check::report(loaded).text, Not(HasSubstr("float")));
  loaded.config.modbus_tcp[1].float_numbers = true;
  EXPECT_THAT(check::report(loaded).text, HasSubstr("each unit has its own number up to ±1024 turns\n"));
  loaded.config.buses[0].drives[0].axes[0].units_per_rev = Rational(65536);
  EXPECT_THAT(check::report(loaded).text, HasSubstr("up to ±256 turns\n"));
}

TEST(Check, SaysWhereADrivesNumbersWereNeverTried) {
  LoadedConfig loaded = one_axis();
  EXPECT_THAT(check::report(loaded).text, Not(HasSubstr("never tried")));
  loaded.models[0][0].profile = "acme-servo";
  loaded.models[0][0].only_simulated = true;
  EXPECT_THAT(
      check::report(loaded).text,
      HasSubstr("profile         acme-servo: numbers from an EDS or a public list, never tried on the real drive\n"));
}

TEST(Check, NamesWhatAnAxisDoesNotHave) {
  const std::string text = check::report(one_axis()).text;
  EXPECT_THAT(text, HasSubstr("quantities: mode_display, velocity_actual, torque_actual"));
  EXPECT_THAT(text, HasSubstr("commands: disable, quick_stop, halt"));
}

TEST(Check, GivesUnitsAndRangeInTurns) {
  LoadedConfig loaded = one_axis();
  EXPECT_THAT(check::report(loaded).text, HasSubstr("10000 per motor turn; in turns, a register reaches ±214748.4"));
  AxisConfig& axis = loaded.config.buses[0].drives[0].axes[0];
  axis.units_per_rev = Rational(60000, 37);
  axis.limits.position = Range{-60000, 120000};
  EXPECT_THAT(check::report(loaded).text, HasSubstr("60000/37 per motor turn"));
  EXPECT_THAT(check::report(loaded).text, HasSubstr("-60000 to 120000 (-37.00 to 74.00 turns)"));
}

TEST(Check, AnOverloadedBusIsNamedWithPeriodsThatFit) {
  LoadedConfig loaded = one_axis();
  loaded.config.buses.push_back(loaded.config.buses[0]);
  loaded.models.push_back(loaded.models[0]);
  loaded.config.buses[0].poll[0] = milliseconds(5);
  const check::CheckReport report = check::report(loaded);
  EXPECT_TRUE(report.overloaded);
  EXPECT_THAT(report.text, HasSubstr("OVERLOADED"));
  EXPECT_THAT(report.text, HasSubstr("\"poll\": {\"fast\": 20,"));
}

TEST(Check, WarnsOfATimeoutThatNoAnswerCanKeep) {
  LoadedConfig loaded = one_axis();
  BusConfig& bus = loaded.config.buses[0];
  const Duration needed = plan_bus(timing_of(bus), loaded.models[0]).exchange;
  bus.timeout = needed;
  EXPECT_THAT(check::report(loaded).text, Not(HasSubstr("timeout_ms of")));
  bus.timeout = milliseconds(5);
  EXPECT_THAT(check::report(loaded).text,
              HasSubstr("warning: bus lift-serial: a timeout_ms of 5 is shorter than the longest request, which takes "
                        "10.2 ms with a drive that answers after 5 ms: its drives will be taken for unresponsive; "
                        "write at least 11\n"));
}

TEST(Check, WarnsOfLimitsThatLimitNothing) {
  LoadedConfig loaded = one_axis();
  AxisConfig& axis = loaded.config.buses[0].drives[0].axes[0];
  axis.pointer = "/buses/0/drives/0/axes/0";
  axis.limits.velocity = 600'000;
  model::AxisModel& model = loaded.models[0][0].axes[0];
  model.supported |= bit(Quantity::target_velocity);
  model.writable |= bit(Quantity::target_velocity);
  EXPECT_THAT(check::report(loaded).text, Not(HasSubstr("warning: gateway.json: ")));
  axis.limits.quick_stop_deceleration_min = 1000;
  axis.limits.torque = 500;
  EXPECT_THAT(check::report(loaded).text,
              AllOf(HasSubstr("warning: gateway.json: /buses/0/drives/0/axes/0/limits/quick_stop_deceleration_min: "
                              "limits nothing, for Kinco JD has no quick_stop_deceleration that can be written on "
                              "kinco-serial: take it out\n"),
                    HasSubstr("/limits/torque: limits nothing, for Kinco JD has no target_torque, max_torque that"),
                    Not(HasSubstr("/limits/velocity: "))));
}

TEST(Check, PrintsTheLimitsInRpmAndTurnsAndWarnsWhereThereAreNone) {
  LoadedConfig loaded = one_axis();
  AxisConfig& axis = loaded.config.buses[0].drives[0].axes[0];
  model::AxisModel& model = loaded.models[0][0].axes[0];
  const std::uint32_t targets = bit(Quantity::target_velocity) | bit(Quantity::target_position);
  EXPECT_THAT(check::report(loaded).text, Not(HasSubstr("limit of"))) << "nothing can be asked for";
  model.supported |= targets;
  model.writable |= targets;
  EXPECT_THAT(check::report(loaded).text, AllOf(HasSubstr("limits          velocity NONE; position NONE\n"),
                                                HasSubstr("warning: no limit of velocity: axis 7: "),
                                                HasSubstr("warning: no limit of position: axis 7: ")));
  axis.limits.velocity = 600'000;
  axis.limits.position = Range{-5000, 125'000};
  axis.limits.acceleration = 6000;
  axis.limits.torque = 505;
  EXPECT_THAT(check::report(loaded).text,
              AllOf(HasSubstr("limits          velocity 600 rpm; position -5000 to 125000 (-0.50 to 12.50 "
                              "turns); acceleration 600 rpm/s; torque 50.5 %\n"),
                    Not(HasSubstr("no limit of"))));
}

TEST(Check, WarnsOfAVelocityThatWasMeantInRpm) {
  LoadedConfig loaded = one_axis();
  AxisConfig& axis = loaded.config.buses[0].drives[0].axes[0];
  axis.pointer = "/buses/0/drives/0/axes/0";
  model::AxisModel& model = loaded.models[0][0].axes[0];
  model.supported |= bit(Quantity::target_velocity);
  model.writable |= bit(Quantity::target_velocity);
  axis.limits.velocity = 3000;
  EXPECT_THAT(check::report(loaded).text,
              HasSubstr("warning: gateway.json: /buses/0/drives/0/axes/0/limits/velocity: 3000 is 3 rpm: its "
                        "unit is 0.001 rpm, 3000000 would be 3000 rpm\n"));
  axis.limits.velocity = 10'000;
  EXPECT_THAT(check::report(loaded).text, Not(HasSubstr("its unit is")));
  model.rated_speed = 3'000'000;
  EXPECT_THAT(check::report(loaded).text, HasSubstr("10000 is 10 rpm, 0.33 % of the rated speed of 3000 rpm"));
  axis.limits.velocity = 30'000;
  EXPECT_THAT(check::report(loaded).text, Not(HasSubstr("its unit is")));
}

TEST(Check, WarnsOfLimitsThatLookLikeAnotherUnitAndOfNoOthers) {
  LoadedConfig loaded = one_axis();
  AxisConfig& axis = loaded.config.buses[0].drives[0].axes[0];
  model::AxisModel& model = loaded.models[0][0].axes[0];
  const auto warned = [&](const std::string& words) {
    const std::string text = check::report(loaded).text;
    return words.empty() ? text.find("its unit is") == std::string::npos : text.find(words) != std::string::npos;
  };
  axis.limits.velocity = 100'000'000;
  EXPECT_TRUE(warned(""));
  axis.limits.velocity = 120'000'000;
  EXPECT_TRUE(warned("/limits/velocity: 120000000 is 120000 rpm, faster than motors turn: its unit is 0.001 rpm"));
  model.rated_speed = 3'000'000;
  axis.limits.velocity = 31'000'000;
  EXPECT_TRUE(warned("31000000 is 31000 rpm, 10 times the rated speed of 3000 rpm: its unit is"));
  axis.limits.velocity = 30'000'000;
  EXPECT_TRUE(warned(""));
  axis.limits.position = Range{0, 499};
  EXPECT_TRUE(warned("/limits/position: 0 to 499 is 0.05 of a turn of the motor: its unit is 1/10000 turn"));
  axis.limits.position = Range{0, 500};
  EXPECT_TRUE(warned(""));
  axis.limits.torque = 9;
  EXPECT_TRUE(warned("/limits/torque: 9 is 0.9 % of the rated torque: its unit is 0.1 %, 1000 is the rated torque"));
  axis.limits.torque = 10;
  EXPECT_TRUE(warned(""));
  axis.limits.velocity = 3'000'000;
  axis.limits.acceleration = 499;
  EXPECT_TRUE(
      warned("/limits/acceleration: 499 is 49.9 rpm/s: the limit of velocity is reached after 60 s; its unit is"));
  axis.limits.acceleration = 500;
  EXPECT_TRUE(warned(""));
}

TEST(Check, WarnsWhereNothingTellsHowHardTheMotorWorks) {
  LoadedConfig loaded = one_axis();
  DriveConfig& drive = loaded.config.buses[0].drives[0];
  drive.pointer = "/buses/0/drives/0";
  loaded.config.read = {{"gateway.json", "{\n\"buses\": []}"}};
  constexpr const char* kWarning =
      "warning: gateway.json:2:1: /buses/0/drives/0/constants: \"peak_current_a\" is not given";
  EXPECT_THAT(check::report(loaded).text, Not(HasSubstr("not given"))) << "the profile wants none";
  drive.wanted = {{"rated_speed_rpm", "of the plate", {Quantity::target_velocity}}};
  EXPECT_THAT(check::report(loaded).text, AllOf(HasSubstr("not given       rated_speed_rpm, for target_velocity\n"),
                                                Not(HasSubstr("is not given"))));
  drive.wanted.push_back(
      {"peak_current_a", "peak current of the drive", {Quantity::current_actual, Quantity::torque_actual}});
  EXPECT_THAT(check::report(loaded).text,
              HasSubstr(std::string(kWarning) + ", and so nothing tells how hard the motor works, neither current nor "
                                                "torque: peak current of the drive\n"));
  drive.wanted.push_back({"rated_current_a", "of the motor", {Quantity::torque_actual}});
  EXPECT_THAT(check::report(loaded).text, Not(HasSubstr("\"rated_current_a\" is not given")))
      << "the other one is enough";
  loaded.models[0][0].axes[0].supported |= bit(Quantity::torque_actual);
  EXPECT_THAT(check::report(loaded).text, Not(HasSubstr("is not given")));
}

TEST(Check, GivesTheLimitOfVelocityInMetresWhereThoseAreKnown) {
  LoadedConfig loaded = one_axis();
  AxisConfig& axis = loaded.config.buses[0].drives[0].axes[0];
  axis.limits.velocity = 3'000'000;
  EXPECT_THAT(check::report(loaded).text, HasSubstr("velocity 3000 rpm\n"));
  axis.metres_per_rev = Rational(1, 4000);
  EXPECT_THAT(check::report(loaded).text, HasSubstr("velocity 3000 rpm (0.0125 m/s)\n"));
}

/// What a limit of the velocity does not reach: by this command, whose speed nobody can write.
void expect_warning_of_own_speed(Command command, Quantity speed, const std::string& motion, const std::string& name) {
  LoadedConfig loaded = one_axis();
  model::AxisModel& model = loaded.models[0][0].axes[0];
  model.supported |= bit(Quantity::target_velocity) | bit(speed);
  model.writable |= bit(Quantity::target_velocity);
  model.supported_commands |= 1U << static_cast<unsigned>(command);
  EXPECT_THAT(check::report(loaded).text, Not(HasSubstr("does not reach " + motion)));
  loaded.config.buses[0].drives[0].axes[0].limits.velocity = 600'000;
  EXPECT_THAT(check::report(loaded).text,
              HasSubstr("/limits/velocity: does not reach " + motion + ": of Kinco JD no " + name +
                        " is known that could be written; set a safe one in the drive itself\n"));
  model.writable |= bit(speed);
  EXPECT_THAT(check::report(loaded).text, Not(HasSubstr("does not reach " + motion)));
}

TEST(Check, WarnsOfHomingThatNoLimitReaches) {
  expect_warning_of_own_speed(Command::home, Quantity::homing_speed_zero, "homing", "homing speed");
}

TEST(Check, WarnsOfMovesThatNoLimitReaches) {
  expect_warning_of_own_speed(Command::move_absolute, Quantity::profile_velocity, "moves", "profile_velocity");
}

TEST(Check, SaysWhatIsWatchedAndWhereNothingCanBe) {
  LoadedConfig loaded = one_axis();
  model::AxisModel& model = loaded.models[0][0].axes[0];
  const auto binds = [&](Quantity quantity) {
    model.binding_of[static_cast<std::size_t>(quantity)] = static_cast<std::int16_t>(model.bindings.size());
    model.bindings.emplace_back().quantity = quantity;
  };
  EXPECT_THAT(check::report(loaded).text,
              HasSubstr("watch           NONE: the drive tells neither position nor velocity\n"));
  binds(Quantity::velocity_actual);
  EXPECT_THAT(check::report(loaded).text,
              HasSubstr("watch           unexpected above 10 rpm, 1000 ms after a motion: alarm; "
                        "against a stop or a disable that stop once more\n"));
  binds(Quantity::position_actual);
  model.watch.reaction = model::WatchReaction::stop;
  EXPECT_THAT(check::report(loaded).text,
              AllOf(HasSubstr("unexpected above 0.1 turns of the motor, 1000 ms after a motion: "
                              "alarm and quick stop; against"),
                    Not(HasSubstr("(units off)"))));
  model.watch.reaction = model::WatchReaction::off;
  model.watch.units = false;
  EXPECT_THAT(check::report(loaded).text,
              AllOf(HasSubstr("a motion: against a stop or a disable alone: alarm, and that"),
                    HasSubstr("velocity is not held against position (units off)\n")));
  model.position_commanded = true;
  EXPECT_THAT(check::report(loaded).text,
              HasSubstr("watch           NONE: its position is only what the drive has commanded"));
}

TEST(Check, RepeatsTheWarnings) {
  LoadedConfig loaded = one_axis();
  loaded.warnings.push_back("gateway.json: /modbus_tcp/0/listen: everybody may read");
  EXPECT_THAT(check::report(loaded).text,
              HasSubstr("warning: gateway.json: /modbus_tcp/0/listen: everybody may read\n"));
}

}  // namespace
}  // namespace axisgate::config
