// SPDX-License-Identifier: Apache-2.0
// What log and events say of who asked for what, what was refused and why, and how leases and faults end. A line is
// told once, and no client can fill the log.
#include <gtest/gtest.h>

#include <algorithm>

#include "gateway/core/line_bucket.hpp"
#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kFaultReset = 5;

class Told : public testing::TestWithParam<Subject> {
 protected:
  void with(const PlantOptions& options) {
    plant_.emplace(GetParam(), options);
    plant_->ready();
    plant_->stage.log().clear();
  }
  /// Lines that have all of these in them.
  [[nodiscard]] std::vector<std::string> lines(std::initializer_list<std::string> parts) {
    std::vector<std::string> out;
    for (const std::string& line : plant_->stage.log())
      if (std::ranges::all_of(parts, [&](const std::string& part) { return line.find(part) != line.npos; }))
        out.push_back(line);
    return out;
  }
  [[nodiscard]] std::string log() {
    std::string out;
    for (const std::string& line : plant_->stage.log()) out += line + '\n';
    return out;
  }
  /// A client's name in the log; it owns the axis.
  [[nodiscard]] std::string owner() { return plant_->stage.axis(1).lease.owner->name; }
  std::optional<Plant> plant_;
};

TEST_P(Told, EachCommandOnceWithWhoAndWithItsTarget) {
  with(with_leases());
  Client& a = plant_->a;
  ASSERT_TRUE(plant_->set_endless(a).ok());
  ASSERT_TRUE(a.command(plant_->endless_command()).ok());
  const std::string start =
      has_speeds(GetParam()) ? "run_velocity, target_velocity " : "move_absolute, target_position ";
  EXPECT_EQ(lines({"info axis 1: " + owner() + ": " + start}).size(), 1U) << log();
  ASSERT_TRUE(a.command(3).ok());
  EXPECT_EQ(lines({"axis 1: " + owner() + ": quick_stop"}).size(), 1U) << log();
  EXPECT_EQ(lines({"192.168"}).size(), lines({owner()}).size()) << "nobody else has asked for anything\n" << log();
  std::size_t events = 0;
  for (const Event& event : plant_->stage.gateway().events().events())
    events += event.kind == EventKind::command && event.text == owner() + ": quick_stop" && event.code == 3;
  EXPECT_EQ(events, 1U);
}

TEST_P(Told, TheTargetThatWasWrittenBeforeStandsBesideTheStart) {
  with({});
  const bool moves = has_positions(GetParam());
  plant_->a.row(moves ? row::target_position : row::target_velocity, moves ? kNear : kSpeed);
  plant_->stage.log().clear();
  plant_->a.command(moves ? kMove : kRun);
  EXPECT_EQ(
      lines({moves ? "move_absolute, target_position 20000 (2 rev)" : "run_velocity, target_velocity 150000 (150 rpm)"})
          .size(),
      1U)
      << log();
}

TEST_P(Told, ARefusalSaysWhoWhatAndWhy) {
  with(with_leases());
  ASSERT_TRUE(plant_->set_endless(plant_->a).ok());
  plant_->stage.log().clear();
  EXPECT_EQ(plant_->b.command(kEnable), kNotNow);
  const auto told = lines({"enable is refused: another client owns the axis"});
  ASSERT_EQ(told.size(), 1U) << log();
  EXPECT_NE(told.front().find("(exception 0x06 server device busy, result 7 not owner); its owner is " + owner()),
            std::string::npos)
      << told.front();
}

TEST_P(Told, AStopOfSomebodyElseSaysWhoStopped) {
  with(with_leases());
  ASSERT_TRUE(plant_->set_endless(plant_->a).ok());
  ASSERT_TRUE(plant_->a.command(plant_->endless_command()).ok());
  ASSERT_TRUE(plant_->b.command(3).ok());
  EXPECT_EQ(lines({"axis 1: stopped by ", ", which does not own the axis: quick_stop"}).size(), 1U) << log();
}

