// Every fault switch of a line does what its name says, once or by chance, and the same seed gives the same run.
#include <algorithm>
#include <set>

#include "tests/unit/simulated/scenes.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::size_t jd_frame = 10;

struct Wire {
  const char* name;
  std::function<std::unique_ptr<DriveLine>(Random, ToHostSink)> make;
  Bytes ask;    // for what the drive is doing
  Bytes other;  // for something else
  Bytes act;    // changes what it is doing
  bool act_is_answered;
  std::function<bool(const Bytes&)> whole;  // one frame with a right sum?
};

template <class Line, class Options, class Drive>
auto maker(const Options& options, const Drive& drive) {
  return [=](Random random, ToHostSink sink) {
    auto line = std::make_unique<Line>(options, random, std::move(sink));
    line->add(drive);
    return line;
  };
}

Bytes keya(KeyaFrame frame) {
  frame = seal_keya(frame);
  return {frame.begin(), frame.end()};
}

bool whole_ten(const Bytes& bytes) {
  TenByteFrame frame{};
  std::copy_n(bytes.begin(), std::min(bytes.size(), jd_frame), frame.begin());
  return bytes.size() == jd_frame && sums_to_zero(frame);
}

bool whole_keya(const Bytes& bytes) {
  KeyaFrame frame{};
  std::copy_n(bytes.begin(), std::min(bytes.size(), keya_frame_length), frame.begin());
  return bytes.size() == keya_frame_length && keya_sum(frame) == frame.back();
}

const Wire wires[] = {
    {"kinco", maker<SerialLine>(LineOptions{}, a_drive(KincoType::jd)), ten_bytes(FrameCommand::read, {0x6041, 0}),
     ten_bytes(FrameCommand::read, {0x6063, 0}), ten_bytes(FrameCommand::write_2, {0x6040, 0}, 0x0F), true, whole_ten},
    {"rtu", maker<RtuLine>(no_line_timing(), RtuDriveOptions(an_rtu_kinco(KincoType::jd))),
     seal_rtu(1, read_pdu(0x3200, 1)), seal_rtu(1, read_pdu(0x3700, 2)), seal_rtu(1, write_pdu(0x3100, 0x0F)), true,
     [](const Bytes& bytes) { return open_rtu(bytes).has_value(); }},
    // Query 7 tells the faults, of which "disabled" is one.
    {"keya", maker<KeyaLine>(KeyaLineOptions{KeyaWiring::rs485, 0, Time{}, 1000}, a_keya()),
     keya({keya_start::query, 1, 7}), keya({keya_start::query, 1, 5}), keya({keya_start::control, 1, 3}), false,
     whole_keya},
};

class FaultSwitch : public testing::TestWithParam<Wire> {
 protected:
  Bytes exchange(const Bytes& request) {
    arrivals.clear();
    line->from_host(request, now);
    return received();
  }
  Bytes ask() { return exchange(GetParam().ask); }
  Bytes ask_with(DriveFault fault) {
    faults().next(fault);
    return ask();
  }
  void pass(Time time) {
    now += time;
    line->advance(now);
  }
  Bytes received() const {
    Bytes all;
    for (const auto& arrival : arrivals) all.insert(all.end(), arrival.bytes.begin(), arrival.bytes.end());
    return all;
  }
  DriveFaults& faults() { return line->faults(0); }
  std::unique_ptr<DriveLine> make(std::uint64_t seed) {
    return GetParam().make(Random(seed), [this](const ToHost& arrived) {
      arrivals.push_back({arrived.at, arrived.tag, arrived.origin, {arrived.bytes.begin(), arrived.bytes.end()}});
    });
  }
  // Arrivals of a minute with all faults at once.
  std::vector<std::pair<Time, Bytes>> minute(std::uint64_t seed) {
    line = make(seed);
    now = Time{};
    arrivals.clear();
    for (std::size_t i = 0; i < drive_fault_count; ++i) {
      const auto fault = static_cast<DriveFault>(i);
      faults().set_rate(fault, fault == DriveFault::restart ? 0.002 : 0.05);
    }
    Random client(seed + 1);
    for (int i = 0; i < 3000; ++i) {
      line->from_host(client.chance(0.3) ? GetParam().act : GetParam().ask, now);
      pass(milliseconds(20));
    }
    std::vector<std::pair<Time, Bytes>> all;
    for (const auto& arrival : arrivals) all.emplace_back(arrival.at, arrival.bytes);
    return all;
  }

