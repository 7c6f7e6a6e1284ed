// Several drives on one line: the RS232 chain with its echo, and RS485 (JD 2.1, MD 2.1, MD 3.1).
#include <gtest/gtest.h>

#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {
namespace {

DriveOptions in_chain(KincoType type, std::uint8_t station) {
  DriveOptions options = a_drive(type, station);
  options.cascade = true;
  return options;
}

TEST(Chain, TheHostsFrameComesBackBeforeTheReply) {
  Bench bench(std::vector{in_chain(KincoType::jd, 1), in_chain(KincoType::jd, 2)});
  EXPECT_EQ(bench.exchange(from_hex("01 2B 40 60 00 3F 00 00 00 F5")),
            from_hex("01 2B 40 60 00 3F 00 00 00 F5 01 60 40 60 00 3F 00 00 00 C0"));
  ASSERT_EQ(bench.arrivals.size(), 2U);
  EXPECT_EQ(bench.arrivals[0].origin, ByteOrigin::echo);
  EXPECT_EQ(bench.arrivals[1].origin, ByteOrigin::reply);
}

TEST(Chain, ACopyWithoutAReplyMeansNobodyAnswered) {
  Bench bench(std::vector{in_chain(KincoType::jd, 1), in_chain(KincoType::md, 2)});
  const auto request = seal(9, FrameCommand::read, 0x6041, 0, 0);
  EXPECT_EQ(bench.exchange(request), Bytes(request.begin(), request.end()));
}

TEST(Chain, EachStationAnswersForItself) {
  Bench bench(std::vector{in_chain(KincoType::md, 1), in_chain(KincoType::jd, 2)});
  bench.write(0x607A, 0, 11, 1);
  bench.write(0x607A, 0, 22, 2);
  EXPECT_EQ(bench.read(0x607A, 0, 1), 11);
  EXPECT_EQ(bench.read(0x607A, 0, 2), 22);
}

TEST(Chain, ADriveLeftOneToOneBreaksTheChain) {
  Bench bench(std::vector{a_drive(KincoType::jd, 1), in_chain(KincoType::jd, 2)});
  EXPECT_EQ(bench.exchange(seal(1, FrameCommand::read, 0x6041, 0, 0)).size(), frame_length);  // no copy
  EXPECT_TRUE(bench.exchange(seal(2, FrameCommand::read, 0x6041, 0, 0)).empty());             // never reached
}

TEST(Chain, ADriveThatRebootsSilencesTheWholeChain) {
  Bench bench(std::vector{in_chain(KincoType::jd, 1), in_chain(KincoType::jd, 2)});
  bench.line().restart(1, bench.now);
  EXPECT_TRUE(bench.exchange(seal(1, FrameCommand::read, 0x6041, 0, 0)).empty());
  bench.pass(std::chrono::seconds(2));
  EXPECT_EQ(bench.exchange(seal(1, FrameCommand::read, 0x6041, 0, 0)).size(), 2 * frame_length);
}

TEST(Chain, CascadeIsWrittenStoredAndActsAfterARestart) {
  Bench bench(a_drive(KincoType::jd));
  EXPECT_EQ(bench.exchange(from_hex("01 2F 10 65 0B 01 00 00 00 4F")).size(), frame_length);
  bench.exchange(from_hex("01 2F F0 2F 01 01 00 00 00 AF"));
  bench.pass(milliseconds(100));
  EXPECT_EQ(bench.exchange(seal(1, FrameCommand::read, 0x6041, 0, 0)).size(), frame_length);
  bench.line().restart(0, bench.now);
  bench.pass(std::chrono::seconds(2));
  EXPECT_EQ(bench.exchange(seal(1, FrameCommand::read, 0x6041, 0, 0)).size(), 2 * frame_length);
}

TEST(Rs485, AllDrivesHearTheHostAndNothingEchoes) {
  LineOptions line;
  line.wiring = Wiring::rs485;
  Bench bench(std::vector{a_drive(KincoType::md, 1), a_drive(KincoType::md, 2)}, line);
  EXPECT_EQ(bench.exchange(seal(1, FrameCommand::read, 0x6041, 0, 0)).size(), frame_length);
  EXPECT_EQ(bench.exchange(seal(2, FrameCommand::read, 0x6041, 0, 0)).size(), frame_length);
}

TEST(Rs485, AnMdSwitchedToModbusNoLongerAnswersHere) {
  LineOptions line;
  line.wiring = Wiring::rs485;
  Bench bench(a_drive(KincoType::md), line);
  bench.exchange(from_hex("01 2F 10 65 0C 00 00 00 00 4F"));
  bench.exchange(from_hex("01 2F F0 2F 01 01 00 00 00 AF"));
  bench.pass(milliseconds(100));
  EXPECT_EQ(bench.read(0x6510, 0x0C), 0);
  bench.line().restart(0, bench.now);
  bench.pass(std::chrono::seconds(2));
  EXPECT_TRUE(bench.exchange(seal(1, FrameCommand::read, 0x6041, 0, 0)).empty());
}

TEST(Rs485, AJdSpeaksModbusThereAndIsRefused) {
  LineOptions line;
  line.wiring = Wiring::rs485;
  EXPECT_THROW(Bench(a_drive(KincoType::jd), line), std::invalid_argument);
}

}  // namespace
}  // namespace axisgate::simulated
