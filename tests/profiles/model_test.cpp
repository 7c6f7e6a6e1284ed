// SPDX-License-Identifier: Apache-2.0
// The model's own arithmetic: numbers of an object, one rounding, conditions.
#include "gateway/model/model.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "gateway/model/real32.hpp"

namespace axisgate::profile {
namespace {

model::ObjectDef object(std::uint8_t size, bool is_signed) {
  model::ObjectDef out;
  out.size = size;
  out.is_signed = is_signed;
  return out;
}

model::Binding scaled(Quantity quantity, Rational raw_per_unit) {
  model::Binding out;
  out.quantity = quantity;
  out.raw_per_unit = raw_per_unit;
  return out;
}

TEST(ObjectDef, TakesOnlyTheLowBytesOfAReplyAndTheirSign) {
  EXPECT_EQ(object(1, true).number(0xFFFFFFFD), -3);
  EXPECT_EQ(object(1, false).number(0xFFFFFFFD), 0xFD);
  EXPECT_EQ(object(2, true).number(0xFFFF8000), -32768);
  EXPECT_EQ(object(2, false).number(0xFFFFD437), 0xD437);
  EXPECT_EQ(object(4, true).number(0xFFFF3CB0), -50000);
  EXPECT_EQ(object(4, false).number(0xFFFFFFFF), 4294967295);
}

TEST(ObjectDef, KnowsItsRange) {
  EXPECT_EQ(object(1, true).range(), (Range{-128, 127}));
  EXPECT_EQ(object(2, false).range(), (Range{0, 65535}));
  EXPECT_EQ(object(4, true).range(), (Range{-2147483648LL, 2147483647LL}));
  EXPECT_EQ(object(4, false).range(), (Range{0, 4294967295LL}));
}

/// The number that an f32 object has for a value.
std::int64_t real(float value) { return model::real_of_bits(std::bit_cast<std::uint32_t>(value)); }

TEST(Real32, IsTheNearestToAFraction) {
  EXPECT_EQ(model::real_of(1, 10), real(0.1F));
  EXPECT_EQ(model::real_of(-1, 3), real(-1.0F / 3.0F));
  EXPECT_EQ(model::real_of(16'777'217, 1), real(16'777'216.0F)) << "half way: the even one";
  EXPECT_EQ(model::real_of(16'777'219, 1), real(16'777'220.0F));
  EXPECT_EQ(model::real_of(Int128{33'554'434} * 1'000'000 + 1, 2'000'000), real(16'777'218.0F))
      << "a little more than half";
  EXPECT_EQ(model::real_of(33'554'431, 1), real(33'554'432.0F)) << "up to the next power";
  EXPECT_EQ(model::real_of(Int128{INT64_MAX} * INT64_MAX, 1), real(0x1p126F));
  EXPECT_EQ(model::real_of(1, INT64_MAX), real(0x1p-63F));
  EXPECT_EQ(model::real_of(0, 7), 0);
  EXPECT_EQ(model::real_of_bits(0x80000000), 0) << "-0 is 0";
  for (const float value : {1.5F, -2.25F, 3.4e38F, -1e-45F})
    EXPECT_EQ(model::bits_of_real(real(value)), std::bit_cast<std::uint32_t>(value));
}

TEST(Real32, IsScaledWithOneRounding) {
  EXPECT_EQ(model::scaled_real(real(0.5F), Rational(1)), 1);
  EXPECT_EQ(model::scaled_real(real(-0.5F), Rational(1)), -1);
  EXPECT_EQ(model::scaled_real(real(0.49999997F), Rational(1)), 0);
  EXPECT_EQ(model::scaled_real(real(123.456F), Rational(1000)), 123'456);
  EXPECT_EQ(model::scaled_real(real(0x1p62F), Rational(1)), std::int64_t{1} << 62);
  EXPECT_EQ(model::scaled_real(real(0x1p63F), Rational(1)), std::nullopt);
  EXPECT_EQ(model::scaled_real(real(3e38F), Rational(1, INT64_MAX)), std::nullopt);
  EXPECT_EQ(model::scaled_real(real(0x1p100F), Rational(-1, std::int64_t{1} << 62)), -(std::int64_t{1} << 38));
  EXPECT_EQ(model::scaled_real(real(1e-45F), Rational(INT64_MAX)), 0);
  for (const std::uint32_t none : {0x7F800000U, 0xFF800000U, 0x7FC00000U})
    EXPECT_EQ(model::scaled_real(model::real_of_bits(none), Rational(1)), std::nullopt);
}

TEST(Binding, OfAReal32NeitherTellsNorWritesWhatIsNoNumberAndKeepsItsLimits) {
  model::ObjectDef f32 = object(4, true);
  f32.is_real = true;
  model::Binding speed = scaled(Quantity::target_velocity, Rational(1, 1000));
  speed.is_real = true;
  speed.limits = {-100'001, 100'001};
  EXPECT_EQ(speed.to_raw(100'000, f32), real(100.0F));
  EXPECT_EQ(speed.to_register(real(-100.0F)), -100'000);
  EXPECT_EQ(speed.to_register(real(0.0015F)), 2);
  for (const std::uint32_t none : {0x7F800000U, 0xFF800000U, 0x7FC00000U}) {
    EXPECT_EQ(speed.to_register(f32.number(none)), std::nullopt);
    EXPECT_EQ(speed.to_register_or_bound(f32.number(none)), std::nullopt);
  }
  EXPECT_EQ(speed.to_register(real(3e6F)), std::nullopt) << "more than its register can show";
  EXPECT_EQ(speed.to_register_or_bound(real(-3e6F)), range_of(RegisterType::i32).min);
  model::Binding fine = scaled(Quantity::target_velocity, Rational(1, 3));
  fine.is_real = true;
  fine.limits = {-1'000'000'001, 1'000'000'001};
  const auto raw = fine.to_raw(1'000'000'001, f32);
  ASSERT_TRUE(raw);
  EXPECT_LE(fine.to_register(*raw), 1'000'000'001) << "the nearest one is beyond it";
}

TEST(Binding, RoundsHalfAwayFromZeroOnceAtTheEnd) {
  const model::Binding half = scaled(Quantity::target_velocity, Rational(1, 2));
  EXPECT_EQ(half.to_raw(1, object(4, true)), 1);
  EXPECT_EQ(half.to_raw(-1, object(4, true)), -1);
  EXPECT_EQ(half.to_raw(3, object(4, true)), 2);
  EXPECT_EQ(half.to_register(-3), -6);
  const model::Binding two = scaled(Quantity::velocity_actual, Rational(2));
  EXPECT_EQ(two.to_register(1), 1);
  EXPECT_EQ(two.to_register(-1), -1);
  EXPECT_EQ(two.to_register(-3), -2);
}

// A limit of 900 was 1200 for a drive that counts in 600.
TEST(Binding, RoundsNothingFromWithinTheLimitsToBeyondThem) {
  model::Binding speed = scaled(Quantity::profile_velocity, Rational(1, 600));
  speed.limits = {0, 900};
  EXPECT_EQ(speed.to_raw(900, object(2, true)), 1);
  EXPECT_EQ(speed.to_raw(300, object(2, true)), 1);
  EXPECT_EQ(speed.to_raw(299, object(2, true)), 0);
  model::Binding position = scaled(Quantity::target_position, Rational(-1, 1'000));
  position.limits = {-1'500, 1'500};
  EXPECT_EQ(position.to_raw(1'500, object(4, true)), -1);
  EXPECT_EQ(position.to_raw(-1'500, object(4, true)), 1);
  position.limits = {1'400, 9'000};
  EXPECT_EQ(position.to_raw(1'400, object(4, true)), -2);
  EXPECT_EQ(position.to_raw(9'400, object(4, true)), -9) << "beyond them it is refused elsewhere";
}

TEST(Binding, GivesTheBoundOfARegisterThatCannotShowIt) {
  const model::Binding position = scaled(Quantity::position_actual, Rational(-1, 1'000));
  EXPECT_EQ(position.to_register_or_bound(-3'000'000), 2'147'483'647);
  EXPECT_EQ(position.to_register_or_bound(3'000'000), -2'147'483'647);
  EXPECT_EQ(position.to_register_or_bound(3), -3'000);
  const model::Binding huge = scaled(Quantity::position_actual, Rational(1, INT64_MAX));
  EXPECT_EQ(huge.to_register_or_bound(-2'147'483'647), -2'147'483'647);
}

TEST(Binding, GivesNoValueWhereARegisterCannotShowIt) {
  const model::Binding torque = scaled(Quantity::torque_actual, Rational(1, 100));
  EXPECT_EQ(torque.to_register(327), 32700);
  EXPECT_EQ(torque.to_register(328), std::nullopt);
  EXPECT_EQ(torque.to_register(-328), std::nullopt);
  // -32768 is the register's "no value" and never a number.
  EXPECT_EQ(scaled(Quantity::torque_actual, Rational(1)).to_register(-32768), std::nullopt);
  EXPECT_EQ(scaled(Quantity::position_actual, Rational(1)).to_register(-2147483648LL), std::nullopt);
  EXPECT_EQ(scaled(Quantity::position_actual, Rational(1)).to_register(-2147483647LL), -2147483647LL);
}

TEST(Binding, GivesNoValueWhereTheObjectCannotTakeIt) {
  const model::Binding speed = scaled(Quantity::target_velocity, Rational(1, 1000));
  EXPECT_EQ(speed.to_raw(32767499, object(2, true)), 32767);
  EXPECT_EQ(speed.to_raw(32767500, object(2, true)), std::nullopt);
  EXPECT_EQ(speed.to_raw(-1000, object(2, false)), std::nullopt);
}

TEST(Binding, AnExtremeFactorNeverWraps) {
  const model::Binding huge = scaled(Quantity::target_position, Rational(INT64_MAX));
  EXPECT_EQ(huge.to_raw(3, object(4, true)), std::nullopt);
  const model::Binding tiny = scaled(Quantity::position_actual, Rational(1, INT64_MAX));
  EXPECT_EQ(tiny.to_register(2147483647), std::nullopt);
}

model::Condition condition(std::uint32_t mask, model::Condition::Test test, std::vector<std::int64_t> values) {
  model::Condition out;
  out.mask = mask;
  out.test = test;
  out.values = std::move(values);
  return out;
}

TEST(Condition, ComparesMaskedBitsOrTheNumberItself) {
  const model::ObjectDef word = object(2, false);
  EXPECT_TRUE(condition(0x6F, model::Condition::Test::equals, {0x27}).holds(word, 0xC037));
  EXPECT_FALSE(condition(0x6F, model::Condition::Test::equals, {0x27}).holds(word, 0x0250));
  EXPECT_TRUE(condition(0x24, model::Condition::Test::not_equals, {0x24}).holds(word, 0x0007));
  EXPECT_TRUE(condition(0, model::Condition::Test::equals, {-3}).holds(object(1, true), 0xFD));
  EXPECT_FALSE(condition(0, model::Condition::Test::equals, {-3}).holds(object(1, false), 0xFD));
}

TEST(Condition, InAndNotInLookThroughTheWholeList) {
  const model::ObjectDef word = object(2, false);
  const auto blocked = condition(0x8005, model::Condition::Test::in, {1, 4, 5});
  EXPECT_TRUE(blocked.holds(word, 0x0011)) << "enable together with a limit";
  EXPECT_TRUE(blocked.holds(word, 0x0004));
  EXPECT_FALSE(blocked.holds(word, 0x8001)) << "a speed selector, although its lowest bit is set";
  EXPECT_TRUE(condition(0, model::Condition::Test::not_in, {1, 2}).holds(word, 0));
  EXPECT_FALSE(condition(0, model::Condition::Test::not_in, {1, 2}).holds(word, 2));
}

TEST(DriveModel, FindsObjectsByAddress) {
  model::DriveModel model;
  model.objects.push_back(object(2, false));
  model.objects.back().address = {0x6041, 0};
  model.objects.push_back(object(4, true));
  model.objects.back().address = {0x607D, 2};
  EXPECT_EQ(model.find({0x607D, 2}), 1);
  EXPECT_EQ(model.find({0x607D, 1}), model::kNoObject);
}

}  // namespace
}  // namespace axisgate::profile
