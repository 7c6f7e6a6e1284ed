// SPDX-License-Identifier: Apache-2.0
// What the rest of the tests build on in a line itself: where frames end, how long they take, who goes first.
#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {
namespace {

constexpr const char* two_kinds = "rtu:jd@1,id286pro@2";
const Bytes read_jd = seal_rtu(1, read_pdu(0x3200, 1));
const Bytes read_id = seal_rtu(2, read_pdu(108, 2));

// At 19200 baud a byte takes 521 us, and 1.82 ms of silence end a frame. The iD286pro alone takes 1.5 characters of
// silence inside a frame for its end.
TEST(lines, silence_ends_a_frame_on_rtu) {
  Bench bench(two_kinds, LineTimings{});
  const auto answered = [&](const Bytes& frame, std::size_t cut, Time silence) {
    bench.exchange(std::span(frame).first(cut));
    bench.pass(bench.port.rtu->on_wire(cut) + silence);
    bench.exchange(std::span(frame).subspan(cut));
    bench.pass(milliseconds(100));
    return !bench.arrivals.empty();
  };
  for (std::size_t cut = 1; cut < read_jd.size(); ++cut) {
    EXPECT_TRUE(answered(read_jd, cut, microseconds(1000))) << cut;
    EXPECT_TRUE(answered(read_id, cut, microseconds(700))) << cut;
    EXPECT_FALSE(answered(read_id, cut, microseconds(1000))) << cut;
    EXPECT_FALSE(answered(read_jd, cut, microseconds(1900))) << cut;
  }
}

// Bytes take their time at a baud rate, frames at a bit rate (111 bits and 24 of stuffing at most), drives theirs.
TEST(lines, an_answer_takes_what_the_line_and_the_drive_take) {
  LineTimings timings;
  timings.serial.baud = 38400;
  timings.serial.reply_delay = milliseconds(5);
  timings.can.bit_rate = 1000000;
  const auto answer_time = [&](const char* line, const Bytes& request) {
    Bench bench(line, timings);
    bench.exchange(request);
    bench.pass(milliseconds(100));
    return static_cast<double>(bench.arrivals.at(0).at.count());
  };
  const auto status = socket_frame_of(bus_frame(cob::sdo_request + 1, sdo_request(0x40, {0x6041, 0})));
  EXPECT_NEAR(answer_time("jd", ten_bytes(FrameCommand::read, {0x6041, 0})), 5e6 + 200e9 / 38400, 100);
  EXPECT_NEAR(answer_time(two_kinds, read_jd), 18.5 * 520833, 100);         // 8 + 3.5 + 7 bytes
  EXPECT_NEAR(answer_time(two_kinds, read_id), 20e6 + 17.0 * 520833, 100);  // iD286pro 2
  EXPECT_NEAR(answer_time("can:ld2", {status.begin(), status.end()}), 1e6 + 2 * 135e3, 100);
}

// On RS485 all hear the host and nothing echoes. A JD speaks Modbus there.
TEST(lines, kinco_drives_on_rs485) {
  LineTimings timings = untimed();
  timings.serial.wiring = Wiring::rs485;
  Bench bench("md@1,md@2", timings);
  for (const std::uint8_t station : {std::uint8_t{1}, std::uint8_t{2}}) {
    EXPECT_EQ(bench.exchange(ten_bytes(FrameCommand::read, {0x6041, 0}, 0, station)).size(), frame_length);
  }
  bench.exchange(ten_bytes(FrameCommand::write_1, {0x6510, 0x0C}, 0));  // an MD to Modbus, stored
  bench.exchange(ten_bytes(FrameCommand::write_1, {0x2FF0, 1}, 1));
  bench.pass(milliseconds(100));
  bench.line().restart(0, bench.now);
  bench.pass(seconds(2));
  EXPECT_TRUE(bench.exchange(ten_bytes(FrameCommand::read, {0x6041, 0})).empty());
  EXPECT_THROW(Bench("jd", timings), std::invalid_argument);
}

TEST(lines, the_lowest_can_identifier_goes_first_and_a_request_while_a_reply_is_owed_is_counted) {
  Bench bench("can:ld2@3,ld2@2", LineTimings{});
  bench.send(bus_frame(cob::nmt, {0x82, 0}));  // both answer it at the same instant
  bench.pass(milliseconds(5));
  EXPECT_EQ(bench.frames().at(0).id, 0x702U);
  for (const std::uint32_t node : {2U, 3U}) {
    EXPECT_EQ(bench.bus().overlapping_requests(), 0U);
    bench.send(bus_frame(cob::sdo_request + node, sdo_request(0x40, {0x6041, 0})));
  }
  bench.pass(milliseconds(5));
  EXPECT_EQ(bench.bus().overlapping_requests(), 1U);
  bench.send(bus_remote_frame(cob::error_control + 2));  // guarding is no SDO
  bench.send(bus_remote_frame(cob::error_control + 3));
  bench.pass(milliseconds(5));
  EXPECT_EQ(bench.bus().overlapping_requests(), 1U);
}

// At every moment of an exchange at 115200 baud: whole frames, one after the other, the answer among them.
TEST(lines, a_keyas_heartbeat_comes_between_frames_at_whatever_moment_it_falls_due) {
  LineTimings timings;
  timings.keya.baud = 115200;
  for (int shift = 0; shift < 300; ++shift) {
    Bench bench("keya-rs232+heartbeat=5", timings);
    if (shift % 2 == 1) bench.faults().next(DriveFault::split);
    bench.pass(microseconds(20 * shift));
    bench.line().from_host(from_hex("ED 07 00 00 00 00 00 00 00 00 00 00"), bench.now);
    bench.pass(milliseconds(30));
    std::string starts;
    const Bytes received = bench.received();
    ASSERT_EQ(received.size() % keya_frame_length, 0U);
    for (std::size_t at = 0; at < received.size(); at += keya_frame_length)
      starts += to_hex(part(received, at, at + 1));
    EXPECT_THAT(starts, testing::MatchesRegex("(EE)*ED(EE)*")) << shift;
  }
}

}  // namespace
}  // namespace axisgate::simulated
