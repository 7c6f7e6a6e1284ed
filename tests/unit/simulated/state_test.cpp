// The CiA 402 machine, stops and faults (JD 6.1, JD 7, MD 8.1, MD M, MD 9).
#include <gtest/gtest.h>

#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {
namespace {

void run_at(Bench& bench, std::int64_t rpm) {
  const std::int64_t counts = bench.drive().model().encoder_counts;
  bench.write(0x6060, 0, 3);
  bench.write(0x60FF, 0, speed_dec(rpm, counts));
  bench.control(0x06);
  bench.control(0x0F);
  bench.pass(std::chrono::seconds(1));
}

TEST(StateMachine, WalksUpAndDown) {
  Bench bench(a_drive(KincoType::jd));
  EXPECT_EQ(bench.status(), 0x4050);
  for (const auto& [word, bits] : {std::pair{0x06, 0x21}, {0x07, 0x23}, {0x0F, 0x27}, {0x07, 0x23}, {0x06, 0x21}}) {
    bench.control(static_cast<std::uint16_t>(word));
    bench.pass(milliseconds(5));
    EXPECT_EQ(bench.status() & 0x6F, bits) << word;
  }
  bench.control(0x00);
  EXPECT_EQ(bench.status() & 0x4F, 0x40);
}

TEST(StateMachine, EachTransitionNamesTheRequestThatCausedIt) {
  Bench bench(a_drive(KincoType::md));
  bench.control(0x06);
  bench.control(0x0F);
  const auto& log = bench.drive().transitions();
  ASSERT_GE(log.size(), 2U);
  EXPECT_EQ(log.back().to, Cia402State::operation_enabled);
  EXPECT_EQ(log.back().tag, 2U);
  EXPECT_EQ(log[log.size() - 2].tag, 1U);
}

TEST(StateMachine, MayInsistOnAFirstShutdown) {
  DriveOptions options = a_drive(KincoType::jd);
  options.needs_shutdown_first = true;
  Bench bench(options);
  bench.control(0x0F);
  EXPECT_EQ(bench.status() & 0x4F, 0x40);
  bench.control(0x06);
  bench.control(0x0F);
  EXPECT_EQ(bench.status() & 0x6F, 0x27);
}

TEST(QuickStop, OfAJdEndsWithTheVoltageOff) {
  Bench bench(a_drive(KincoType::jd));
  run_at(bench, 1000);
  bench.control(0x0B);
  EXPECT_EQ(bench.status() & 0x6F, 0x07);
  bench.pass(std::chrono::seconds(1));
  EXPECT_EQ(bench.status() & 0x4F, 0x40);
  EXPECT_EQ(bench.read(0x60F9, 0x19), 0);
}

TEST(QuickStop, OfAnMdFollows605A) {
  for (const auto& [option, resting] : {std::pair{1, 0x40}, {2, 0x40}, {5, 0x07}, {6, 0x07}}) {
    Bench bench(a_drive(KincoType::md));
    bench.write(0x605A, 0, option);
    run_at(bench, 1000);
    bench.control(0x0B);
    EXPECT_EQ(bench.status() & 0x6F, 0x07);
    bench.pass(milliseconds(100));
    // 1000 rpm: 33 ms at 500 rps/s (6085), 167 ms at 100 rps/s (6084).
    EXPECT_EQ(bench.read(0x606C) == 0, option % 2 == 0) << option;
    bench.pass(std::chrono::seconds(1));
    EXPECT_EQ(bench.status() & 0x4F, resting) << option;
  }
}

TEST(QuickStop, AnMdThatStaysInItCanBeEnabledAgain) {
  Bench bench(a_drive(KincoType::md));
  bench.write(0x605A, 0, 6);
  run_at(bench, 100);
  bench.control(0x0B);
  bench.pass(std::chrono::seconds(1));
  bench.control(0x0F);
  EXPECT_EQ(bench.status() & 0x6F, 0x27);
}

TEST(QuickStop, Option0IsAnUncontrolledStop) {
  Bench bench(a_drive(KincoType::md));
  bench.write(0x605A, 0, 0);
  run_at(bench, 1000);
  bench.control(0x0B);
  EXPECT_EQ(bench.status() & 0x4F, 0x40);
  EXPECT_GT(bench.read(0x606C), 0);  // it coasts
}

TEST(Shutdown, OfAnMdFollows605B) {
  Bench bench(a_drive(KincoType::md));
  bench.write(0x605B, 0, 1);
  run_at(bench, 1000);
  bench.control(0x06);
  bench.pass(milliseconds(50));
  EXPECT_EQ(bench.status() & 0x6F, 0x27);  // ramping down under torque
  bench.pass(milliseconds(200));
  EXPECT_EQ(bench.status() & 0x6F, 0x21);
}

TEST(Halt, OfAnMdStopsAndGoesOnWithBit8) {
  Bench bench(a_drive(KincoType::md));
  bench.write(0x6060, 0, 1);
  bench.control(0x0F);
  bench.write(0x607A, 0, 400000);
  bench.write(0x6081, 0, speed_dec(1000, 65536));
  bench.control(0x2F);
  bench.control(0x3F);
  bench.pass(milliseconds(200));
  bench.control(0x13F);
  bench.pass(milliseconds(500));
  const auto there = bench.read(0x6063);
  EXPECT_EQ(bench.read(0x606C), 0);
  EXPECT_EQ(bench.status() & 0x6F, 0x27);
  EXPECT_LT(there, 400000);
  bench.control(0x3F);
  bench.pass(std::chrono::seconds(2));
  EXPECT_EQ(bench.read(0x6063), 400000);
}

TEST(Halt, IsNotKnownToAJdNorInTorqueMode) {
  Bench jd(a_drive(KincoType::jd));
  run_at(jd, 300);
  jd.control(0x10F);
  jd.pass(std::chrono::seconds(1));
  EXPECT_EQ(jd.read(0x606C), 300);
  Bench md(a_drive(KincoType::md));
  md.write(0x6060, 0, 4);
  md.write(0x60F6, 0x08, 200);
  md.control(0x0F);
  md.control(0x10F);
  md.pass(std::chrono::seconds(1));
  EXPECT_NE(md.read(0x606C), 0);
}

TEST(Fault, GoesWithTheManualsWordOnceItsCauseIsGone) {
  Bench jd(a_drive(KincoType::jd));
  jd.control(0x0F);
  jd.drive().inject_fault(1, 0x0020);
  EXPECT_EQ(jd.status() & 0x4F, 0x08);
  EXPECT_EQ(jd.read(0x2601), 0x20);
  jd.control(0x80);
  EXPECT_EQ(jd.status() & 0x4F, 0x08);  // still there
  jd.drive().clear_fault_cause(1, 0x0020);
  jd.control(0x06);
  jd.control(0x80);
  EXPECT_EQ(jd.status() & 0x4F, 0x40);
  EXPECT_EQ(jd.read(0x2601), 0);
}

TEST(Fault, AnMdWants0x86) {
  Bench md(a_drive(KincoType::md));
  md.drive().inject_fault(1, 0x0080);
  md.drive().clear_fault_cause(1, 0x0080);
  md.control(0x80);
  EXPECT_EQ(md.status() & 0x4F, 0x08);
  md.control(0x06);
  md.exchange(from_hex("01 2B 40 60 00 86 00 00 00 AE"));
  EXPECT_EQ(md.status() & 0x4F, 0x40);
}

TEST(Fault, WordTwoOfAnMdShowsInBitZeroOfWordOne) {
  Bench md(a_drive(KincoType::md));
  md.drive().inject_fault(2, 0x0008);
  EXPECT_EQ(md.read(0x2601), 0x0001);
  EXPECT_EQ(md.read(0x2602), 0x0008);
}

TEST(Fault, NeverEnablesAgainByItself) {
  Bench bench(a_drive(KincoType::jd));
  run_at(bench, 100);
  bench.drive().inject_fault(1, 0x0800);
  bench.drive().clear_fault_cause(1, 0x0800);
  bench.control(0x8F);  // with the enable bits still set
  bench.pass(std::chrono::seconds(5));
  EXPECT_EQ(bench.status() & 0x4F, 0x40);
}

TEST(Fault, AJamLeadsToAFollowingError) {
  Bench bench(a_drive(KincoType::jd));
  run_at(bench, 300);
  bench.drive().jam(true);
  bench.pass(milliseconds(100));
  EXPECT_GT(bench.read(0x60FB, 0x08), 1000);
  bench.pass(std::chrono::seconds(1));
  EXPECT_EQ(bench.read(0x2601), 0x0200);
  EXPECT_EQ(bench.status() & 0x2008, 0x2008);
}

TEST(Fault, ALimitAfterHomingIsAnAlarmOnAnMdThatAsksForIt) {
  DriveOptions options = a_drive(KincoType::md);
  options.mechanics.positive_limit = 5000;
  Bench bench(options);
  bench.write(0x2010, 0x06, 0x0010);
  bench.write(0x2010, 0x19, 0);
  bench.write(0x6060, 0, 6);
  bench.write(0x6098, 0, 35);
  bench.control(0x0F);
  bench.control(0x1F);
  ASSERT_TRUE(bench.wait_for(0x8000));
  bench.write(0x60FF, 0, speed_dec(100, 65536));
  bench.write(0x6060, 0, 3);
  bench.pass(std::chrono::seconds(1));
  EXPECT_EQ(bench.read(0x2602), 0x0200);
}

}  // namespace
}  // namespace axisgate::simulated
