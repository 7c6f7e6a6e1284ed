// Serial lines with simulated Keya drives: several on RS485, heartbeats between answers on RS232, faults.
#include <gmock/gmock.h>

#include "tests/unit/simulated/keya_bench.hpp"

namespace axisgate::simulated {
namespace {

using testing::IsEmpty;

Bytes query(std::uint8_t node, std::uint8_t code) {
  const KeyaFrame frame = seal_keya({keya_start::query, node, code});
  return {frame.begin(), frame.end()};
}

Bytes query(std::uint8_t code) {
  Bytes bytes{keya_start::query, code};
  bytes.resize(keya_frame_length);
  return bytes;
}

TEST(KeyaRs485, EachOfTwoDrivesHearsItsOwnNumberAlone) {
  KeyaBench bench(KeyaWiring::rs485, {a_keya({}, 1), a_keya({}, 9)});
  bench.drive(0).measured().voltage = 41;
  bench.drive(1).measured().voltage = 42;
  EXPECT_EQ(bench.exchange(query(1, 5))[3], 41);
  EXPECT_EQ(bench.exchange(query(9, 5))[3], 42);
  EXPECT_THAT(bench.exchange(query(2, 5)), IsEmpty());
  EXPECT_THAT(bench.exchange(query(0, 5)), IsEmpty());
  bench.control_at(9, 3, 1000, 1000);
  EXPECT_FALSE(bench.drive(0).enabled(motor_a));
  EXPECT_TRUE(bench.drive(1).enabled(motor_a));
  EXPECT_EQ(bench.line().requests_heard(), 3U);
}

TEST(KeyaRs485, AWrongChecksumMeetsSilenceAndChangesNothing) {
  KeyaBench bench(KeyaWiring::rs485, {a_keya()});
  EXPECT_THAT(bench.exchange("E0 01 01 00 00 03 E8 00 00 00 00 CE"), IsEmpty());
  EXPECT_FALSE(bench.drive().enabled(motor_a));
  EXPECT_THAT(bench.exchange("ED 01 07 00 00 00 00 00 00 00 00 F6"), IsEmpty());
  EXPECT_EQ(bench.exchange("ED 01 07 00 00 00 00 00 00 00 00 F5").size(), keya_frame_length);
}

TEST(KeyaRs485, NeverSendsAHeartbeat) {
  KeyaOptions options = a_keya();
  options.heartbeat = milliseconds(100);
  KeyaBench bench(KeyaWiring::rs485, {options});
  bench.pass(std::chrono::seconds(10));
  EXPECT_THAT(bench.received(), IsEmpty());
}

TEST(KeyaReceiver, FindsAFrameAfterRubbishAndAfterOneThatBrokeOff) {
  KeyaBench bench(KeyaWiring::rs232, {a_keya()});
  EXPECT_EQ(bench.exchange("00 FF 13 ED 05 00 00 00 00 00 00 00 00 00 00").size(), keya_frame_length);
  EXPECT_THAT(bench.exchange("ED 05 00 00 00"), IsEmpty());
  bench.pass(milliseconds(21));
  EXPECT_EQ(bench.exchange(query(5)).size(), keya_frame_length);
  for (const std::uint8_t byte : query(7)) {
    bench.line().from_host(std::span(&byte, 1), bench.now);
    bench.pass(milliseconds(10));
  }
  EXPECT_EQ(bench.received()[1 + keya_frame_length], 7);
}

TEST(KeyaReceiver, ACodeAboveThreeIsNoCommand) {
  KeyaBench bench(KeyaWiring::rs232, {a_keya()});
  bench.control(4, 1000, 1000);
  bench.control(0xFF, 1000, 1000);
  EXPECT_EQ(bench.drive().controls(), 0U);
}

TEST(KeyaRs232, IsForOneDrive) {
  EXPECT_THROW(KeyaBench(KeyaWiring::rs232, {a_keya(), a_keya()}), std::invalid_argument);
}

TEST(KeyaRs232, WithAnotherInterfaceSelectedItAnswersQueriesButObeysNothing) {
  KeyaBench bench(KeyaWiring::rs232, {a_keya({{19, 2}})});
  bench.control(3, 1000, 1000);
  EXPECT_FALSE(bench.drive().enabled(motor_a));
  EXPECT_EQ(bench.exchange(query(5)).size(), keya_frame_length);
  KeyaOptions options = a_keya({{19, 2}});
  options.queries_always = false;
  EXPECT_THAT(KeyaBench(KeyaWiring::rs232, {options}).exchange(query(5)), IsEmpty());
}

// At every moment of an exchange at 115200 baud: whole frames, one after the other, the answer among them.
TEST(KeyaHeartbeat, ComesBetweenFramesAtWhateverMomentItFallsDue) {
  for (int shift = 0; shift < 300; ++shift) {
    KeyaOptions options = a_keya();
    options.heartbeat = milliseconds(5);
    KeyaBench bench(KeyaWiring::rs232, {options}, 115200);
    if (shift % 2 == 1) bench.line().faults(0).next(DriveFault::split);
    bench.line().faults(0).split_gap = milliseconds(2);
    bench.pass(std::chrono::microseconds(20 * shift));
    bench.line().from_host(query(7), bench.now);
    bench.pass(milliseconds(30));
    const Bytes all = bench.received();
    ASSERT_EQ(all.size() % keya_frame_length, 0U);
    int answers = 0;
    for (std::size_t at = 0; at < all.size(); at += keya_frame_length) {
      ASSERT_THAT(all[at], testing::AnyOf(keya_start::query, keya_start::heartbeat)) << "shift " << shift;
      if (all[at] == keya_start::query) ++answers;
    }
    EXPECT_EQ(answers, 1);
    EXPECT_GE(all.size() / keya_frame_length, 5U);
  }
}

TEST(KeyaHeartbeat, HasAPeriodThatCanBeSetAndASumThatIsRight) {
  KeyaOptions options = a_keya();
  options.heartbeat = milliseconds(100);
  KeyaBench bench(KeyaWiring::rs232, {options});
  bench.pass(milliseconds(1000));
  ASSERT_EQ(bench.arrivals.size(), 10U);
  EXPECT_EQ(bench.arrivals[1].at - bench.arrivals[0].at, milliseconds(100));
  KeyaFrame frame{};
  std::copy_n(bench.arrivals[0].bytes.begin(), keya_frame_length, frame.begin());
  EXPECT_EQ(frame.back(), keya_sum(frame));
  bench.line().set_heartbeat(0, milliseconds(250));
  bench.arrivals.clear();
  bench.pass(milliseconds(1000));
  EXPECT_EQ(bench.arrivals.size(), 4U);
  bench.line().set_heartbeat(0, Time{});
  bench.arrivals.clear();
  bench.pass(milliseconds(1000));
  EXPECT_THAT(bench.arrivals, IsEmpty());
}

TEST(KeyaHeartbeat, ALateAnswerDoesNotHoldItBack) {
  KeyaOptions options = a_keya();
  options.heartbeat = milliseconds(100);
  KeyaBench bench(KeyaWiring::rs232, {options});
  bench.line().faults(0).next(DriveFault::late);  // 300 ms
  bench.line().from_host(query(7), bench.now);
  bench.pass(milliseconds(250));
  EXPECT_EQ(bench.arrivals.size(), 2U);
  bench.pass(milliseconds(100));
  ASSERT_EQ(bench.arrivals.size(), 4U);
  EXPECT_EQ(bench.arrivals[3].tag + bench.arrivals[2].tag, 1U);  // one of them is the answer
}

TEST(KeyaFaultSwitches, DoWhatTheySay) {
  KeyaOptions options = a_keya();
  KeyaBench bench(KeyaWiring::rs485, {options});
  DriveFaults& faults = bench.line().faults(0);
  const Bytes answer = bench.exchange(query(1, 5));
  faults.next(DriveFault::mute);
  bench.control_at(1, 3, 1000, 1000);
  EXPECT_FALSE(bench.drive().enabled(motor_a));  // it has not heard it
  faults.next(DriveFault::lose);
  EXPECT_THAT(bench.exchange(query(1, 5)), IsEmpty());
  faults.next(DriveFault::late);
  EXPECT_THAT(bench.exchange(query(1, 5)), IsEmpty());
  bench.pass(milliseconds(301));
  EXPECT_EQ(bench.received(), answer);
  faults.next(DriveFault::duplicate);
  EXPECT_EQ(bench.exchange(query(1, 5)).size(), 2 * keya_frame_length);
  faults.next(DriveFault::half);
  EXPECT_LT(bench.exchange(query(1, 5)).size(), keya_frame_length);
  faults.next(DriveFault::corrupt);
  EXPECT_NE(bench.exchange(query(1, 5)), answer);
  faults.next(DriveFault::noise_before);
  EXPECT_GT(bench.exchange(query(1, 5)).size(), keya_frame_length);
  faults.next(DriveFault::wrong_station);
  EXPECT_EQ(bench.exchange(query(1, 5))[1], 2);
  faults.next(DriveFault::restart);
  EXPECT_THAT(bench.exchange(query(1, 5)), IsEmpty());
  EXPECT_EQ(bench.drive().restarts(), 1U);
  EXPECT_THAT(bench.exchange(query(1, 5)), IsEmpty());
  bench.pass(milliseconds(1001));
  EXPECT_EQ(bench.exchange(query(1, 5)), answer);
  EXPECT_FALSE(bench.line().has(DriveFault::exception));
  EXPECT_FALSE(bench.line().has(DriveFault::heartbeat_twice));
}

TEST(KeyaFaultSwitches, AHeartbeatMayComeTwice) {
  KeyaOptions options = a_keya();
  options.heartbeat = milliseconds(100);
  KeyaBench bench(KeyaWiring::rs232, {options});
  bench.line().faults(0).next(DriveFault::heartbeat_twice);
  bench.pass(milliseconds(200));
  EXPECT_EQ(bench.arrivals.size(), 3U);
  KeyaCanBench can(a_keya());
  can.faults().next(DriveFault::heartbeat_twice);
  can.pass(milliseconds(2000));
  EXPECT_EQ(can.heard(keya_can::heartbeat + 1).size(), 3U);
}

}  // namespace
}  // namespace axisgate::simulated