  Time now{};
  std::vector<ByteBench<SerialLine>::Arrival> arrivals;
  std::unique_ptr<DriveLine> line = make(1);
  const Bytes good = ask();
};

TEST_P(FaultSwitch, mute_neither_acts_nor_answers) {
  faults().set_rate(DriveFault::mute, 1);
  EXPECT_TRUE(exchange(GetParam().act).empty());
  EXPECT_TRUE(ask().empty());
  faults().clear();
  EXPECT_EQ(ask(), good);
}

TEST_P(FaultSwitch, a_lost_reply_comes_from_a_drive_that_acted) {
  EXPECT_TRUE(ask_with(DriveFault::lose).empty());
  if (GetParam().act_is_answered) faults().next(DriveFault::lose);
  EXPECT_TRUE(exchange(GetParam().act).empty());
  EXPECT_NE(ask(), good);
}

TEST_P(FaultSwitch, a_late_reply_tells_what_was_true_when_it_was_asked_and_delays_those_behind_it) {
  const Bytes next = exchange(GetParam().other);
  faults().late_by = milliseconds(260);
  EXPECT_TRUE(ask_with(DriveFault::late).empty());
  pass(milliseconds(100));
  line->from_host(GetParam().act, now);
  line->from_host(GetParam().other, now);
  pass(milliseconds(159));
  EXPECT_TRUE(arrivals.empty());
  pass(milliseconds(1));
  ASSERT_EQ(arrivals.size(), GetParam().act_is_answered ? 3U : 2U);
  EXPECT_EQ(arrivals.front().bytes, good);
  EXPECT_EQ(arrivals.back().bytes, next);
}

TEST_P(FaultSwitch, noise_stands_before_or_after_the_reply) {
  const Bytes before = ask_with(DriveFault::noise_before);
  ASSERT_GT(before.size(), good.size());
  EXPECT_TRUE(std::equal(good.rbegin(), good.rend(), before.rbegin()));
  const Bytes after = ask_with(DriveFault::noise_after);
  ASSERT_GT(after.size(), good.size());
  EXPECT_TRUE(std::equal(good.begin(), good.end(), after.begin()));
}

TEST_P(FaultSwitch, corrupt_flips_one_bit_so_the_sum_is_wrong) {
  const Bytes bad = ask_with(DriveFault::corrupt);
  ASSERT_EQ(bad.size(), good.size());
  int bits = 0;
  for (std::size_t i = 0; i < good.size(); ++i) bits += std::popcount(static_cast<unsigned>(good[i] ^ bad[i]));
  EXPECT_EQ(bits, 1);
  EXPECT_FALSE(GetParam().whole(bad));
}

TEST_P(FaultSwitch, half_a_reply_breaks_off) {
  if (!line->has(DriveFault::half)) return;
  const Bytes half = ask_with(DriveFault::half);
  ASSERT_LT(half.size(), good.size());
  EXPECT_TRUE(!half.empty() && std::equal(half.begin(), half.end(), good.begin()));
  pass(milliseconds(100));
  EXPECT_EQ(received(), half);
}

TEST_P(FaultSwitch, split_sends_two_pieces_with_a_gap) {
  faults().split_gap = milliseconds(4);
  EXPECT_LT(ask_with(DriveFault::split).size(), good.size());
  pass(milliseconds(4));
  EXPECT_EQ(received(), good);
  ASSERT_EQ(arrivals.size(), 2U);
  EXPECT_EQ(arrivals[1].at - arrivals[0].at, milliseconds(4));
}

TEST_P(FaultSwitch, duplicate_sends_the_reply_twice) {
  ask_with(DriveFault::duplicate);
  ASSERT_EQ(arrivals.size(), 2U);
  EXPECT_EQ(arrivals[0].bytes, good);
  EXPECT_EQ(arrivals[1].bytes, good);
}

