// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/view/manual_view.hpp"

#include <gmock/gmock.h>

namespace axisgate::commands {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using What = ManualWrite::What;

std::vector<std::uint16_t> registers() {
  std::vector<std::uint16_t> out(kManualRegisters);
  out[2] = 0xFFFF, out[3] = 0x3CB0;  // -50000
  out[5] = 60000;
  out[18] = 2;
  out[23] = 0b1100;
  out[31] = 1;
  out[91] = 10000, out[93] = 1;
  return out;
}

TEST(ManualView, ShowsTurnsAndRpmInTheUnitsOfTheAxis) {
  const ManualView view = manual_view(registers(), 0b101, {});
  EXPECT_EQ(view.turns, -5.0);
  EXPECT_EQ(view.rpm, 60.0);
  EXPECT_TRUE(view.has(AxisInput::enabled));
  EXPECT_EQ(manual_line(3, view, "to 2 turns"), "axis 3  -5.0000 turns  0.0 rpm  standstill  to 2 turns")
      << "a speed beside a standstill is that of before";
}

TEST(ManualView, AStoppedAxisThatStandsIsLatched) {
  auto stopped = registers();
  stopped[5] = 0;
  stopped[31] = 5;
  const auto state = [&](unsigned inputs) {
    return manual_line(3, manual_view(stopped, static_cast<std::uint16_t>(inputs), {}), "");
  };
  EXPECT_THAT(state(bit(AxisInput::stop_latched)), HasSubstr("0.0 rpm  latched"));
  EXPECT_THAT(state(bit(AxisInput::stop_latched) | bit(AxisInput::moving)), HasSubstr("stopping"));
  EXPECT_THAT(state(0), HasSubstr("stopping")) << "halted";
}

TEST(ManualView, ReadsTheSpeedsThatAreSetOnEveryListener) {
  auto set = registers();
  set[48] = 0x0005, set[49] = 0xB8D8;  // 375000
  set[98] = 1500;
  const ManualView view = manual_view(set, 0, {});
  EXPECT_EQ(view.profile_rpm, Rational(375));
  EXPECT_EQ(view.loss_stop_ms, 1500);
  set[48] = 0x43BB, set[49] = 0x8000;  // 375.0
  EXPECT_EQ(manual_view(set, 0, {WordOrder::high_first, true}).profile_rpm, Rational(375));
  set[48] = set[49] = 0xFFFF;
  EXPECT_EQ(manual_view(set, 0, {}).profile_rpm, std::nullopt);
}

TEST(ManualView, AValueThatIsNotGoodNowIsMarked) {
  auto old = registers();
  old[23] = 0, old[18] = 4;
  EXPECT_EQ(manual_line(3, manual_view(old, 0, {}), ""), "axis 3  -5.0000 turns?  60.0 rpm?  standstill, link offline");
  old[2] = 0x8000, old[3] = 0;
  EXPECT_THAT(manual_line(3, manual_view(old, 0, {}), ""), HasSubstr("axis 3  ? turns  60.0 rpm?"));
}

TEST(ManualView, WritesPositionsInTheUnitsAndTheWordOrderOfTheListener) {
  const ManualWrite target{.what = What::target_position, .number = Rational(5, 2)};
  EXPECT_THAT(manual_request(target, 3, {}, Rational(10000)).value(),
              ElementsAre(0x10, 1, 0x56, 0, 2, 4, 0, 0, 0x61, 0xA8));
  EXPECT_THAT(manual_request(target, 3, {WordOrder::low_first, false}, Rational(10000)).value(),
              ElementsAre(0x10, 1, 0x56, 0, 2, 4, 0x61, 0xA8, 0, 0));
  EXPECT_THAT(manual_request(target, 3, {WordOrder::high_first, true}, Rational(10000)).value(),
              ElementsAre(0x10, 1, 0x56, 0, 2, 4, 0x40, 0x20, 0, 0))
      << "2.5 as IEEE 754";
}

TEST(ManualView, RoundsOnceHalfAwayFromZero) {
  const auto value = [](Rational turns, Rational units) {
    const auto pdu = manual_request({.what = What::target_position, .number = turns}, 0, {}, units).value();
    return static_cast<std::int32_t>(std::uint32_t{load_be16(pdu, 6)} << 16 | load_be16(pdu, 8));
  };
  EXPECT_EQ(value(Rational(1, 2), Rational(3)), 2);
  EXPECT_EQ(value(Rational(-1, 2), Rational(3)), -2);
  EXPECT_EQ(value(Rational(1, 3), Rational(65536, 3)), 7282);
}

TEST(ManualView, ANumberThatItsRegisterCannotHoldIsNoRequest) {
  EXPECT_FALSE(manual_request({.what = What::target_position, .number = Rational(300000)}, 1, {}, Rational(10000)));
  EXPECT_FALSE(
      manual_request({.what = What::target_position, .number = Rational(999999999)}, 1, {}, Rational(4294967295)));
  EXPECT_FALSE(manual_request({.what = What::jog_velocity, .number = Rational(5000000)}, 1, {}, Rational(1)));
  EXPECT_FALSE(manual_request({.what = What::target_position, .number = Rational(-2147483648LL)}, 1, {}, Rational(1)))
      << "the end of the type is no number";
}

TEST(ManualView, AStopIsOneRegisterAloneAndACommandOneWithItsId) {
  EXPECT_THAT(manual_request({.what = What::stop, .command = Command::quick_stop}, 2, {}, Rational(1)).value(),
              ElementsAre(0x06, 0, 254, 0, 3));
  EXPECT_THAT(manual_request({.what = What::command, .command = Command::enable, .id = 7}, 2, {}, Rational(1)).value(),
              ElementsAre(0x10, 0, 254, 0, 2, 4, 0, 1, 0, 7));
  EXPECT_THAT(manual_request({.what = What::coil, .coil = 9, .on = true}, 2, {}, Rational(1)).value(),
              ElementsAre(0x05, 0, 209, 0xFF, 0));
}

TEST(ManualView, AnAnswerOfAnotherShapeIsNone) {
  const std::vector<Byte> exception{0x83, 0x0B}, two{0x03, 4, 0, 1, 0, 2}, inputs{0x02, 2, 0x05, 0x10};
  EXPECT_EQ(exception_in(exception), ModbusException::gateway_target_failed);
  EXPECT_EQ(exception_in(two), ModbusException::none);
  EXPECT_THAT(registers_in(two, 2).value(), ElementsAre(1, 2));
  EXPECT_FALSE(registers_in(two, 3));
  EXPECT_FALSE(registers_in(exception, 2));
  EXPECT_EQ(inputs_in(inputs, 13), 0x1005);
  EXPECT_FALSE(inputs_in(two, 13));
  EXPECT_EQ(identification_in(Bytes()), "");
}

}  // namespace
}  // namespace axisgate::commands
