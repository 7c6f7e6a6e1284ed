#include "adapters/can/can_device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace axisgate::can {
namespace {

using testing::HasSubstr;

TEST(CanDevice, is_an_interface_or_the_path_of_a_serial_adapter) {
  EXPECT_EQ(parse_can_device("can0"), (CanDevice{.lawicel = false, .path = "can0"}));
  EXPECT_EQ(parse_can_device("slcan:/dev/ttyACM0"), (CanDevice{.lawicel = true, .path = "/dev/ttyACM0"}));
}

TEST(CanDevice, a_serial_adapter_may_have_a_rate_of_its_own) {
  EXPECT_EQ(parse_can_device("slcan:/dev/ttyUSB0@3000000"),
            (CanDevice{.lawicel = true, .path = "/dev/ttyUSB0", .baud = 3000000}));
}

TEST(CanDevice, an_at_sign_in_a_path_is_part_of_it) {
  EXPECT_EQ(parse_can_device("slcan:/dev/serial/by-id/usb@x").path, "/dev/serial/by-id/usb@x");
  EXPECT_EQ(parse_can_device("slcan:/dev/usb@").path, "/dev/usb@");
  EXPECT_EQ(parse_can_device("slcan:/dev/usb@99999999999").path, "/dev/usb@99999999999");
}

TEST(CanDevice, good_ones_have_no_mistake) {
  EXPECT_EQ(can_device_mistake("can0", 500000), "");
  EXPECT_EQ(can_device_mistake("fifteen-letters", 33333), "");
  for (const std::uint32_t rate : {10000U, 20000U, 50000U, 100000U, 125000U, 250000U, 500000U, 800000U, 1000000U}) {
    EXPECT_EQ(can_device_mistake("slcan:/dev/ttyACM0", rate), "") << rate;
  }
}

TEST(CanDevice, each_mistake_is_named) {
  EXPECT_THAT(can_device_mistake("", 500000), HasSubstr("missing"));
  EXPECT_THAT(can_device_mistake("sixteen-letters-", 500000), HasSubstr("15 characters"));
  EXPECT_THAT(can_device_mistake("/dev/ttyACM0", 500000), HasSubstr("slcan:PATH"));
  EXPECT_THAT(can_device_mistake("can 0", 500000), HasSubstr("no interface name"));
  EXPECT_THAT(can_device_mistake("slcan:", 500000), HasSubstr("path"));
  EXPECT_THAT(can_device_mistake("slcan:@115200", 500000), HasSubstr("path"));
  EXPECT_THAT(can_device_mistake("slcan:/dev/ttyACM0", 333333), HasSubstr("not 333333"));
  EXPECT_THAT(can_device_mistake("can0", 0), HasSubstr("no bit rate"));
  EXPECT_THAT(can_device_mistake("can0", 1000001), HasSubstr("no bit rate"));
}

}  // namespace
}  // namespace axisgate::can
