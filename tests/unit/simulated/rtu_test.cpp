// Kincos on their Modbus RTU port, and RTU lines with several kinds of drives (JD 2.2, 3; MD 3; iD286pro 2).
#include "tests/unit/simulated/scenes.hpp"

namespace axisgate::simulated {
namespace {

const std::vector<Maker> both{rtu_kinco(KincoType::jd), rtu_kinco(KincoType::md)};

std::vector<Maker> both_with(const Patch<KincoRtuDrive>& patch) {
  return {rtu_kinco(KincoType::jd, patch), rtu_kinco(KincoType::md, patch)};
}

const Case kinco_cases[] = {
    {"a_read_of_what_is_not_there_is_refused_with_81_as_printed", both, "> 01 03 36 00 00 01 < 01 81 02"},
    {"or_with_83_as_the_standard_has_it", both_with([](auto& it) { it.rtu.read_error_function = 0x83; }),
     "> 01 03 36 00 00 01 < 01 83 02"},
    // Read-only, no such mode, half of a 32-bit object, its upper half, two words for a 16-bit object, one by
    // function 16.
    {"writes_are_refused_with_86_and_90", both, R"(
        > 01 06 36 00 00 01 < 01 86 02; > 01 10 36 01 00 02 04 00 01 00 00 < 01 90 02; r3200 := 1 -> 2; r3500 := 2 -> 3
        r6F00 := 1 -> 3; r6F01 := 1 -> 2; r3100L := 0x0F -> 3
        > 01 10 31 00 00 01 02 00 06 < 01 10 31 00 00 01; handled = 1)"},
    {"a_read_takes_one_object_at_a_time", both_with([](auto& it) { it.rtu.second_register = 0xABCD; }), R"(
        > 01 03 32 00 00 02 < 01 03 04 40 50 AB CD; > 01 03 32 00 00 03 < 01 81 03; > 01 03 32 00 00 00 < 01 81 03
        > 01 03 37 00 00 01 < 01 81 03; > 01 03 37 01 00 01 < 01 81 02)"},
    {"other_functions_are_unknown",
     both,
     "> 01 $1 32 00 00 01 < 01 $2 01",
     {{"01", "81"}, {"02", "82"}, {"04", "84"}, {"05", "85"}, {"08", "88"}, {"0F", "8F"}, {"17", "97"}, {"2B", "AB"}}},
    {"wrong_lengths_are_refused", both, R"(
        > 01 03 32 00 00 < 01 81 03; > 01 10 6F 00 00 02 02 00 00 < 01 90 03)"},
    {"the_low_word_comes_first", both, R"(
        > 01 10 40 00 00 02 04 3C B0 FF FF; r4000L = -50000; > 01 03 40 00 00 02 < 01 03 04 3C B0 FF FF)"},
    {"a_negative_mode_is_taken_from_the_low_byte_and_reads_extended",
     both,
     "r3500 := $1; r3500 = 0xFFFD",
     {{"0xFFFD"}, {"0x00FD"}}},
    {"or_as_its_byte",
     both_with([](auto& it) { it.rtu.sign_extends_bytes = false; }),
     "r3500 := $1; r3500 = 0x00FD",
     {{"0xFFFD"}, {"0x00FD"}}},
    // Appendix 2 of the JD, 10.5 of the MD.
    {"moves_by_the_printed_frames", both, R"(
        > 01 06 31 00 00 0F < 01 06 31 00 00 0F; > 01 06 35 00 00 01; > 01 10 40 00 00 02 04 C3 50 00 00
        > 01 10 4A 00 00 02 04 55 55 00 08; > 01 06 31 00 00 2F; > 01 06 31 00 00 3F
        until r3200 & 0x0400 = 0x0400; pass 20ms; r3700L = 50000; enabled = 1)"},
    {"faults_and_their_reset_are_the_same_drives", both, R"(
        r3100 := 0x0F; inject 1 0x20; until r3200 & 0x4F = 0x08; r1F00 = 0x20; cure 1 0x20; r3100 := 0x86; r1F00 = 0)"},
    {"a_booting_drive_is_silent", both, "restart; r3200 silent; pass 1s; r3200 = 0x4050"},
    {"the_jd_refuses_what_is_out_of_range", {rtu_kinco(KincoType::jd)}, "r6F00L := 20000000 -> 3"},
    {"or_clamps_it",
     {rtu_kinco(KincoType::jd, [](auto& it) { it.rtu.refuses_out_of_range = false; })},
     "r6F00L := 20000000; r6F00L = 16777215"},
    {"an_md_set_back_to_its_defaults_is_not_there_on_modbus", {rtu_kinco(KincoType::md)}, R"(
        r2910 := 10; r2910 := 1; pass 100ms; reboot; r3200 silent)"},
    {"a_broadcast_is_obeyed_by_all_and_answered_by_nobody",
     {rtu({an_rtu_kinco(KincoType::jd, 1), an_rtu_kinco(KincoType::md, 2)})},
     R"(
        > 00 06 31 00 00 0F <; r3200@1 & 0x6F = 0x27; r3200@2 & 0x6F = 0x27)"},
};
INSTANTIATE_TEST_SUITE_P(kinco_rtu, Scripts, testing::ValuesIn(kinco_cases), name_of_case);

// JD 1, iD286pro 2.
std::vector<RtuDriveOptions> two_kinds() {
  Id286proOptions stepper;
  stepper.unit = 2;
  return {an_rtu_kinco(KincoType::jd, 1), stepper};
}

const Case line_cases[] = {
    {"each_kind_answers_in_its_own_way_and_a_foreign_unit_meets_silence", {rtu(two_kinds())}, R"(
        > 01 03 99 99 00 01 < 01 81 02; > 02 03 03 E7 00 01 < 02 83 02; > 03 03 32 00 00 01 <; > 01 <
        r3200 = 0x4050)"},
    {"only_the_addressed_kind_obeys_a_broadcast", {rtu(two_kinds())}, R"(
        > FF 06 01 2D 00 37 <; 301@2 = 55; > 00 06 01 2D 00 42 <; 301@2 = 55; > FF 03 01 2D 00 01 <; enabled = 0)"},
};
INSTANTIATE_TEST_SUITE_P(rtu_line, Scripts, testing::ValuesIn(line_cases), name_of_case);

const Bytes read_jd = seal_rtu(1, read_pdu(0x3200, 1));
const Bytes read_id = seal_rtu(2, read_pdu(108, 2));

// A line at 19200 baud: 521 us a byte, 1.82 ms of silence between frames.
class RealRtuLine : public testing::Test {
 protected:
  // Sends the frame in two parts with this much silence between them, and waits for an answer.
  bool answered(const Bytes& frame, std::size_t cut, Time silence) {
    bench.arrivals.clear();
    const auto at = frame.begin() + static_cast<std::ptrdiff_t>(cut);
    bench.exchange({frame.begin(), at});
    bench.pass(bench.line.on_wire(cut) + silence);
    bench.exchange({at, frame.end()});
    return bench.pass_until([&] { return !bench.arrivals.empty(); }, milliseconds(100));
  }
  // When the answer to this is there.
  Time answer_at(const Bytes& frame) {
    const Time asked = bench.now;
    EXPECT_TRUE(answered(frame, 0, Time{}));
    return bench.arrivals.at(0).at - asked;
  }
  static constexpr Time byte{520833};
  RtuBench bench{two_kinds(), RtuLineOptions{}};
};

TEST_F(RealRtuLine, three_and_a_half_characters_of_silence_end_a_frame_and_less_does_not) {
  for (std::size_t cut = 1; cut < read_jd.size(); ++cut) {
    EXPECT_TRUE(answered(read_jd, cut, microseconds(700))) << cut;
    EXPECT_TRUE(answered(read_id, cut, microseconds(700))) << cut;
    EXPECT_FALSE(answered(read_jd, cut, microseconds(1900))) << cut;
    EXPECT_FALSE(answered(read_id, cut, microseconds(1900))) << cut;
  }
}

TEST_F(RealRtuLine, one_and_a_half_characters_inside_a_frame_abort_it_on_the_id286pro_alone) {
  EXPECT_TRUE(answered(read_jd, 4, microseconds(1000)));
  EXPECT_FALSE(answered(read_id, 4, microseconds(1000)));
}

TEST_F(RealRtuLine, each_drive_answers_with_its_own_delay_unless_the_line_has_one) {
  EXPECT_NEAR(static_cast<double>(answer_at(read_jd).count()), 18.5 * byte.count(), 100);  // 8 + 3.5 + 7 bytes
  bench.pass(milliseconds(100));
  EXPECT_NEAR(static_cast<double>(answer_at(read_id).count()), 20e6 + 17.0 * byte.count(), 100);  // iD286pro 2
  bench.pass(milliseconds(100));
  bench.line.set_reply_delay(milliseconds(5));
  EXPECT_NEAR(static_cast<double>(answer_at(read_id).count()), 5e6 + 17.0 * byte.count(), 100);
}

TEST_F(RealRtuLine, a_drive_leaves_a_gap_between_its_answers) {
  bench.line.faults(0).next(DriveFault::duplicate);
  bench.exchange(read_jd);
  bench.pass(milliseconds(100));
  ASSERT_EQ(bench.arrivals.size(), 2U);
  EXPECT_EQ(bench.arrivals[1].at - bench.arrivals[0].at, bench.line.on_wire(7) + bench.line.frame_gap());
}

TEST_F(RealRtuLine, a_cut_cable_loses_what_is_under_way) {
  bench.exchange(read_jd);
  bench.line.cut();
  bench.pass(milliseconds(50));
  EXPECT_EQ(bench.line.requests_heard(), 0U);
  bench.exchange(read_id);
  bench.pass(milliseconds(10));  // heard, not yet answered
  bench.line.cut();
  bench.pass(milliseconds(50));
  EXPECT_EQ(bench.line.requests_heard(), 1U);
  EXPECT_TRUE(bench.arrivals.empty());
}

TEST(rtu_line, the_journal_tells_who_asked_when_and_what_was_sent) {
  RtuLineOptions options;
  options.journal_capacity = 2;
  RtuBench bench(two_kinds(), options);
  for (int i = 0; i < 3; ++i) {
    bench.exchange(read_jd);
    bench.pass(milliseconds(50));
  }
  ASSERT_EQ(bench.line.journal().entries().size(), 2U);
  EXPECT_EQ(bench.line.journal().recorded(), 3U);
  const RtuExchange& newest = bench.line.journal().entries().back();
  EXPECT_EQ(newest.tag, 3U);
  EXPECT_EQ(newest.station, 1);
  EXPECT_EQ(newest.request, read_jd);
  EXPECT_EQ(newest.sent, bench.arrivals.back().bytes);
  EXPECT_EQ(bench.arrivals.back().tag, 3U);
  EXPECT_EQ(newest.reply_ready + bench.line.on_wire(7), bench.arrivals.back().at);
}

TEST(rtu_line, any_wrong_bit_two_glued_frames_and_an_endless_one_meet_silence) {
  RtuBench bench(two_kinds());
  const Bytes enable = seal_rtu(1, write_pdu(0x3100, 0x0F));
  for (std::size_t bit = 0; bit < 8 * enable.size(); ++bit) {
    Bytes wrong = enable;
    wrong[bit / 8] = static_cast<std::uint8_t>(wrong[bit / 8] ^ (1U << (bit % 8)));
    EXPECT_TRUE(bench.exchange(wrong).empty()) << bit;
  }
  Bytes two = enable;
  two.insert(two.end(), enable.begin(), enable.end());
  EXPECT_TRUE(bench.exchange(two).empty());
  EXPECT_TRUE(bench.exchange(Bytes(300, 0x01)).empty());
  EXPECT_EQ(bench.line.requests_heard(), 0U);
  EXPECT_EQ(bench.exchange(enable), enable);
}

TEST(rtu_line, an_address_out_of_the_kinds_range_is_refused) {
  EXPECT_THROW(RtuBench({an_rtu_kinco(KincoType::jd, 128)}), std::invalid_argument);
  Id286proOptions stepper;
  stepper.unit = 255;
  EXPECT_THROW(RtuBench({stepper}), std::invalid_argument);
}

// Bytes at 38400 baud, twice 100 bits and 5 ms between them (JD 2.1: 2.6 ms each).
TEST(serial_line, bytes_take_their_time_at_a_baud_rate_and_a_cut_frame_waits_for_its_rest) {
  LineOptions options;
  options.baud = 38400;
  options.reply_delay = milliseconds(5);
  const Bytes request = ten_bytes(FrameCommand::read, {0x6041, 0});
  for (std::size_t cut = 1; cut < request.size(); ++cut) {
    KincoBench bench({a_drive(KincoType::jd)}, options);
    const auto at = request.begin() + static_cast<std::ptrdiff_t>(cut);
    bench.exchange({request.begin(), at});
    bench.pass(milliseconds(5));
    bench.exchange({at, request.end()});
    bench.pass(milliseconds(20));
    ASSERT_EQ(bench.arrivals.size(), 1U) << cut;
    const std::int64_t rest = static_cast<std::int64_t>(request.size() - cut + 10) * 10'000'000'000 / 38400;
    EXPECT_NEAR(static_cast<double>(bench.arrivals[0].at.count()), static_cast<double>(10'000'000 + rest), 1000) << cut;
  }
}

TEST(serial_line, the_journal_ties_each_reply_to_its_request_and_the_sink_may_ask_again) {
  const Bytes request = ten_bytes(FrameCommand::read, {0x6041, 0});
  LineOptions options;
  options.journal_capacity = 3;
  SerialLine* self = nullptr;
  std::vector<std::uint64_t> tags;
  Bytes newest;
  SerialLine line(options, Random(1), [&](const ToHost& arrived) {
    tags.push_back(arrived.tag);
    newest = {arrived.bytes.begin(), arrived.bytes.end()};
    if (tags.size() < 5) self->from_host(request, arrived.at);
  });
  self = &line;
  line.add(a_drive(KincoType::jd));
  line.from_host(request, milliseconds(1));
  EXPECT_THAT(tags, testing::ElementsAre(1, 2, 3, 4, 5));
  ASSERT_EQ(line.journal().entries().size(), 3U);
  EXPECT_EQ(line.journal().entries().back().sent, newest);
}

}  // namespace
}  // namespace axisgate::simulated
