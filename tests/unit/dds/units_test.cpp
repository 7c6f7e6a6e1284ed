// SPDX-License-Identifier: Apache-2.0
// Registers and SI: the nearest double one way, the nearest register value the other, and nothing that is wrapped.
#include "gateway/upstream/dds/dds_units.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace axisgate::dds {
namespace {

using testing::Optional;

constexpr double kPi = 3.14159265358979323846;

/// The doubles nearest to the exact products, worked out with 80 decimal digits.
struct Exact {
  std::int64_t units_per_rev, denominator;
  std::optional<Rational> metres_per_rev;
  std::int64_t value;
  double position, velocity, acceleration;
};
// clang-format off
const std::vector<Exact> kExact{
    {10000, 1, std::nullopt, 1, 0x1.496b7c53c5b02p-11, 0x1.b739fb1a5ceaep-14, 0x1.57254c2c98978p-7},
    {10000, 1, std::nullopt, -1, -0x1.496b7c53c5b02p-11, -0x1.b739fb1a5ceaep-14, 0x1.57254c2c98978p-7},
    {10000, 1, std::nullopt, 10000, 0x1.921fb54442d18p+2, 0x1.0c152382d7366p+0, 0x1.a2e1077c7044fp+6},
    {10000, 1, std::nullopt, 12345, 0x1.f06c01f31dc06p+2, 0x1.4af2abf7692aep+0, 0x1.028d96594a298p+7},
    {10000, 1, std::nullopt, 2147483647, 0x1.496b7c5132d93p+20, 0x1.b739fb16ee76ep+17, 0x1.57254c29ea4cep+24},
    {10000, 1, std::nullopt, -2147483647, -0x1.496b7c5132d93p+20, -0x1.b739fb16ee76ep+17, 0x1.57254c29ea4cep+24},
    {10000, 1, std::nullopt, 0, 0x0.0p+0, 0x0.0p+0, 0x0.0p+0},
    {60000, 37, std::nullopt, 1, 0x1.fbdb0a567b6f9p-9, 0x1.b739fb1a5ceaep-14, 0x1.57254c2c98978p-7},
    {60000, 37, std::nullopt, 7, 0x1.bc5fa90bac01ap-6, 0x1.8052bbb7114d8p-11, 0x1.2c40a2a705849p-4},
    {60000, 37, std::nullopt, -99999, -0x1.83758f6595e15p+8, -0x1.4f1990c68f76cp+3, 0x1.05cbf91b2014cp+10},
    {60000, 37, std::nullopt, 2147483647, 0x1.fbdb0a5283b98p+22, 0x1.b739fb16ee76ep+17, 0x1.57254c29ea4cep+24},
    {3600, 7, std::nullopt, 1259886079, 0x1.d5bd3863d8df1p+23, 0x1.01af7b180da4dp+17, 0x1.92a2305595518p+23},
    {3600, 7, std::nullopt, 317054953, 0x1.d8d8a7e6dbe62p+21, 0x1.0363d585f4f92p+15, 0x1.954bfda14ec54p+21},
    {3600, 7, std::nullopt, 1382782103, 0x1.01c7ae5fdf4b6p+24, 0x1.1ad24d35fc4cdp+17, 0x1.b9e898a45a381p+23},
    {3600, 7, std::nullopt, -1801439894, -0x1.4fd3a432eeac2p+24, -0x1.70732c1a9f752p+17, 0x1.1fd9fa74cc938p+24},
    {3600, 7, std::nullopt, -64275777, -0x1.7f6f9835a6fbbp+19, -0x1.a4af191937ef9p+12, 0x1.48a8cb9bb3b33p+19},
    {3600, 7, std::nullopt, 1126212724, 0x1.a3e6682804507p+23, 0x1.ccb0b87dd2ff0p+16, 0x1.67ea10224cd74p+23},
    {3600, 7, std::nullopt, -1023827910, -0x1.7dba033463180p+23, -0x1.a2cf020d97249p+16, 0x1.4731b99a9e149p+23},
    {3600, 7, std::nullopt, -1989331144, -0x1.72da88dcd8fa2p+24, -0x1.96e122979aac1p+17, 0x1.3ddfe30670d66p+24},
    {3600, 7, std::nullopt, -2145543543, -0x1.8ff9975963bdbp+24, -0x1.b6d465af9ac75p+17, 0x1.56d5ef7130ebcp+24},
    {3600, 7, std::nullopt, -1522230840, -0x1.1bc6b617e7b4bp+24, -0x1.3757d205bf4fcp+17, 0x1.e6793828faecap+23},
    {3600, 7, std::nullopt, 699300405, 0x1.04ba9c56c19c0p+23, 0x1.1e0e9131d5e14p+16, 0x1.bef6c2ddde300p+22},
    {3600, 7, std::nullopt, 371447760, 0x1.14fba9f38490cp+22, 0x1.2fe3d6414cb06p+15, 0x1.dad3fec607d3ap+21},
    {10000, 1, Rational(1, 200), 1, 0x1.0c6f7a0b5ed8dp-21, 0x1.65e9f80f29212p-24, 0x1.179ec9cbd821ep-17},
    {10000, 1, Rational(1, 200), -1, -0x1.0c6f7a0b5ed8dp-21, -0x1.65e9f80f29212p-24, 0x1.179ec9cbd821ep-17},
    {10000, 1, Rational(1, 200), 10000, 0x1.47ae147ae147bp-8, 0x1.b4e81b4e81b4fp-11, 0x1.5555555555555p-4},
    {10000, 1, Rational(1, 200), 2147483647, 0x1.0c6f7a0945f9ep+10, 0x1.65e9f80c5d4d3p+7, 0x1.179ec9c9a8e45p+14},
    {60000, 37, Rational(314159, 100000000), 1, 0x1.040598b0f329ap-19, 0x1.c1c47dbc742c5p-25, 0x1.5f61823b3ac2ap-18},
    {60000, 37, Rational(314159, 100000000), -37, -0x1.2ca6788c99282p-14, -0x1.040598b0f329ap-19, 0x1.9648be947bf10p-13},
    {60000, 37, Rational(314159, 100000000), 123456789, 0x1.de595dfb51f31p+7, 0x1.9db51302df177p+2, 0x1.433576da3e4a5p+9},
};
// clang-format on

DdsUnits units_of(const Exact& row) {
  return DdsUnits({1, Rational(row.units_per_rev, row.denominator), row.metres_per_rev});
}

TEST(DdsUnits, AreTheNearestDoubleInRadiansOrMetres) {
  for (const Exact& row : kExact) {
    const DdsUnits units = units_of(row);
    EXPECT_EQ(units.to_si(Quantity::position_actual, row.value), row.position) << row.value;
    EXPECT_EQ(units.to_si(Quantity::velocity_actual, row.value), row.velocity) << row.value;
    EXPECT_EQ(units.to_si(Quantity::profile_acceleration, std::abs(row.value)), row.acceleration) << row.value;
  }
}

TEST(DdsUnits, WhatIsShownAndWrittenBackIsTheSameRegisterValue) {
  for (const Exact& row : kExact) {
    const DdsUnits units = units_of(row);
    EXPECT_THAT(units.to_register(Quantity::target_position, row.position), Optional(row.value));
    EXPECT_THAT(units.to_register(Quantity::target_velocity, row.velocity), Optional(row.value));
    EXPECT_THAT(units.to_register(Quantity::profile_acceleration, row.acceleration), Optional(std::abs(row.value)));
  }
}

TEST(DdsUnits, OfTheOtherKindsAreThoseOfTheIdl) {
  const DdsUnits units;
  EXPECT_EQ(units.to_si(Quantity::torque_actual, -1000), -1000.0) << "0.1 % stays";
  EXPECT_EQ(units.to_si(Quantity::current_actual, 1234), 12.34);
  EXPECT_EQ(units.to_si(Quantity::drive_temperature, 405), 40.5);
  EXPECT_EQ(units.to_si(Quantity::motor_temperature, -1), -0.1);
  EXPECT_EQ(units.to_si(Quantity::dc_voltage, 3251), 325.1);
  EXPECT_THAT(units.to_register(Quantity::target_torque, -12.5), Optional(-13)) << "half away from zero";
  EXPECT_THAT(units.to_register(Quantity::max_torque, 12.5), Optional(13));
  EXPECT_THAT(units.to_register(Quantity::max_torque, 12.4999), Optional(12));
}

TEST(DdsUnits, ATurnIsTwoPiAndASecondHasSixtyOfAMinute) {
  const DdsUnits units;
  EXPECT_DOUBLE_EQ(units.to_si(Quantity::position_actual, 10000), 2 * kPi);
  EXPECT_DOUBLE_EQ(units.to_si(Quantity::velocity_actual, 60'000), 2 * kPi) << "60 rpm";
  EXPECT_DOUBLE_EQ(units.to_si(Quantity::profile_acceleration, 600), 2 * kPi) << "60 rpm/s";
  const DdsUnits metres({1, Rational(10000), Rational(1, 200)});
  EXPECT_EQ(metres.to_si(Quantity::position_actual, 10000), 0.005);
  EXPECT_EQ(metres.to_si(Quantity::velocity_actual, 60'000), 0.005);
}

TEST(DdsUnits, NoValueIsNaN) {
  const DdsUnits units;
  for (const QuantityRow& each : quantity_table())
    EXPECT_TRUE(std::isnan(units.to_si(each.quantity, no_value(each.type)))) << each.name;
}

TEST(DdsUnits, WhatIsNoNumberOrDoesNotFitIsRefusedAndNeverWrapped) {
  const double inf = std::numeric_limits<double>::infinity();
  const DdsUnits units;
  for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), inf, -inf, 1e300, -1e300, 1e18, 4294967296.0})
    for (const Quantity q : {Quantity::target_position, Quantity::target_torque, Quantity::max_torque})
      EXPECT_EQ(units.to_register(q, wrong), std::nullopt) << wrong;
  EXPECT_EQ(units.to_register(Quantity::profile_velocity, -1), std::nullopt) << "a register without sign";
  EXPECT_THAT(units.to_register(Quantity::profile_velocity, -0.0), Optional(0));
  EXPECT_THAT(units.to_register(Quantity::profile_velocity, -1e-9), Optional(0));
}

TEST(DdsUnits, TheEndThatMeansNoValueIsOutsideAndTheLastNumberInside) {
  const DdsUnits units({1, Rational(1), Rational(1)});  // one unit is one metre
  EXPECT_THAT(units.to_register(Quantity::target_position, 2147483647.0), Optional(2147483647));
  EXPECT_EQ(units.to_register(Quantity::target_position, 2147483647.5), std::nullopt);
  EXPECT_THAT(units.to_register(Quantity::target_position, 2147483647.4), Optional(2147483647));
  EXPECT_THAT(units.to_register(Quantity::target_position, -2147483647.0), Optional(-2147483647));
  EXPECT_EQ(units.to_register(Quantity::target_position, -2147483648.0), std::nullopt);
  EXPECT_THAT(units.to_register(Quantity::target_torque, 32767), Optional(32767));
  EXPECT_EQ(units.to_register(Quantity::target_torque, -32768), std::nullopt);
  EXPECT_THAT(units.to_register(Quantity::max_torque, 65534), Optional(65534));
  EXPECT_EQ(units.to_register(Quantity::max_torque, 65535), std::nullopt);
}

TEST(DdsUnits, AHalfIsRoundedAwayFromZero) {
  const DdsUnits units({1, Rational(4), Rational(1)});  // a quarter of a metre
  EXPECT_THAT(units.to_register(Quantity::target_position, 0.125), Optional(1));
  EXPECT_THAT(units.to_register(Quantity::target_position, -0.125), Optional(-1));
  EXPECT_THAT(units.to_register(Quantity::target_position, std::nextafter(0.125, 0)), Optional(0));
  EXPECT_THAT(units.to_register(Quantity::target_position, -0.375), Optional(-2));
  const DdsUnits thirds({1, Rational(3), Rational(4)});
  EXPECT_THAT(thirds.to_register(Quantity::target_position, 2.0), Optional(2)) << "1.5 units";
  EXPECT_THAT(thirds.to_register(Quantity::target_position, std::nextafter(2.0, 0)), Optional(1));
  EXPECT_THAT(thirds.to_register(Quantity::target_position, -2.0), Optional(-2));
}

}  // namespace
}  // namespace axisgate::dds
