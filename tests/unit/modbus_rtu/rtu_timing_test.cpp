// Times on the line, as the standard and the makers' sheets work them out.
#include "adapters/modbus_rtu/rtu_timing.hpp"

#include <gtest/gtest.h>

namespace axisgate::modbus_rtu {
namespace {

using namespace std::chrono_literals;

static_assert(wire_time(19200, 0, 8, 9) == 8'854'166ns, "iD286pro: a read of two registers takes 8.9 ms at 19200 baud");
static_assert(wire_time(9600, 1, 1, 0) == 1'145'833ns, "a byte with parity has eleven bits");
static_assert(wire_time(115200, 0, 0, 0) == 0ns);
static_assert(gap_time(19200) == 2'005'208ns);
static_assert(gap_time(9600) == 4'010'416ns);
static_assert(gap_time(19201) == 1750us, "fixed above 19200 baud");
static_assert(gap_time(115200) == 1750us);

TEST(RtuTiming, frames_take_longer_the_slower_the_line_and_never_wrap) {
  Duration before{};
  for (const std::uint32_t baud : {3'000'000U, 115'200U, 38'400U, 19'200U, 9'600U, 300U, 50U}) {
    const Duration whole = wire_time(baud, 1, 256, 256);
    EXPECT_GT(whole, before);
    EXPECT_GE(gap_time(baud), kFixedGap);
    before = whole;
  }
  EXPECT_EQ(before, 112'640ms);
}

}  // namespace
}  // namespace axisgate::modbus_rtu
