// SPDX-License-Identifier: Apache-2.0
// Drives whose SDO server is of a small stack: no sizes, four bytes of everything, aborts that name nothing, answers
// that name another object. They come online, are enabled and moved; but not what counts its motion otherwise.
#include <gmock/gmock.h>

#include "gateway/drive/state/fault_watch.hpp"
#include "tests/stage_drive/can_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::DriveFault;
using simulated::ObjectKey;
using simulated::SdoFault;

constexpr ObjectKey kTemperature{0x5502, 6};
constexpr ObjectKey kVoltageObject{0x6079, 0};
constexpr std::string_view kEmptyAbove = "the bytes above are empty";

void move_to(CanRig& rig, std::int64_t to) {
  rig.enable();
  ASSERT_EQ(rig.stage.write(1, Quantity::profile_velocity, 600'000).outcome.code, Errc::ok);
  ASSERT_EQ(rig.stage.write(1, Quantity::target_position, to).outcome.code, Errc::ok);
  ASSERT_EQ(rig.stage.command(1, Command::move_absolute).outcome.code, Errc::ok);
  ASSERT_TRUE(rig.settles([&] { return rig.axis().motion_state == MotionState::completed; }));
  EXPECT_NEAR(static_cast<double>(rig.axis()[Quantity::position_actual].value), static_cast<double>(to), 20);
}

struct CanSmallStack : testing::TestWithParam<SdoFault> {};
INSTANTIATE_TEST_SUITE_P(Answers, CanSmallStack,
                         testing::Values(SdoFault::unsized, SdoFault::wide, SdoFault::unnamed_abort),
                         [](const auto& type) {
                           std::string name(simulated::name_of(type.param));
                           std::erase(name, '-');
                           return name;
                         });

TEST_P(CanSmallStack, ADriveThatAnswersSoComesOnlineIsEnabledAndMoved) {
  for (const Subject type : {Subject::leadshine, Subject::jd_can}) {
    // Its velocity has two bytes: see WhatCountsItsSpeedsInAnotherWidth.
    if (GetParam() == SdoFault::wide && type == Subject::jd_can) continue;
    CanRig rig({type});
    rig.line().faults(0).sdo.set_rate(GetParam(), 1);
    rig.node().facts().lacks.insert(kVoltageObject);  // an abort in any case
    ASSERT_TRUE(rig.stage.come_online()) << name(type);
    EXPECT_EQ(rig.axis().alarms & bit(AxisAlarm::profile_mismatch), 0U);
    EXPECT_EQ(rig.times_told("suspect"), 0U) << "nothing timed out";
    move_to(rig, 100'000);
  }
}

TEST_P(CanSmallStack, ItsTpdosAreMappedAsTheDriveReadsThemBack) {
  CanRig rig({Subject::leadshine});
  rig.line().faults(0).sdo.set_rate(GetParam(), 1);
  ASSERT_TRUE(rig.stage.come_online());
  ASSERT_TRUE(rig.becomes_operational());
  EXPECT_EQ(rig.times_told("TPDO"), 0U) << "no note of one that does not read back";
  rig.stage.run(3s);
  rig.mark();
  rig.stage.run(1s);
  EXPECT_LT(rig.requests().size(), 20U) << "its values come by themselves";
}

TEST(SmallStackWide, ThatIsToldOnceInABringUp) {
  CanRig rig({Subject::leadshine});
  rig.line().faults(0).sdo.set_rate(SdoFault::wide, 1);
  ASSERT_TRUE(rig.stage.come_online());
  EXPECT_EQ(rig.times_told(kEmptyAbove), 1U);
  rig.stage.run(5s);
  EXPECT_EQ(rig.times_told(kEmptyAbove), 1U);
  rig.line().restart(0, rig.stage.can_link(0).time_of(rig.stage.runtime().now()));
  ASSERT_TRUE(rig.settles([&] { return rig.axis().link_state == LinkState::setup; }));
  ASSERT_TRUE(rig.stage.come_online());
  EXPECT_EQ(rig.times_told(kEmptyAbove), 2U);
}

TEST(SmallStackWide, ASignedNumberBelowZeroIsTheSameWithZerosOrWithItsSignAboveIt) {
  for (const SdoFault fault : {SdoFault::wide, SdoFault::wide_sign}) {
    CanRig rig({Subject::leadshine});
    rig.line().faults(0).sdo.set_rate(fault, 1, kTemperature);
    ASSERT_TRUE(rig.stage.come_online());
    ASSERT_EQ(rig.node().poke(kTemperature, -12, rig.stage.can_link(0).time_of(rig.stage.runtime().now())), 0U);
    EXPECT_TRUE(rig.settles([&] { return rig.axis()[Quantity::drive_temperature].value == -120; })) << name_of(fault);
    EXPECT_TRUE(rig.axis()[Quantity::drive_temperature].valid);
  }
}

// Its bytes above are the number's own, or nobody's.
TEST(SmallStackWide, ANumberWithSomethingElseAboveItIsToldInWidthsAndNotShown) {
  constexpr ObjectKey kErrorObject{0x603F, 0};
  CanRig rig({Subject::leadshine});
  rig.line().faults(0).sdo.set_rate(SdoFault::wide_sign, 1, kErrorObject);
  ASSERT_TRUE(rig.stage.come_online());
  EXPECT_EQ(rig.times_told("not used"), 0U);
  rig.node().facts().sends_emergencies = false;
  rig.stage.leadshine(0).inject_fault(0x8611);
  ASSERT_TRUE(
      rig.settles([&] { return rig.told("error_code: the drive answers 4 bytes, the profile says 2: not used"); }));
  rig.stage.run(drive::kCauseTime);
  EXPECT_TRUE(rig.axis()[Quantity::error_code].valid);
  EXPECT_EQ(rig.axis()[Quantity::error_code].value, 0x1000);
}

// A Kinco MD where the configuration has a JD, or a JD that answers all in four bytes: at standstill its velocity is
// zero, and so are the bytes above it. The numbers of the other's speeds are other numbers.
TEST(SmallStackWide, WhatCountsItsSpeedsInAnotherWidthIsNotMovedThoughTheBytesAboveAreZero) {
  for (const Subject there : {Subject::md_can, Subject::jd_can}) {
    GatewayStage::Line line = can_line_of({options_of(there, 1)}, 1);
    line.can_drives[0].profile = "kinco-jd";
    CanRig rig(std::move(line));
    if (there == Subject::jd_can) rig.line().faults(0).sdo.set_rate(SdoFault::wide, 1);
    ASSERT_TRUE(rig.settles([&] { return (rig.axis().alarms & bit(AxisAlarm::profile_mismatch)) != 0; }));
    EXPECT_TRUE(rig.told("velocity_actual: the drive answers 4 bytes, the profile says 2: not used"));
    EXPECT_NE(rig.stage.command(1, Command::enable).outcome.code, Errc::ok);
  }
}

TEST(SmallStackWide, TheControlwordIsWrittenInTheWidthThatTheProfileHasAndTheDriveTakes) {
  CanRig rig({Subject::leadshine});
  rig.line().faults(0).sdo.set_rate(SdoFault::wide, 1);
  ASSERT_TRUE(rig.stage.come_online());
  rig.mark();
  rig.enable();
  const auto& sent = rig.stage.can_link(0).sent;
  const auto writes = std::ranges::count_if(sent, [](const auto& it) {
    return it.frame.id == 0x601 && it.frame.data[0] == 0x2B && load_le16(it.frame.data, 1) == 0x6040;
  });
  EXPECT_GT(writes, 0);
}

TEST(SmallStackUnsized, TheMailboxAndFortyThreeThirteenTellTheProfilesWidth) {
  CanRig rig({Subject::leadshine});
  rig.line().faults(0).sdo.set_rate(SdoFault::unsized, 1);
  ASSERT_TRUE(rig.stage.come_online());
  const auto read = [&](std::uint16_t index, std::uint8_t sub, std::uint8_t size) {
    WriteBatch batch;
    batch.client = 7;
    batch.role = Role::engineer;
    batch.object = ObjectRequest{.index = index, .subindex = sub, .size = size};
    return rig.stage.ask(1, batch);
  };
  EXPECT_EQ(read(0x6041, 0, 2).object_size, 2);
  EXPECT_EQ(read(0x6041, 0, 0).object_size, 2);
  EXPECT_EQ(read(0x6041, 0, 4).object_size, 2);
  EXPECT_EQ(read(0x1200, 0, 1).object_size, 1) << "one that no profile has: as it was asked for";
  EXPECT_EQ(read(0x1200, 0, 0).object_size, 4);
  EXPECT_EQ(read(0x1018, 1, 0).object_size, 4);
  EXPECT_EQ(read(0x1018, 1, 4).object_data, 0x4321U);
}

TEST(SmallStackOther, AnswersOfAnotherObjectAreToldByBothAndNeverTaken) {
  CanRig rig({Subject::leadshine});
  rig.online();
  rig.line().faults(0).sdo.set_rate(SdoFault::other_object, 1, kVoltageObject);
  rig.stage.run(10s);
  EXPECT_EQ(rig.times_told("node 1 was asked for 6079:00 and answered 6078:00"), 1U);
}

TEST(SmallStackBus, ADriveWithAnotherNumberThanTheConfigurationsIsNamed) {
  GatewayStage::Line line = can_line_of({options_of(Subject::leadshine, 1)}, 1);
  CanRig rig(std::move(line));
  static_cast<void>(rig.line().add(options_of(Subject::leadshine, 5)));
  rig.online();
  rig.line().restart(1, rig.stage.can_link(0).time_of(rig.stage.runtime().now()));
  rig.stage.run(5s);
  EXPECT_EQ(rig.times_told("node 5 is heard on this bus, and no drive of the configuration has this number"), 1U);
}

}  // namespace
}  // namespace axisgate::test