// A controller that follows a curve writes its set-point in each cycle.
TEST_P(Told, ASetPointThatIsRefreshedIsToldWhenItBegins) {
  with({});
  const bool moves = !has_speeds(GetParam());
  const auto stream = [&](int writes) {
    for (int i = 0; i < writes; ++i) {
      plant_->a.row(moves ? row::target_position : row::target_velocity, kSpeed + i);
      plant_->run(20ms);
    }
  };
  stream(200);
  const std::string name = moves ? "target_position " : "target_velocity ";
  EXPECT_EQ(lines({": " + name}).size(), 1U) << log();
  plant_->run(10s);
  stream(5);
  const auto told = lines({": " + name});
  ASSERT_EQ(told.size(), 2U) << log();
  EXPECT_NE(told.back().find("(and 199 more since the last such line)"), std::string::npos) << told.back();
}

TEST_P(Told, NobodyFillsTheLog) {
  with(with_leases());
  ASSERT_TRUE(plant_->set_endless(plant_->a).ok());
  plant_->stage.log().clear();
  const Instant from = plant_->stage.runtime().now();
  for (std::size_t i = 0; i < 200; ++i) {
    plant_->a.command(0);
    plant_->a.command(i % 2 == 0 ? kDisable : kHalt);
    plant_->b.command(0);
    plant_->b.command(std::array{kEnable, kMove, kRun, kFaultReset}.at(i % 4));
    plant_->b.row(90, 1);             // read-only
    plant_->b.row(row::command, 77);  // no command
  }
  // A bucket each for stops, what the axis refuses, and what is wrong with requests; and what else there is to tell.
  const auto bucket = LineBucket::kBurst + (plant_->stage.runtime().now() - from) / LineBucket::kEach + 1;
  constexpr std::int64_t kElse = 20;
  EXPECT_LE(static_cast<std::int64_t>(plant_->stage.log().size()), 3 * bucket + kElse) << log();
  // And what was left out is counted when there is room for a line again.
  plant_->run(1s);
  plant_->stage.log().clear();
  plant_->a.command(kQuickStop);
  EXPECT_EQ(lines({": quick_stop (and ", " more since the last such line)"}).size(), 1U) << log();
}

INSTANTIATE_TEST_SUITE_P(Every, Told, testing::ValuesIn(kSubjects), named);

class LeaseEnd : public testing::TestWithParam<bool> {};

// The advice is none where it stands in the configuration already.
TEST_P(LeaseEnd, SaysWhoseItWasWhatItEndedAndWhatHelpsInThisConfiguration) {
  const bool is_address = GetParam();
  Plant plant(Subject::jd_serial, with_leases(is_address));
  plant.ready();
  ASSERT_TRUE(plant.set_endless(plant.a).ok());
  ASSERT_TRUE(plant.a.command(plant.endless_command()).ok());
  const std::string owner = plant.stage.axis(1).lease.owner->name;
  EXPECT_EQ(owner.find(':') == std::string::npos, is_address) << owner;
  plant.a.disconnect();
  plant.run(4s);
  EXPECT_TRUE(plant.logged("the lease of " + owner + " has run out after its connection" +
                           (is_address ? "s had ended" : " had ended") +
                           ": quick stop, axis in state \"continuous motion\""));
  EXPECT_EQ(plant.logged("\"client\": \"address\""), !is_address);
  EXPECT_EQ(plant.logged("needs a longer \"timeout_ms\" of the lease"), is_address);
}

INSTANTIATE_TEST_SUITE_P(Both, LeaseEnd, testing::Bool(),
                         [](const auto& tested) { return tested.param ? "OfAnAddress" : "OfAConnection"; });

class LeaseSilence : public testing::TestWithParam<LeaseRenewal> {};

TEST_P(LeaseSilence, SaysWhatWouldHaveKeptIt) {
  PlantOptions options = with_leases();
  options.lease->renew = GetParam();
  Plant plant(Subject::leadshine, options);
  plant.ready();
  ASSERT_TRUE(plant.set_endless(plant.a).ok());
  plant.run(6s);
  const std::string missed = GetParam() == LeaseRenewal::any     ? "has asked nothing"
                             : GetParam() == LeaseRenewal::write ? "has written nothing to the axis"
                                                                 : "has shown no heartbeat";
  EXPECT_TRUE(plant.logged("has run out: quick stop, axis in state \"standstill\" (it " + missed + " for 2000 ms)"));
  EXPECT_FALSE(plant.logged("one-shot tools"));
}

INSTANTIATE_TEST_SUITE_P(Every, LeaseSilence,
                         testing::Values(LeaseRenewal::any, LeaseRenewal::write, LeaseRenewal::heartbeat));

