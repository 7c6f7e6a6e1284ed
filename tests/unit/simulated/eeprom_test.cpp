// What a store keeps and what a restart loses (JD 1.4 point 7, JD 4.19, MD 6, MD 13).
#include <gtest/gtest.h>

#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {
namespace {

void store(Bench& bench) {
  bench.exchange(from_hex("01 2F F0 2F 01 01 00 00 00 AF"));
  bench.pass(milliseconds(100));
}

void restart(Bench& bench) {
  bench.line().restart(0, bench.now);
  bench.pass(std::chrono::seconds(2));
}

TEST(Eeprom, ARestartLosesWhatWasNotStored) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x6083, 0, 50000);
  restart(bench);
  EXPECT_EQ(bench.read(0x6083), 100000);
}

TEST(Eeprom, AStoredParameterSurvivesAndTheF000GroupNever) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x6083, 0, 50000);
  bench.write(0x6060, 0, 1);
  bench.write(0x2FF0, 0x09, 100);
  bench.write(0x6071, 0, 50);
  bench.write(0x607A, 0, 1234);
  store(bench);
  EXPECT_EQ(bench.drive().stores(), 1U);
  restart(bench);
  EXPECT_EQ(bench.read(0x6083), 50000);
  EXPECT_EQ(bench.read(0x6060), -4);
  EXPECT_EQ(bench.read(0x6061), -4);
  EXPECT_EQ(bench.read(0x2FF0, 0x09), 0);
  EXPECT_EQ(bench.read(0x6071), 0);
  EXPECT_EQ(bench.read(0x607A), 0);
}

TEST(Eeprom, TheStoreCommandReadsBackZeroWhenItIsDone) {
  DriveOptions options = a_drive(KincoType::jd);
  options.store_time = milliseconds(300);
  Bench bench(options);
  bench.write(0x2FF0, 0x01, 1);
  bench.pass(milliseconds(299));
  EXPECT_EQ(bench.read(0x2FF0, 0x01), 1);
  EXPECT_EQ(bench.drive().stores(), 0U);
  bench.pass(milliseconds(1));
  EXPECT_EQ(bench.read(0x2FF0, 0x01), 0);
  EXPECT_EQ(bench.drive().stores(), 1U);
}

TEST(Eeprom, APowerCutDuringAStoreLosesIt) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x6083, 0, 50000);
  bench.write(0x2FF0, 0x01, 1);
  bench.pass(milliseconds(10));
  restart(bench);
  EXPECT_EQ(bench.read(0x6083), 100000);
  EXPECT_EQ(bench.drive().stores(), 0U);
}

TEST(Eeprom, TenRestoresTheDefaultsOfAllButTheMotor) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x6083, 0, 50000);
  bench.write(0x6410, 0x05, 5);
  bench.exchange(from_hex("01 2F F0 2F 01 0A 00 00 00 A6"));
  EXPECT_EQ(bench.read(0x6083), 100000);
  EXPECT_EQ(bench.read(0x2010, 0x03), 1);  // DIN1 is drive enable again
  EXPECT_EQ(bench.read(0x6410, 0x05), 5);
}

TEST(Eeprom, MotorParametersHaveTheirOwnStore) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x6410, 0x05, 5);
  store(bench);
  restart(bench);
  EXPECT_EQ(bench.read(0x6410, 0x05), 3);
  bench.write(0x6410, 0x05, 5);
  bench.write(0x2FF0, 0x03, 1);
  bench.pass(milliseconds(100));
  restart(bench);
  EXPECT_EQ(bench.read(0x6410, 0x05), 5);
}

TEST(Eeprom, TheMdsGainsCarryNoSAndAreLost) {
  Bench bench(a_drive(KincoType::md));
  bench.write(0x60F9, 0x01, 321);
  bench.write(0x60FB, 0x01, 200);
  store(bench);
  restart(bench);
  EXPECT_EQ(bench.read(0x60F9, 0x01), 100);
  EXPECT_EQ(bench.read(0x60FB, 0x01), 200);
}

TEST(Eeprom, ANewStationActsAfterStoreAndRestart) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x100B, 0, 5);
  store(bench);
  EXPECT_EQ(bench.exchange(seal(1, FrameCommand::read, 0x6041, 0, 0)).size(), frame_length);
  restart(bench);
  EXPECT_TRUE(bench.exchange(seal(1, FrameCommand::read, 0x6041, 0, 0)).empty());
  EXPECT_EQ(bench.exchange(seal(5, FrameCommand::read, 0x6041, 0, 0)).size(), frame_length);
}

TEST(Eeprom, TheMdsDipSwitchesWinOverItsStationObject) {
  Bench bench(a_drive(KincoType::md));
  EXPECT_EQ(bench.write(0x100B, 0, 5), 0U);
  EXPECT_EQ(bench.read(0x100B), 1);
}

TEST(Eeprom, APasswordLocksParametersAfterARestart) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x2FFD, 0, 4711);
  EXPECT_EQ(bench.write(0x6083, 0, 60000), 0U);
  store(bench);
  restart(bench);
  EXPECT_NE(bench.write(0x6083, 0, 50000), 0U);
  EXPECT_NE(bench.write(0x2FFD, 0, 4712), 0U);
  EXPECT_EQ(bench.write(0x6040, 0, 0x06), 0U);
  EXPECT_EQ(bench.write(0x2FFD, 0, 4711), 0U);
  EXPECT_EQ(bench.write(0x6083, 0, 50000), 0U);
}

TEST(Eeprom, ARestartedDriveIsSilentDisabledAndUnreferenced) {
  Bench bench(a_drive(KincoType::jd));
  bench.control(0x0F);
  bench.line().restart(0, bench.now);
  EXPECT_TRUE(bench.exchange(seal(1, FrameCommand::read, 0x6041, 0, 0)).empty());
  bench.pass(milliseconds(999));
  EXPECT_TRUE(bench.exchange(seal(1, FrameCommand::read, 0x6041, 0, 0)).empty());
  bench.pass(milliseconds(1));
  EXPECT_EQ(bench.status(), 0x4050);
}

TEST(Eeprom, AutoEnableActsAtPowerUpWithoutARequest) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x2000, 0, 1);
  store(bench);
  restart(bench);
  EXPECT_EQ(bench.status() & 0x6F, 0x27);
  EXPECT_EQ(bench.drive().transitions().back().tag, 0U);
}

}  // namespace
}  // namespace axisgate::simulated
