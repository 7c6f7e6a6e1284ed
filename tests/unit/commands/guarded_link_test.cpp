// SPDX-License-Identifier: Apache-2.0
// Which frames of a trial leave: while it only reads, and while heartbeats are withheld.
#include "gateway/commands/try/guarded_link.hpp"

#include <gtest/gtest.h>

#include <array>

namespace axisgate::commands {
namespace {

can::CanFrame frame(std::uint32_t id, Byte first) { return can::data_frame(id, std::array<Byte, 8>{first}); }

TEST(GuardedLink, WhileItOnlyReadsNothingButReadRequestsLeave) {
  const LinkGuard guard{.only_reads = true};
  EXPECT_TRUE(may_leave(guard, frame(0x605, Byte{0x40})));   // upload
  EXPECT_TRUE(may_leave(guard, frame(0x605, Byte{0x60})));   // its segments
  EXPECT_TRUE(may_leave(guard, frame(0x605, Byte{0x80})));   // abort
  EXPECT_TRUE(may_leave(guard, frame(0x605, Byte{0xA4})));   // block upload
  EXPECT_FALSE(may_leave(guard, frame(0x605, Byte{0x23})));  // download
  EXPECT_FALSE(may_leave(guard, frame(0x605, Byte{0x00})));  // its segments
  EXPECT_FALSE(may_leave(guard, frame(0x605, Byte{0xC2})));  // block download
  EXPECT_FALSE(may_leave(guard, frame(0x000, Byte{0x01})));  // NMT start
  EXPECT_FALSE(may_leave(guard, frame(0x77F, Byte{0x05})));  // heartbeat
  EXPECT_FALSE(may_leave(guard, can::remote_frame(0x705, 1)));
  EXPECT_TRUE(may_enter(guard, frame(0x585, Byte{0x43})));
  EXPECT_FALSE(may_enter(guard, frame(0x705, Byte{0x7F})));
}

TEST(GuardedLink, WhereItWritesObjectsNothingElseLeaves) {
  const LinkGuard guard{.only_reads = true, .writes_objects = true};
  for (const Byte specifier : std::to_array<Byte>({0x40, 0x23, 0x00, 0xC2, 0x80}))
    EXPECT_TRUE(may_leave(guard, frame(0x605, specifier))) << int{specifier};
  EXPECT_FALSE(may_leave(guard, frame(0x000, Byte{0x01})));  // NMT start
  EXPECT_FALSE(may_leave(guard, frame(0x77F, Byte{0x05})));  // heartbeat
  EXPECT_FALSE(may_leave(guard, frame(0x205, Byte{0x0F})));  // a PDO with a controlword
}

TEST(GuardedLink, WithheldHeartbeatsDoNotLeaveAndStopsDo) {
  const LinkGuard guard{.only_reads = false, .withholds = true};
  EXPECT_FALSE(may_leave(guard, frame(0x77F, Byte{0x05})));
  EXPECT_FALSE(may_leave(guard, can::remote_frame(0x705, 1)));
  EXPECT_TRUE(may_leave(guard, frame(0x605, Byte{0x2B})));
  EXPECT_TRUE(may_leave({.only_reads = false}, frame(0x77F, Byte{0x05})));
}

}  // namespace
}  // namespace axisgate::commands
