// DIN1 and DIN3 block the bus, unwired limits keep the drive in limit state (JD 1.4, JD 4.16, MD 6.1).
#include <gtest/gtest.h>

#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {
namespace {

DriveOptions factory_fresh(KincoType type) {
  DriveOptions options = a_drive(type);
  options.factory_fresh = true;
  return options;
}

class FactoryFresh : public testing::TestWithParam<KincoType> {};

TEST_P(FactoryFresh, AcknowledgesTheControlwordAndStaysDisabled) {
  Bench bench(factory_fresh(GetParam()));
  EXPECT_EQ(bench.write(0x6040, 0, 0x0F), 0U);
  bench.pass(milliseconds(10));
  EXPECT_EQ(bench.status() & 0x6F, 0x21);  // as its inactive input says: 0x06
  EXPECT_EQ(bench.read(0x6040), 0x06);
  EXPECT_EQ(bench.drive().writes({0x6040, 0}), 1U);
}

TEST_P(FactoryFresh, AcknowledgesTheModeAndKeepsItsOwn) {
  Bench bench(factory_fresh(GetParam()));
  EXPECT_EQ(bench.write(0x6060, 0, 1), 0U);
  EXPECT_EQ(bench.read(0x6060), -4);  // 2020:0D
  bench.drive().set_input(3, true);
  bench.pass(milliseconds(2));
  EXPECT_EQ(bench.read(0x6060), -3);  // 2020:0E
}

TEST_P(FactoryFresh, ItsEnableInputEnablesIt) {
  Bench bench(factory_fresh(GetParam()));
  bench.drive().set_input(1, true);
  bench.pass(milliseconds(2));
  EXPECT_EQ(bench.status() & 0x6F, 0x27);
  EXPECT_EQ(bench.drive().transitions().back().tag, 0U);  // nobody asked over the bus
  bench.drive().set_input(1, false);
  bench.pass(milliseconds(2));
  EXPECT_EQ(bench.status() & 0x6F, 0x21);
}

TEST_P(FactoryFresh, ObeysTheBusOnceTheFunctionsAreRemoved) {
  Bench bench(factory_fresh(GetParam()));
  bench.exchange(from_hex("01 2B 10 20 03 00 00 00 00 A1"));
  bench.exchange(from_hex("01 2B 10 20 05 00 00 00 00 9F"));
  bench.control(0x0F);
  EXPECT_EQ(bench.status() & 0x6F, 0x27);
  EXPECT_EQ(bench.drive().transitions().back().tag, bench.line().journal().recorded() - 1);
  EXPECT_EQ(bench.write(0x6060, 0, 1), 0U);
  EXPECT_EQ(bench.read(0x6060), 1);
}

TEST_P(FactoryFresh, BlocksAgainAfterARestartWithoutAStore) {
  Bench bench(factory_fresh(GetParam()));
  bench.write(0x2010, 0x03, 0);
  bench.write(0x2010, 0x05, 0);
  bench.line().restart(0, bench.now);
  bench.pass(std::chrono::seconds(2));
  bench.control(0x0F);
  EXPECT_NE(bench.status() & 0x6F, 0x27);
}

INSTANTIATE_TEST_SUITE_P(Kinco, FactoryFresh, testing::Values(KincoType::jd, KincoType::md),
                         [](const auto& type) { return type.param == KincoType::jd ? "jd" : "md"; });

TEST(Limits, AFreshJdWithoutSwitchesSitsInLimitState) {
  Bench bench(factory_fresh(KincoType::jd));
  EXPECT_EQ(bench.read(0x60FD), 0x3);
  EXPECT_EQ(bench.status() & 0x0800, 0x0800);
  bench.write(0x2010, 0x07, 0);
  bench.write(0x2010, 0x08, 0);
  EXPECT_EQ(bench.read(0x60FD), 0x0);
  EXPECT_EQ(bench.status() & 0x0800, 0);
}

TEST(Limits, APolarityOfNormallyClosedLiftsThem) {
  Bench bench(factory_fresh(KincoType::jd));
  bench.write(0x2010, 0x01, 0xFF & ~0x30);
  EXPECT_EQ(bench.read(0x60FD), 0x0);
}

TEST(Limits, AWiredSwitchStopsTheAxisInItsDirectionOnly) {
  DriveOptions options = a_drive(KincoType::jd);
  options.mechanics.positive_limit = 30000;
  options.mechanics.negative_limit = -30000;
  Bench bench(options);
  EXPECT_EQ(bench.read(0x60FD), 0x0);
  bench.write(0x6060, 0, 3);
  bench.write(0x60FF, 0, speed_dec(500, 10000));
  bench.control(0x0F);
  bench.pass(std::chrono::seconds(3));
  EXPECT_EQ(bench.read(0x60FD), 0x2);
  EXPECT_NE(bench.status() & 0x0800, 0);
  EXPECT_EQ(bench.read(0x60F9, 0x19), 0);
  EXPECT_GE(bench.read(0x6063), 30000);
  EXPECT_LT(bench.read(0x6063), 31000);
  bench.write(0x60FF, 0, speed_dec(-500, 10000));
  bench.pass(milliseconds(100));
  EXPECT_LT(bench.read(0x6063), 30000);
  EXPECT_EQ(bench.status() & 0x0800, 0);
}

TEST(Inputs, SimulationMakesAnInputActive) {
  Bench bench(factory_fresh(KincoType::jd));
  bench.write(0x2010, 0x02, 0x01);
  bench.pass(milliseconds(2));
  EXPECT_EQ(bench.status() & 0x6F, 0x27);
  EXPECT_EQ(bench.read(0x2010, 0x0A), 0);  // the pin itself is low
}

TEST(Inputs, TheFaultResetInputActsOnItsRisingEdge) {
  Bench bench(factory_fresh(KincoType::jd));
  bench.drive().inject_fault(1, 0x0080);
  bench.drive().clear_fault_cause(1, 0x0080);
  bench.drive().set_input(2, true);
  bench.pass(milliseconds(2));
  EXPECT_EQ(bench.read(0x2601), 0);
  EXPECT_NE(bench.status() & 0x4F, 0x08);
}

TEST(Inputs, OutputsTellReadyAndError) {
  Bench bench(a_drive(KincoType::jd));
  EXPECT_EQ(bench.read(0x2010, 0x14) & 0x01, 0x01);  // OUT1: ready
  bench.drive().inject_fault(1, 0x0080);
  EXPECT_EQ(bench.read(0x2010, 0x14) & 0x41, 0x40);  // OUT7: error
}

}  // namespace
}  // namespace axisgate::simulated
