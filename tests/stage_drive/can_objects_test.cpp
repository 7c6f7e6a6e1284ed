// SPDX-License-Identifier: Apache-2.0
// Objects of CANopen drives by FC 43/13 and mailbox: long ones, refused ones, and what a stop does to one under way.
#include <gmock/gmock.h>

#include "tests/stage_drive/can_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

constexpr simulated::ObjectKey kText{0x2F00, 0};

std::string text_of(const BatchResult& result) {
  return result.object_bytes ? std::string(result.object_bytes->begin(), result.object_bytes->end()) : std::string();
}

WriteBatch reading(std::uint16_t index, std::uint8_t sub = 0, std::uint8_t size = 0) {
  WriteBatch batch;
  batch.client = 7;
  batch.role = Role::engineer;
  batch.object = ObjectRequest{.index = index, .subindex = sub, .size = size};
  return batch;
}

WriteBatch writing(std::uint16_t index, const std::string& text) {
  WriteBatch batch = reading(index);
  batch.object->write = true;
  batch.object->bytes = std::make_shared<const std::vector<Byte>>(text.begin(), text.end());
  return batch;
}

/// A drive with a long text in it.
struct CanObjects : testing::Test {
  explicit CanObjects(bool block = false) : rig(line_with(block)) {
    rig.node().facts().texts[kText] = long_text;
    rig.online();
  }
  static GatewayStage::Line line_with(bool block) {
    simulated::LeadshineOptions options;
    options.block = block;
    return can_line_of({options}, 1);
  }
  const std::string long_text = [] {
    std::string text;
    for (int i = 0; text.size() < 500; ++i) text += std::to_string(i) + ",";
    return text;
  }();
  CanRig rig;
};

TEST_F(CanObjects, ANameLongerThanFourBytesIsReadWhole) {
  const BatchResult result = rig.stage.ask(1, reading(0x1008));
  EXPECT_EQ(result.outcome.code, Errc::ok);
  EXPECT_EQ(text_of(result), "LD2-CAN7010");
  EXPECT_EQ(result.object_size, 0);
}

// It counts its speeds in another width, and otherwise: it moved 6.6 times too fast and too far, and was told done.
TEST(CanProfile, ADriveOfTheOtherTypeInItsPlaceIsNotMoved) {
  GatewayStage::Line line = can_line_of({options_of(Subject::jd_can, 1)}, 1);
  line.can_drives[0].profile = "kinco-md";
  CanRig rig(std::move(line));
  ASSERT_TRUE(rig.settles([&] { return (rig.axis().alarms & bit(AxisAlarm::profile_mismatch)) != 0; }));
  EXPECT_TRUE(rig.told("profile_mismatch: the device refuses velocity_actual"));
  EXPECT_NE(rig.stage.command(1, Command::enable).outcome.code, Errc::ok);
  EXPECT_EQ(rig.stage.command(1, Command::disable).outcome.code, Errc::ok) << "stops apart";
}

