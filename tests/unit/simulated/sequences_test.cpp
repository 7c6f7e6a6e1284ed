// The sequences the manuals print, with the statuswords they print (JD 6.2, 6.4; MD 8.2, 8.4).
#include <gtest/gtest.h>

#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {
namespace {

TEST(PrintedSequences, JdHomesOnTheNextIndexPulseAndSaysC037) {
  Bench bench(a_drive(KincoType::jd));
  for (const char* frame :
       {"01 2B 40 60 00 0F 00 00 00 25", "01 2F 60 60 00 06 00 00 00 0A", "01 2F 98 60 00 21 00 00 00 B7",
        "01 23 99 60 01 55 55 08 00 30", "01 23 99 60 02 00 40 06 00 9B"}) {
    EXPECT_EQ(bench.exchange(from_hex(frame)).at(1), 0x60) << frame;
  }
  EXPECT_EQ(bench.status(), 0x4037);
  bench.exchange(from_hex("01 2B 40 60 00 1F 00 00 00 15"));
  bench.pass(milliseconds(50));
  EXPECT_EQ(bench.status(), 0x4037);  // on its way
  ASSERT_TRUE(bench.wait_for(0x8000));
  EXPECT_EQ(bench.exchange(from_hex("01 40 41 60 00 00 00 00 00 1E")), from_hex("01 4B 41 60 00 37 C0 00 00 1C"));
  EXPECT_EQ(bench.read(0x6063), 0);
  EXPECT_EQ(counts_of(bench.drive().axis().physical()), -10000);  // method 33: negative direction
}

TEST(PrintedSequences, JdAbsoluteMoveSays5037ThenD437AfterHoming) {
  Bench bench(a_drive(KincoType::jd));
  bench.control(0x0F);
  bench.write(0x6060, 0, 6);
  bench.write(0x6098, 0, 35);
  bench.control(0x1F);
  ASSERT_TRUE(bench.wait_for(0x8000));
  for (const char* frame :
       {"01 2B 40 60 00 0F 00 00 00 25", "01 2F 60 60 00 01 00 00 00 0F", "01 23 7A 60 00 50 C3 00 00 EF",
        "01 23 81 60 00 55 55 08 00 49", "01 2B 40 60 00 2F 00 00 00 05", "01 2B 40 60 00 3F 00 00 00 F5"}) {
    EXPECT_EQ(bench.exchange(from_hex(frame)).at(1), 0x60) << frame;
  }
  EXPECT_EQ(bench.status(), 0xD037);  // acknowledged, and the old target_reached is gone at once
  bench.pass(milliseconds(500));
  EXPECT_EQ(bench.read(0x606C), 200);  // 546133 DEC are 200 rpm at 10000 counts
  ASSERT_TRUE(bench.wait_for(0x0400));
  bench.pass(milliseconds(20));  // the window of 6067 is reached before the last count
  EXPECT_EQ(bench.exchange(from_hex("01 40 41 60 00 00 00 00 00 1E")), from_hex("01 4B 41 60 00 37 D4 00 00 08"));
  EXPECT_EQ(bench.read(0x6063), 50000);
  // Relative, from where it stands.
  bench.exchange(from_hex("01 2B 40 60 00 4F 00 00 00 E5"));
  EXPECT_EQ(bench.status(), 0xC437);
  bench.exchange(from_hex("01 2B 40 60 00 5F 00 00 00 D5"));
  ASSERT_TRUE(bench.wait_for(0x1400));
  bench.pass(milliseconds(20));
  EXPECT_EQ(bench.read(0x6063), 100000);
}

TEST(PrintedSequences, JdMode1SaysAsItsScreensDo) {
  Bench bench(a_drive(KincoType::jd));
  bench.control(0x0F);
  bench.write(0x6060, 0, 1);
  bench.write(0x607A, 0, 20000);
  bench.control(0x2F);
  bench.control(0x3F);
  bench.pass(milliseconds(20));
  EXPECT_EQ(bench.status(), 0x5037);  // moving, start bit set
  ASSERT_TRUE(bench.wait_for(0x0400));
  bench.control(0x2F);
  EXPECT_EQ(bench.status(), 0x4437);  // back at 0x2F, target reached
}

TEST(PrintedSequences, JdMode3SaysC637AtSpeed) {
  Bench bench(a_drive(KincoType::jd));
  bench.control(0x0F);
  bench.write(0x6060, 0, 6);
  bench.write(0x6098, 0, 35);
  bench.control(0x1F);
  ASSERT_TRUE(bench.wait_for(0x8000));
  bench.control(0x06);
  // Mode and speed first, 0x0F last, as printed.
  bench.exchange(from_hex("01 2F 60 60 00 03 00 00 00 0D"));
  bench.exchange(from_hex("01 23 FF 60 00 00 40 06 00 37"));
  bench.exchange(from_hex("01 2B 40 60 00 0F 00 00 00 25"));
  bench.pass(milliseconds(400));
  EXPECT_EQ(bench.status(), 0xC637);
  EXPECT_EQ(bench.read(0x606C), 150);
  EXPECT_EQ(bench.read(0x60F9, 0x19), 15000);
  EXPECT_EQ(bench.read(0x60F9, 0x1A), 25);  // 150 rpm * 10000 / 60000
}

TEST(PrintedSequences, JdImmediateModeSays4037WhileAcceleratingAnd4437AtSpeed) {
  DriveOptions options = a_drive(KincoType::jd);
  options.mechanics.rps_per_s_at_full_current = 50;
  Bench bench(options);
  bench.write(0x6060, 0, -3);
  bench.write(0x60FF, 0, speed_dec(600, 10000));
  bench.control(0x0F);
  bench.pass(milliseconds(20));
  EXPECT_EQ(bench.status(), 0x4037);
  bench.pass(milliseconds(500));
  EXPECT_EQ(bench.status(), 0x4437);
}

TEST(PrintedSequences, JdReads606CEach200MsOnly) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x6060, 0, 3);
  bench.write(0x60FF, 0, speed_dec(300, 10000));
  bench.pass(milliseconds(201));
  bench.control(0x0F);
  bench.pass(milliseconds(190));
  EXPECT_EQ(bench.read(0x606C), 0);
  bench.pass(milliseconds(10));
  EXPECT_EQ(bench.read(0x606C), 300);
}