class FaultEnd : public testing::TestWithParam<Subject> {};

TEST_P(FaultEnd, SaysHowLongItWasThereAndWhoHasResetIt) {
  Plant plant(GetParam());
  plant.ready();
  plant.trip_drive();
  const auto faulted = [&] { return plant.stage.axis(1).has(AxisInput::fault); };
  ASSERT_TRUE(plant.stage.run_until(faulted, 3s));
  plant.run(5s);
  EXPECT_FALSE(plant.logged("is over after"));
  ASSERT_TRUE(plant.a.command(0).ok());
  ASSERT_TRUE(plant.a.command(kFaultReset).ok());
  ASSERT_TRUE(plant.stage.run_until([&] { return !faulted(); }, 3s));
  EXPECT_TRUE(plant.logged(", reset by 192.168.1.10"));
  EXPECT_TRUE(plant.logged("warning axis 1: fault 0x"));
  EXPECT_TRUE(plant.logged(" is over after 5."));
  // The next one nobody resets: its drive loses its power.
  plant.stage.log().clear();
  plant.trip_drive();
  ASSERT_TRUE(plant.stage.run_until(faulted, 3s));
  plant.restart_drive(10s);
  plant.run(30s);
  ASSERT_TRUE(plant.stage.come_online());
  plant.run(2s);
  ASSERT_FALSE(faulted());
  EXPECT_TRUE(plant.logged(", without a reset by a client"));
  EXPECT_FALSE(plant.logged("reset by 192"));
}

INSTANTIATE_TEST_SUITE_P(Every, FaultEnd, testing::Values(Subject::jd_serial, Subject::md_rtu, Subject::leadshine),
                         named);

TEST(ToldAsAsked, AControlwordAModeAndAnObjectInHexAndInWords) {
  Plant plant(Subject::leadshine);
  plant.ready();
  plant.stage.log().clear();
  ASSERT_TRUE(plant.a.row(row::mode, kVelocityMode).ok());
  EXPECT_TRUE(plant.logged(": mode 3 (profile velocity)"));
  ASSERT_TRUE(plant.a.row(row::controlword, 0x010F).ok());
  EXPECT_TRUE(plant.logged(": controlword 0x010F (enable operation, halt)"));
  ASSERT_TRUE(plant.a.mailbox_write(0x6083, 0, 4, 20'000));
  EXPECT_TRUE(plant.logged(": write of object 0x6083:00 = 0x00004E20"));
  ASSERT_TRUE(plant.a.row(row::controlword, 7).ok());
  EXPECT_TRUE(plant.logged(": controlword 0x0007 (switch on)"));
}

TEST(ToldAsAsked, AJogOnceWithItsSpeedHoweverOftenItsButtonIsWritten) {
  Plant plant(Subject::jd_serial);
  plant.ready();
  ASSERT_TRUE(plant.a.row(58, 60'000).ok());
  ASSERT_TRUE(plant.a.coil(8, false).ok());
  plant.stage.log().clear();
  for (int i = 0; i < 20; ++i) {
    plant.a.coil(8, true);
    plant.run(100ms);
  }
  plant.a.coil(8, false);
  plant.run(1s);
  std::size_t jogs = 0, ends = 0;
  for (const std::string& line : plant.stage.log()) {
    jogs += line.find(": jog_forward, jog_velocity 60000 (60 rpm)") != line.npos;
    ends += line.find(": halt") != line.npos;
  }
  EXPECT_EQ(jogs, 1U);
  EXPECT_EQ(ends, 1U) << "its button was let go";
}

TEST(ToldAtItsTurn, WhatADriveRefusesIsToldWithItsCodeInHexAndInWords) {
  Plant plant(Subject::leadshine);
  plant.ready();
  const std::vector<ObjectPlace> ramps{{0x6083}};
  ASSERT_TRUE(lack(plant.stage, plant.subject, ramps));
  EXPECT_EQ(plant.a.row(50, 12'345), kFailed);
  EXPECT_TRUE(plant.logged(
      "profile_acceleration 12345 (1234.5 rpm/s): refused by the drive (exception 0x04 server device failure, result 3 "
      "refused by drive, detail 0x06020000 no such object)"));
}

}  // namespace
}  // namespace axisgate::test::obey