TEST_P(FaultSwitch, wrong_station_keeps_a_right_sum) {
  const Bytes foreign = ask_with(DriveFault::wrong_station);
  EXPECT_TRUE(GetParam().whole(foreign));
  EXPECT_NE(foreign, good);
}

TEST_P(FaultSwitch, restart_takes_the_reply_and_what_the_drive_was_doing) {
  exchange(GetParam().act);
  EXPECT_NE(ask(), good);
  EXPECT_TRUE(ask_with(DriveFault::restart).empty());
  EXPECT_TRUE(ask().empty());  // it boots
  pass(milliseconds(1001));
  EXPECT_EQ(ask(), good);
}

TEST_P(FaultSwitch, a_restart_takes_away_a_reply_that_waits) {
  line->set_reply_delay(milliseconds(5));
  EXPECT_TRUE(ask().empty());
  line->restart(0, now);
  pass(milliseconds(20));
  EXPECT_TRUE(received().empty());
}

TEST_P(FaultSwitch, babble_sends_bytes_unasked_until_it_is_switched_off) {
  arrivals.clear();
  pass(milliseconds(100));
  faults().set_rate(DriveFault::babble, 1);
  pass(milliseconds(100));
  EXPECT_GE(arrivals.size(), 8U);
  for (const auto& arrival : arrivals) EXPECT_TRUE(arrival.origin == ByteOrigin::noise && arrival.tag == 0);
  faults().clear();
  arrivals.clear();
  pass(milliseconds(100));
  EXPECT_TRUE(arrivals.empty());
}

TEST_P(FaultSwitch, the_same_seed_gives_the_same_run) {
  const auto run = minute(7);
  EXPECT_EQ(minute(7), run);
  EXPECT_NE(minute(8), run);
}

INSTANTIATE_TEST_SUITE_P(lines, FaultSwitch, testing::ValuesIn(wires),
                         [](const auto& wire) { return std::string(wire.param.name); });

