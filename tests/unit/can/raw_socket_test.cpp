#include "adapters/can/raw_socket.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>

namespace axisgate::can {
namespace {

using namespace std::chrono_literals;

TEST(FrameAge, is_the_time_since_the_stamp) {
  EXPECT_EQ(frame_age(1000s + 3ms, 1000s), 3ms);
  EXPECT_EQ(frame_age(1000s, 1000s), 0ms);
}

TEST(FrameAge, a_jump_of_the_wall_clock_is_no_age) {
  EXPECT_EQ(frame_age(5000s, 1000s), 100ms);
  EXPECT_EQ(frame_age(1000s, 5000s), 0ms);
}

TEST(InterfaceTrouble, says_what_to_do) {
  EXPECT_EQ(interface_trouble("can0", 500000, ENETDOWN), "can0 is down: ip link set can0 up type can bitrate 500000");
  EXPECT_THAT(interface_trouble("can0", 500000, ENODEV), testing::HasSubstr("can0 does not exist"));
  EXPECT_THAT(interface_trouble("eth0", 500000, EAFNOSUPPORT), testing::HasSubstr("eth0 is no CAN interface"));
  EXPECT_THAT(interface_trouble("can0", 500000, EPERM), testing::HasSubstr("can0: not allowed"));
}

}  // namespace
}  // namespace axisgate::can
