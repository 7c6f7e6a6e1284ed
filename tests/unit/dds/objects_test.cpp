// SPDX-License-Identifier: Apache-2.0
// Objects of real drives by object_request, with limits, ownership and the drive's own refusals.
#include <gmock/gmock.h>

#include "tests/unit/dds/dds_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

dds::ObjectRequestRecord write(const dds::Guid& writer, std::uint16_t index, std::uint8_t size, std::uint32_t value) {
  return {writer, 0, {}, kServo, 0, true, index, 0, size, value, {}};
}

TEST(DdsObjects, OfAnAxisThatTheSameParticipantCommandsAreItsOwn) {
  DdsRig rig;
  const auto commands = rig.writer(1, 1);
  const auto objects = rig.writer(1, 2);
  const auto strangers = rig.writer(2, 2);
  ASSERT_EQ(rig.ask(commands, 1).result, kDone);
  EXPECT_EQ(rig.ask(write(strangers, 0x6083, 4, 12'345)).result, kNotOwner);
  EXPECT_EQ(rig.ask(write(objects, 0x6083, 4, 12'345)).result, kDone);
  EXPECT_EQ(rig.run_at(commands, 1).result, kDone) << "the axis is still the writer's that commands it";
}

TEST(DdsObjects, WrittenBeforeAnyCommandLeaveTheAxisToTheirParticipantsCommandsAndToNoOthers) {
  DdsRig rig;
  const auto objects = rig.writer(1, 2);
  const auto commands = rig.writer(1, 1);
  const auto strangers = rig.writer(2, 1);
  ASSERT_EQ(rig.ask(write(objects, 0x6083, 4, 12'345)).result, kDone);
  EXPECT_EQ(rig.ask(strangers, 1).result, kNotOwner);
  EXPECT_EQ(rig.ask(commands, 1).result, kDone);
  EXPECT_EQ(rig.ask(write(objects, 0x6083, 4, 23'456)).result, kDone);
  EXPECT_EQ(rig.run_at(commands, 1).result, kDone);
  const auto second = rig.writer(1, 3);
  EXPECT_EQ(rig.run_at(second, 2).result, kNotOwner) << "two that command are two clients";
  rig.run(5s);
  EXPECT_TRUE(rig.turns());
}

TEST(DdsObjects, AreNoBackDoorPastTheLimits) {
  DdsRigOptions options;
  options.position_limits = Range{-20'000, 20'000};
  DdsRig rig(options);
  const auto objects = rig.writer(1, 2);
  EXPECT_EQ(rig.ask(write(objects, 0x607A, 4, 100'000'000)).result, 17);
}

}  // namespace
}  // namespace axisgate::test