// An engineer has given the disabled drive another gear: its numbers for what was accepted are others now.
TEST(CanScale, AStartGoesByTheAcceptedSpeedAlsoWhereTheDriveCountsOtherwiseSince) {
  constexpr std::uint16_t kFeed = 0x6092;
  CanRig rig({Subject::leadshine});
  rig.online();
  ASSERT_EQ(rig.stage.ask(1, setpoints({{Quantity::profile_velocity, 600'000}})).outcome.code, Errc::ok);
  WriteBatch feed = reading(kFeed, 1, 4);
  feed.object->write = true;
  feed.object->data = 1'000;
  ASSERT_EQ(rig.stage.ask(1, feed).outcome.code, Errc::ok);
  rig.stage.run(3s);
  rig.enable();
  rig.mark();
  const WriteBatch move = with_command(Command::move_absolute, {{Quantity::target_position, -30'000}});
  ASSERT_EQ(rig.stage.ask(1, move).outcome.code, Errc::ok);
  const auto writes = rig.writes();
  const auto speed = std::find_if(writes.begin(), writes.end(), [](const auto& w) { return w.index == 0x6081; });
  ASSERT_NE(speed, writes.end());
  EXPECT_EQ(speed->data, 10'000U);
}

TEST_F(CanObjects, AShortOneIsANumberWhateverItsSize) {
  const BatchResult mode = rig.stage.ask(1, reading(0x6061));
  EXPECT_EQ(mode.outcome.code, Errc::ok);
  EXPECT_EQ(mode.object_size, 1);
  const BatchResult vendor = rig.stage.ask(1, reading(0x1018, 1));
  EXPECT_EQ(vendor.object_size, 4);
  EXPECT_EQ(vendor.object_data, 0x4321U);
}

TEST_F(CanObjects, ALongTextIsWrittenAndReadBack) {
  const std::string other(300, 'x');
  EXPECT_EQ(rig.stage.ask(1, writing(kText.index, other)).outcome.code, Errc::ok);
  EXPECT_EQ(text_of(rig.stage.ask(1, reading(kText.index))), other);
}

TEST_F(CanObjects, TheMailboxCannotCarryALongOneAndSaysSo) {
  const BatchResult result = rig.stage.ask(1, reading(kText.index, 0, 4));
  EXPECT_NE(result.outcome.code, Errc::ok);
  EXPECT_EQ(text_of(rig.stage.ask(1, reading(kText.index))), long_text) << "and the next request is served";
}

TEST_F(CanObjects, WhatTheDriveDoesNotHaveIsToldWithItsAbortCode) {
  const BatchResult result = rig.stage.ask(1, reading(0x5FFF));
  EXPECT_EQ(result.outcome.code, Errc::refused_by_drive);
  EXPECT_EQ(result.abort_code, 0x06020000U);
}

TEST_F(CanObjects, TooLongAnObjectIsRefusedAndTheDriveIsTold) {
  rig.node().facts().texts[kText] = std::string(kMaxObjectBytes + 1, 'y');
  const BatchResult result = rig.stage.ask(1, reading(kText.index));
  EXPECT_NE(result.outcome.code, Errc::ok);
  EXPECT_EQ(text_of(rig.stage.ask(1, reading(0x1008))), "LD2-CAN7010");
}

TEST_F(CanObjects, AStopEndsALongReadUnderWayAndIsNotDelayedByIt) {
  rig.enable();
  ASSERT_EQ(rig.stage.write(1, Quantity::target_velocity, 300'000).outcome.code, Errc::ok);
  ASSERT_EQ(rig.stage.command(1, Command::run_velocity).outcome.code, Errc::ok);
  const auto read = rig.stage.begin(1, reading(kText.index));
  rig.stage.run(20ms);
  ASSERT_FALSE(*read) << "it takes seventy exchanges";
  rig.mark();
  EXPECT_EQ(rig.stage.command(1, Command::quick_stop).outcome.code, Errc::ok);
  ASSERT_TRUE(*read);
  EXPECT_EQ((*read)->outcome.code, Errc::busy);
  const auto& sent = rig.stage.can_link(0).sent;
  const auto abort =
      std::ranges::find_if(sent, [](const auto& s) { return s.frame.id == 0x601 && s.frame.data[0] == 0x80; });
  ASSERT_NE(abort, sent.end());
  EXPECT_EQ(load_le(abort->frame.data, 4, 4), 0x08000022U);
  EXPECT_EQ(text_of(rig.stage.ask(1, reading(kText.index))), long_text) << "and it can be had again";
}

TEST_F(CanObjects, ASecondReaderWaitsForTheFirst) {
  const auto first = rig.stage.begin(1, reading(kText.index));
  WriteBatch other = reading(kText.index);
  other.client = 8;
  const auto second = rig.stage.begin(1, other);
  ASSERT_TRUE(rig.settles([&] { return *first && *second; }));
  EXPECT_EQ(text_of(**first), long_text);
  EXPECT_EQ(text_of(**second), long_text);
}

TEST_F(CanObjects, ALongReadThatIsLostHalfwayEndsUnknownAndTheDriveIsToldSo) {
  const auto read = rig.stage.begin(1, reading(kText.index));
  rig.stage.run(20ms);
  rig.line().faults(0).next(simulated::DriveFault::lose, 1);
  ASSERT_TRUE(rig.settles([&] { return read->has_value(); }));
  EXPECT_EQ((*read)->outcome.code, Errc::timed_out);
  ASSERT_TRUE(rig.stage.come_online());
  EXPECT_EQ(text_of(rig.stage.ask(1, reading(kText.index))), long_text);
}

TEST(CanObjectsBetween, ALongReadOfOneDriveLeavesTheWireToTheOther) {
  CanRig rig({Subject::leadshine, Subject::md_can});
  rig.node(0).facts().texts[kText] = std::string(4000, 'z');
  rig.online();
  const auto read = rig.stage.begin(1, reading(kText.index));
  rig.stage.run(50ms);
  ASSERT_FALSE(*read);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(rig.stage.write(2, Quantity::profile_velocity, 100'000 + i).outcome.code, Errc::ok);
    EXPECT_FALSE(*read) << "long before the other's object is through";
  }
  ASSERT_TRUE(rig.settles([&] { return read->has_value(); }));
  EXPECT_EQ((*read)->outcome.code, Errc::ok);
  EXPECT_EQ(text_of(**read).size(), 4000U);
}

}  // namespace
}  // namespace axisgate::test
