// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/quantity.hpp"

#include <gtest/gtest.h>

namespace axisgate {
namespace {

TEST(Quantities, HaveTheBitsThatTheContractPrints) {
  EXPECT_EQ(bit(Quantity::statusword), 1U << 0);
  EXPECT_EQ(bit(Quantity::vendor_error), 1U << 8);
  EXPECT_EQ(bit(Quantity::digital_inputs), 1U << 9);
  EXPECT_EQ(bit(Quantity::controlword), 1U << 14);
  EXPECT_EQ(bit(Quantity::profile_deceleration), 1U << 22);
  EXPECT_EQ(bit(Quantity::homing_method), 1U << 23);
  EXPECT_EQ(bit(Quantity::max_velocity), 1U << 31);
}

TEST(Quantities, AreFoundByTheirNames) {
  for (const QuantityRow& each : quantity_table()) EXPECT_EQ(quantity_named(each.name), each.quantity) << each.name;
  EXPECT_EQ(quantity_named("speed"), std::nullopt);
}

TEST(Quantities, HaveNoTwoOfOneName) {
  for (const QuantityRow& a : quantity_table())
    for (const QuantityRow& b : quantity_table()) EXPECT_TRUE(a.quantity == b.quantity || a.name != b.name);
}

TEST(RegisterTypes, ShowTheEndOfTheirRangeWhereThereIsNoValue) {
  EXPECT_EQ(no_value(RegisterType::i16), -32768);
  EXPECT_EQ(no_value(RegisterType::u16), 65535);
  EXPECT_EQ(no_value(RegisterType::i32), -2147483648LL);
  EXPECT_EQ(no_value(RegisterType::u32), 4294967295LL);
}

TEST(RegisterTypes, HoldEveryNumberButTheOneThatMeansNone) {
  for (const RegisterType type : {RegisterType::i16, RegisterType::u16, RegisterType::i32, RegisterType::u32}) {
    EXPECT_FALSE(range_of(type).holds(no_value(type)));
    EXPECT_TRUE(range_of(type).holds(0));
  }
  EXPECT_EQ(range_of(RegisterType::i16), (Range{-32767, 32767}));
  EXPECT_EQ(range_of(RegisterType::u16), (Range{0, 65534}));
  EXPECT_EQ(range_of(RegisterType::i32), (Range{-2147483647LL, 2147483647LL}));
  EXPECT_EQ(range_of(RegisterType::u32), (Range{0, 4294967294LL}));
}

TEST(Kinds, HaveTheUnitsOfTheContract) {
  EXPECT_EQ(unit_text(Kind::velocity), "0.001 rpm");
  EXPECT_EQ(unit_text(Kind::acceleration), "0.1 rpm/s");
  EXPECT_EQ(unit_text(Kind::torque), "0.1 %");
  EXPECT_EQ(unit_text(Kind::current), "0.01 A");
  EXPECT_EQ(unit_text(Kind::code), "");
}

}  // namespace
}  // namespace axisgate