TEST(PrintedSequences, MdMovesAndReports606CInDec) {
  Bench bench(a_drive(KincoType::md));
  for (const char* frame :
       {"01 2B 40 60 00 0F 00 00 00 25", "01 2F 60 60 00 01 00 00 00 0F", "01 23 7A 60 00 50 C3 00 00 EF",
        "01 23 81 60 00 03 9D 36 00 25", "01 2B 40 60 00 2F 00 00 00 05", "01 2B 40 60 00 3F 00 00 00 F5"}) {
    EXPECT_EQ(bench.exchange(from_hex(frame)).at(1), 0x60) << frame;
  }
  bench.pass(milliseconds(120));
  EXPECT_EQ(bench.read(0x606C), 3579139);  // 200 rpm at 65536 counts
  ASSERT_TRUE(bench.wait_for(0x0400));
  bench.pass(milliseconds(20));
  EXPECT_EQ(bench.status(), 0x5437);  // not homed: bit 15 is absent
  EXPECT_EQ(bench.read(0x6063), 50000);
}

TEST(PrintedSequences, MdReadsMinus50000AsTheSheetComputesIt) {
  Bench bench(a_drive(KincoType::md));
  bench.control(0x0F);
  bench.write(0x6060, 0, 1);
  bench.write(0x607A, 0, -50000);
  bench.control(0x2F);
  bench.control(0x3F);
  ASSERT_TRUE(bench.wait_for(0x0400));
  bench.pass(milliseconds(20));  // the window of 6067 is reached before the last count
  EXPECT_EQ(bench.exchange(from_hex("01 40 63 60 00 00 00 00 00 FC")), from_hex("01 43 63 60 00 B0 3C FF FF 0F"));
}

TEST(PrintedSequences, UnusedBytesOfAShortReplyMayBeFF) {
  DriveOptions options = a_drive(KincoType::md);
  options.unused_bytes = 0xFF;
  Bench bench(options);
  bench.control(0x06);
  const Bytes reply = bench.exchange(seal(1, FrameCommand::read, 0x6041, 0, 0));
  EXPECT_EQ(Bytes(reply.begin() + 5, reply.begin() + 9), from_hex("31 40 FF FF"));
}

TEST(PrintedSequences, FollowTargetMovesWithEachWriteOf607A) {
  Bench bench(a_drive(KincoType::md));
  bench.write(0x6060, 0, 1);
  bench.control(0x06);
  bench.control(0x103F);  // sent directly
  bench.write(0x607A, 0, 3000);
  bench.pass(std::chrono::seconds(3));
  EXPECT_EQ(bench.read(0x6063), 3000);
  bench.write(0x607A, 0, -1000);
  bench.pass(std::chrono::seconds(3));
  EXPECT_EQ(bench.read(0x6063), -1000);
}

TEST(PrintedSequences, ASecondMoveNeedsASecondEdge) {
  Bench bench(a_drive(KincoType::jd));
  bench.control(0x0F);
  bench.write(0x6060, 0, 1);
  bench.write(0x607A, 0, 1000);
  bench.control(0x2F);
  bench.control(0x3F);
  bench.pass(std::chrono::seconds(2));
  bench.write(0x607A, 0, 2000);
  bench.control(0x3F);
  bench.pass(std::chrono::seconds(2));
  EXPECT_EQ(bench.read(0x6063), 1000);
  bench.control(0x2F);
  bench.control(0x3F);
  bench.pass(std::chrono::seconds(2));
  EXPECT_EQ(bench.read(0x6063), 2000);
}

}  // namespace
}  // namespace axisgate::simulated