const Case faults_of_one_protocol[] = {
    // RTU: an older reply behind the new one without a gap; a register too many or too few; a refusal without an act.
    {"glued_puts_an_older_reply_behind_the_new_one", {rtu_kinco(KincoType::jd)}, R"(
        r3200 = 0x4050; fault glued; > 01 03 37 00 00 02
        < no single frame: 01 03 04 00 00 00 00 FA 33 01 03 02 40 50 89 B8)"},
    {"wrong_length_is_a_register_more_or_less", {rtu_kinco(KincoType::jd)}, R"(
        fault wrong-length 3; > 01 03 32 00 00 01; arrived = 9; > 01 03 37 00 00 02; arrived = 7
        > 01 06 31 00 00 0F; arrived = 10)"},
    {"an_exception_of_a_chosen_code_comes_from_a_drive_that_did_not_act", {rtu_kinco(KincoType::jd)}, R"(
        exception_code 6; fault exception 2; > 01 06 31 00 00 0F < 01 86 06; > 01 03 32 00 00 01 < 01 81 06
        enabled = 0)"},
    {"a_restart_acts_before_it_or_not",
     {rtu_kinco(KincoType::jd), ld2(), keya_serial(KeyaWiring::rs485)},
     R"(
        restart_acts $1; fault restart; command; handled = $2; restarts = 1)",
     {{"on", "1"}, {"off", "0"}}},
    {"a_heartbeat_may_come_twice", {keya_serial(KeyaWiring::rs232)}, R"(
        heartbeat 100; fault heartbeat-twice; listen; pass 200ms; arrived = 36)"},
    {"a_can_heartbeat_may_come_twice", {keya_own_can()}, "fault heartbeat-twice; listen; pass 2s; arrived = 3"},
    // CAN
    {"mute_lose_and_a_cut_plug_on_can", {ld2()}, R"(
        fault mute; 6041 silent; fault lose; 607A := 5 silent; 607A = 5
        connect 0 off; keep heard; 6041 silent; heard = kept; connect 0 on; 6041 & 0x4F = 0x40)"},
    {"late_and_duplicate_on_can", {ld2()}, R"(
        late_by 70; fault late; 6041 silent; pass 69ms; arrived = 0; pass 2ms; arrived = 1
        fault duplicate; > 601#4041600000000000 < 581#4B41600050020000 581#4B41600050020000)"},
    {"an_abort_is_not_acted_on", {ld2()}, R"(
        abort_code 0x08000021; fault exception; 607A := 5 -> 0x08000021; 607A = 0)"},
    {"a_reply_on_can_may_name_another_node_or_break_off", {ld2()}, R"(
        fault wrong-station; > 601#4041600000000000 < 582#4B41600050020000
        fault wrong-length; > 601#4041600000000000; broken_off)"},
    {"a_restart_on_can_is_silent_until_its_boot_up", {ld2()}, R"(
        fault restart; restart_acts off; 6083 := 123 silent; nmt_state = 0; pass 1100ms; < 701#00; 6083 = 10000)"},
    {"another_of_the_same_number_answers_everything_once_more", {ld2()}, R"(
        add_twin; > 601#4041600000000000; arrived = 2; > 701#R; arrived = 2; connect 1 off; > 701#R; arrived = 1)"},
    {"storms_and_babble_come_at_their_period", {ld2()}, R"(
        babble_period 2; always emergencies; pass 100ms; frames 081 50 1; newest 081#1081000000000000
        well; listen; babble_id 0x1F0; always babble; pass 100ms; frames 1F0 50 1)"},
    {"bus_off_parts_the_host_from_drives_that_live_on", {ld2()}, R"(
        1017 := 100; bus_off on; 6041 silent; pass 1s; arrived = 0; bus_off off; listen; pass 100ms; arrived = 1)"},
};
INSTANTIATE_TEST_SUITE_P(faults, Scripts, testing::ValuesIn(faults_of_one_protocol), name_of_case);

TEST(faults, each_has_a_name_that_is_found_again) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < drive_fault_count; ++i) {
    const auto fault = static_cast<DriveFault>(i);
    names.insert(name_of(fault));
    EXPECT_EQ(drive_fault_named(name_of(fault)), fault);
  }
  EXPECT_EQ(names.size(), drive_fault_count);
  EXPECT_EQ(drive_fault_named("deaf"), std::nullopt);
}

TEST(faults, the_generator_gives_these_numbers_everywhere) {
  EXPECT_EQ(Random(1).next(), 0xB3F2AF6D0FC710C5U);
  EXPECT_EQ(Random(1).below(1000), 0xB3F2AF6D0FC710C5U % 1000);
}

TEST(faults, a_babbling_rtu_drive_sends_whole_frames_too_and_no_read_reply_among_them) {
  RtuBench bench({an_rtu_kinco(KincoType::jd)});
  bench.pass(milliseconds(100));
  bench.line.faults(0).set_rate(DriveFault::babble, 1);
  bench.pass(seconds(2));
  int frames = 0;
  for (const auto& arrival : bench.arrivals) {
    const auto frame = open_rtu(arrival.bytes);
    if (!frame) continue;
    EXPECT_EQ(frame->pdu[0], function::write_one);
    ++frames;
  }
  EXPECT_NEAR(frames, 100, 50);
}

TEST(faults, the_same_seed_gives_the_same_run_on_can) {
  const auto run = [](std::uint64_t seed) {
    CanBench bench({a_leadshine(1), a_can_kinco(KincoType::jd, 2)}, CanLineOptions{}, seed);
    for (std::size_t i = 0; i < drive_fault_count; ++i) {
      bench.line.faults(0).set_rate(static_cast<DriveFault>(i), 0.1);
      bench.line.faults(1).set_rate(static_cast<DriveFault>(i), 0.1);
    }
    for (int i = 0; i < 300; ++i) {
      bench.send(bus_frame(cob::sdo_request + 1 + static_cast<std::uint32_t>(i % 2), sdo_request(0x40, {0x6041, 0})));
      bench.pass(milliseconds(7));
    }
    return bench.line.journal().hash();
  };
  EXPECT_EQ(run(5), run(5));
  EXPECT_NE(run(5), run(6));
}

}  // namespace
}  // namespace axisgate::simulated
