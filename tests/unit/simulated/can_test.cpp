// Simulated CANopen nodes: CiA 301's side of them, their PDOs, the bus, and the Leadshine LD2-CAN itself (LD2 1 to 9;
// MD 4).
#include "tests/simulated/lawicel_line.hpp"
#include "tests/simulated/socket_can_line.hpp"
#include "tests/unit/simulated/scenes.hpp"

namespace axisgate::simulated {
namespace {

const Case nodes[] = {
    {"a_stopped_node_answers_guarding_and_no_sdo", {ld2()}, R"(
        nmt 02; nmt_state = 4; 6041 silent; > 701#R < 701#04; nmt 80; 6041 & 0x4F = 0x40)"},
    {"a_restarted_node_is_silent_until_its_boot_up", {ld2()}, R"(
        nmt 01; listen; nmt 81; nmt_state = 0; pass 990ms; 6041 silent; > 701#R <; pass 20ms; < 701#00
        nmt_state = 127; restarts = 1)"},
    {"an_nmt_command_of_eight_bytes_or_for_another_node_has_no_effect", {ld2()}, R"(
        > 000#0100000000000000; > 000#0102; nmt 77; nmt_state = 127; > 000#0100; nmt_state = 5)"},
    // 3002h saves everything; 3003h then tells so.
    {"a_reset_of_the_communication_brings_back_what_was_saved_and_leaves_the_drive", {ld2()}, R"(
        1017 := 200; 6083 := 77; nmt 82; 1017 = 0; 6083 = 77; 1017 := 300; 3002 := 0x5A5A; 3003 = 0; pass 60ms
        3003 = 0x5A5A; 3002 = 0; nmt 81; pass 1100ms; 1017 = 300; 6083 = 77)"},
    {"heartbeats_come_at_their_period_and_tell_the_state", {can_kinco(KincoType::jd)}, R"(
        listen; pass 5s; arrived = 0; 1017 := 100; nmt 01; listen; pass 1s; frames 701 10; newest 701#05)"},
    {"guarding_answers_toggle", {can_kinco(KincoType::md)}, R"(
        > 701#R < 701#7F; > 701#R < 701#FF; > 701#R < 701#7F; nmt 82; > 701#R < 701#7F)"},
    // Watching begins with the first heartbeat.
    {"an_ld2_without_its_master_raises_8130_and_leaves_operational", {ld2()}, R"(
        1016.01 := 0x7F012C; nmt 01; enable; pass 2s; 6041 & 0x6F = 0x27; repeat 10 > 77F#05
        pass 250ms; > 77F#05; pass 250ms; > 77F#05; pass 250ms; 6041 & 0x6F = 0x27; listen; pass 60ms
        < 081#3081100000000000
        6041 & 0x4F = 0x08; nmt_state = 127; 603F = 0x8130; 1001 = 0x10; 3010 = 0x903; 1003.01 = 0x8130
        control 80; among 081#0000000000000000; 603F = 0)"},
    // The life time begins with the first request.
    {"an_md_stops_without_guarding_only_where_6007_is_set",
     {can_kinco(KincoType::md)},
     R"(
        100C = 1000; 100D = 3; 100C := 100; 6007 := $1; nmt 01; control 0F; pass 1s; > 701#R; pass 290ms; enabled = 1
        pass 20ms; enabled = $2)",
     {{"0", "1"}, {"1", "0"}}},
    {"a_jd_obeys_no_controlword_before_a_six", {can_kinco(KincoType::jd)}, R"(
        6040 := 0x0F; enabled = 0; control 06 0F; enabled = 1; control 06; nmt 82; 6040 := 0x0F; enabled = 0)"},
    {"an_md_obeys_it", {can_kinco(KincoType::md)}, "control 0F; enabled = 1"},
    {"refusals_carry_the_abort_codes_of_the_sheets", {ld2()}, R"(
        9999:2 := 1 -> 0x06020000; 6083.07:4 := 1 -> 0x06090011; 1018.09:4 := 1 -> 0x06090011
        1018.01:4 := 1 -> 0x06010002; 6041:2 := 1 -> 0x06010002; 6083:2 := 1 -> 0x06070010; 6083 := 0 -> 0x06090030
        6060 := 12 -> 0x06090030; 100C:2 := 1 -> 0x06020000)"},
    {"a_wrong_width_may_be_refused_as_printed",
     {ld2([](auto& it) { it.mismatch_abort = 0x06060010; })},
     "6083:2 := 1 -> 0x06060010"},
    {"identity_and_texts_are_those_of_the_options",
     {ld2([](auto& it) {
       it.identity = {1, 2, 3, 4};
     })},
     R"(
        1018 = 4; 1018.02 = 2; 1018.04 = 4; 1000 = 0x20192; 1014 = 0x81
        > 601#4008100000000000 < 581#410810000B000000)"},
    // JD 8.3, MD 10.3: six bytes for objects of two bytes or less.
    {"short_frames_are_accepted_and_sent_where_switched_on",
     {can_kinco(KincoType::jd, [](auto& it) { it.can.short_frames = true; }),
      can_kinco(KincoType::md, [](auto& it) { it.can.short_frames = true; })},
     R"(
        > 601#2B4060000600 < 581#604060000600; > 601#2F6060000600 < 581#606060000600
        > 601#237A600050C30000 < 581#607A600050C30000; > 601#40606000 < 581#4F6060000600)"},
};

// TPDO1 of statusword and position; $1 and $2: type, inhibit time.
#define MAPPED_STATUS(position)                                                      \
  "1800.01 := 0x80000181; 1A00.00 := 0; 1A00.01 := 0x60410010; 1A00.02 := " position \
  "; 1A00.00 := 2; 1800.02 := $1; 1800.03 := $2; 1800.01 := 0x181;"

const Case pdos[] = {
    // Refused: while on; the second is empty; has an entry; operational.
    {"a_mapping_changes_only_while_its_pdo_is_off_and_empty_and_the_node_pre_operational", {ld2()}, R"(
        1A00.01 := 0x60410010 -> 0x08000022; 1800.01 := 0x80000181; 1A00.01 := 0x60410010; 1A00.00 := 2 -> 0x06020000
        1A00.00 := 1; 1A00.01 := 0x60640020 -> 0x08000022; 1A00.00 := 0; nmt 01; 1A00.01 := 0x60640020 -> 0x08000022)"},
    // As printed; as chosen; not its width; no such object; read-only in an RPDO; too long; no such entry.
    {"what_cannot_be_mapped_is_refused",
     {ld2([](auto& it) {
       it.unmappable = {{0x606C, 0}};
     })},
     R"(
        1800.01 := 0x80000181; 1A00.01 := 0x605A0010 -> 0x06040041; 1A00.01 := 0x606C0020 -> 0x06040041
        1A00.01 := 0x60640010 -> 0x06040041; 1A00.01 := 0x99990010 -> 0x06020000
        1400.01 := 0x80000201; 1600.01 := 0x60410010 -> 0x06040041
        1A00.01 := 0x60640020; 1A00.02 := 0x60640020; 1A00.03 := 0x60640020; 1A00.00 := 3 -> 0x06040042
        1A00.09 := 0 -> 0x06090011)"},
    {"types_timers_and_identifiers_of_an_ld2", {ld2()}, R"(
        1800.02 := 254 -> 0x06090030; 1800.02 := 241 -> 0x06090030; 1800.02 := 255; 1800.05:2 := 100 -> 0x06090011
        1800.01 := 0x43F -> 0x08000022; 1800.01 := 0x80000181; 1800.01 := 0x701 -> 0x06090030; 1800.01 := 0x43F
        1804.01:4 := 0 -> 0x06020000)"},
    {"types_timers_and_identifiers_of_a_jd", {can_kinco(KincoType::jd)}, R"(
        1800.02 := 254; 1800.05:2 := 100 -> 0x06090011; 1807.01 != 0)"},
    {"an_event_driven_pdo_is_sent_at_the_start_and_on_each_change_but_not_within_its_inhibit_time",
     {ld2()},
     MAPPED_STATUS("0x60640020") R"(
        listen; pass 50ms; arrived = 0; nmt 01; < 181#500200000000; listen; pass 50ms; arrived = 0
        enable; listen; pass 4ms; arrived = 0; pass 2ms; arrived = 1; newest 181#370200000000
        nmt 80; listen; control 06; pass 50ms; frames 181 0)",
     {{"255", "50"}}},
    {"an_md_sends_by_its_event_timer_and_counts_inhibit_time_in_milliseconds",
     {can_kinco(KincoType::md)},
     MAPPED_STATUS("0x60630020") R"(
        1800.05 := 100; nmt 01; listen; pass 1s; frames 181 10
        control 0F; listen; control 06; pass 18ms; frames 181 0; pass 3ms; frames 181 1)",
     {{"255", "20"}}},
    // Type 3: each third. Type 0: once after a change.
    {"synchronous_pdos_follow_sync_and_a_remote_frame_asks_for_one",
     {ld2()},
     MAPPED_STATUS("0x60640020") R"(
        nmt 01; > 080# 080# 080# 080# 080# 080# 080# 080# 080#; frames 181 3; > 181#R; frames 181 1
        nmt 80; 1800.02 := 0; nmt 01; > 080# 080# 080#; frames 181 1; control 06; > 080# 080# 080#; frames 181 1)",
     {{"3", "0"}}},
    {"a_received_pdo_writes_its_objects_at_once_or_with_the_next_sync",
     {ld2()},
     R"(
        1400.01 := 0x80000201; 1400.02 := $1; 1600.00 := 0; 1600.01 := 0x60400010; 1600.02 := 0x607A0020; 1600.00 := 2
        1400.01 := 0x201; nmt 01; > 201#0600204E0000; 607A = $2; > 080#; 607A = 20000; 6041 & 0x6F = 0x21
        > 201#0700214E00 080#; 607A = 20000)",
     {{"255", "20000"}, {"1", "0"}}},
};

void ack(LeadshineOptions& it) { it.acknowledges_setpoints = true; }

// 1500 rpm are 250000 units/s at 10000 units per revolution (4.3); "ramps" has them reached and left in a second.
const Case leadshine[] = {
    {"goes_through_the_states_of_the_manual_and_skips_none", {ld2()}, R"(
        6041 & 0x4F = 0x40; control 0F; 6041 & 0x4F = 0x40; control 06; 6041 & 0x6F = 0x21; control 07
        6041 & 0x6F = 0x23
        control 0F; 6041 & 0x6F = 0x27; control 07; 6041 & 0x6F = 0x23; control 06; 6041 & 0x6F = 0x21
        transitions = 6)"},
    {"holds_the_printed_defaults", {ld2()}, R"(
        6083 = 10000; 6084 = 10000; 6085 = 10000000; 6080 = 5000; 6072 = 3000; 6092.01 = 10000; 6502 = 0x2D; 1017 = 0
        6061 = 8; 1A00 = 0)"},
    {"the_worked_example_moves_two_revolutions_and_bit_12_says_nothing", {ld2()}, R"(
        ramps
        enable; 6060 := 1; 6081 := 250000; 607A := 20000; control 4F; pass 20ms; 6064 = 0; control 5F; 6041 & 0x1400 = 0
        until 6041 & 0x400 = 0x400; 6064 = 20000; 6041 = 0x0637; control 4F 5F; until 6041 & 0x400 = 0x400
        6064 = 40000)"},
    {"bit_12_acknowledges_setpoints_where_chosen", {ld2(ack)}, R"(
        enable; 6060 := 1; 607A := 100; control 1F; 6041 & 0x1000 = 0x1000; control 0F; 6041 & 0x1000 = 0)"},
    {"object_3001_tells_that_an_immediate_move_may_begin", {ld2()}, R"(
        enable; 6060 := 1; 3001 = 0; control 2F; 3001 = 0x20; 607A := 500; control 3F; 3001 = 0
        until 6041 & 0x400 = 0x400; 6064 = 500)"},
    {"a_stop_from_1500_rpm_takes_25_seconds_with_the_factorys_deceleration", {ld2()}, R"(
        enable; 6060 := 3; 6083 := 250000; 60FF := 250000; pass 1100ms; 606C ~ 250000 100; 5501.01 = 1500
        60FF := 0; pass 24s; 606C > 0; pass 2s; 606C = 0; 6041 & 0x1000 = 0x1000)"},
    {"halt_stops_a_velocity_and_its_end_goes_on", {ld2()}, R"(
        ramps
        enable; 6060 := 3; 60FF := 25000; pass 500ms; 606C ~ 25000 100; control 10F; pass 500ms; 606C = 0
        6041 & 0x6F = 0x27
        control 0F; pass 500ms; 606C ~ 25000 100)"},
    {"velocity_may_need_the_edge_of_a_halt", {ld2([](auto& it) { it.needs_halt_edge = true; })}, R"(
        ramps
        enable; 6060 := 3; 60FF := 25000; pass 500ms; 606C = 0; control 10F 0F; pass 500ms; 606C ~ 25000 100)"},
    {"torque_follows_its_slope_and_the_speed_limit", {ld2()}, R"(
        enable; 6060 := 4; 6087 := 1000; 6080 := 300; 6071 := 500; pass 250ms; 6077 ~ 250 2; 6041 & 0x400 = 0
        pass 2s; 6077 = 500; 6041 & 0x400 = 0x400; 5501.01 = 300)"},
    // 15 is a method that the manual lists as not supported.
    {"homing_finds_the_switch_and_says_so",
     {ld2([](auto& it) {
       it.mechanics.home_from = -9000;
       it.mechanics.home_to = -5000;
     })},
     R"(
        enable; 6060 := 6; 6099.01 := 30000; 6099.02 := 20000; 609A := 300000; 6098 := 22; control 1F; 6041 & 0x3000 = 0
        until 6041 & 0x1000 = 0x1000; 6064 = 0; 6098 := 15; control 0F 1F; pass 10ms; 6041 & 0x2000 = 0x2000)"},
    {"methods_35_and_37_need_no_motion_and_no_torque",
     {ld2()},
     R"(
        enable; 6060 := 1; 607A := 700; control 1F; until 6041 & 0x400 = 0x400; control 06; pass 10ms
        6060 := 6; 6098 := $1; control 16; 6064 = 0; 6041 & 0x1000 = 0x1000)",
     {{"35"}, {"37"}}},
    // 6092h is the encoder's: the gear counts; then 6092h; then 2008h.
    {"a_revolution_is_pr008_or_the_feed_constant_or_the_gear", {ld2()}, R"(
        revolution = 10000; 6091.02 := 2; revolution = 20000; 6092.01 := 5000; revolution = 5000; 2008 := 3600
        revolution = 3600; enable; 6060 := 1; 6092.01 := 6000 -> 0x08000022; 6083 := 100000; 6084 := 100000
        607A := 3600
        control 1F; until 6041 & 0x400 = 0x400; 6063 = 10000)"},
    // 6084h takes a second, the others 25 ms and less.
    {"a_quick_stop_ends_where_its_option_says",
     {ld2()},
     R"(
        ramps
        605A := $1; enable; 6060 := 3; 60FF := 250000; pass 1100ms; control 02; 6041 & 0x6F = 0x07; pass 100ms
        606C $2 0
        pass 1s; 6041 & $3; 606C = 0)",
     {{"1", ">", "0x4F = 0x40"},
      {"2", "=", "0x4F = 0x40"},
      {"3", "=", "0x4F = 0x40"},
      {"5", ">", "0x6F = 0x07"},
      {"6", "=", "0x6F = 0x07"},
      {"7", "=", "0x6F = 0x07"}}},
    {"an_alarm_is_cleared_by_a_rising_bit_7_once_its_cause_is_gone", {ld2()}, R"(
        enable; inject 0x2211; 6041 & 0x4F = 0x08; 603F = 0x2211; 1001 = 2; control 80; 6041 & 0x4F = 0x08; cure
        control 80; 6041 & 0x4F = 0x08; control 00 80; 6041 & 0x4F = 0x40; 603F = 0)"},
    {"or_by_4000", {ld2()}, R"(
        enable; inject 0x2211; 4000 := 1; 6041 & 0x4F = 0x08; cure; 4000 := 1; 6041 & 0x4F = 0x40; 603F = 0)"},
    {"a_jammed_motor_raises_an_alarm", {ld2()}, R"(
        ramps
        2014 := 5; enable; 6060 := 3; jam; 60FF := 250000; until 6041 & 0x4F = 0x08; 603F = 0x8611)"},
    {"limits_stop_the_motor_and_show_in_60fd",
     {ld2([](auto& it) {
       it.mechanics.negative_limit = -20000;
       it.mechanics.positive_limit = 20000;
     })},
     R"(
        ramps
        enable; 6060 := 3; 60FD & 3 = 0; 60FF := 50000; pass 3s; 606C = 0; 60FD & 3 = 2; 6041 & 0x0800 = 0x0800)"},
};

INSTANTIATE_TEST_SUITE_P(canopen, Scripts, testing::ValuesIn(nodes), name_of_case);
INSTANTIATE_TEST_SUITE_P(can_pdos, Scripts, testing::ValuesIn(pdos), name_of_case);
INSTANTIATE_TEST_SUITE_P(leadshine, Scripts, testing::ValuesIn(leadshine), name_of_case);

// A frame at 1 Mbit/s: 111 bits and 24 of stuffing at most.
constexpr Time frame_at_1m = microseconds(135);

CanLineOptions one_megabit() {
  CanLineOptions options;
  options.bit_rate = 1000000;
  return options;
}

const BusFrame read_status = bus_frame(cob::sdo_request + 1, sdo_request(0x40, {0x6041, 0}));

TEST(can_line, a_frame_takes_its_bits_and_a_drive_its_time_and_a_cut_cable_loses_it) {
  CanBench bench({a_leadshine()}, one_megabit());
  bench.send(read_status);
  bench.pass(milliseconds(10));
  ASSERT_EQ(bench.received.size(), 1U);
  EXPECT_EQ(bench.received[0].at, frame_at_1m + milliseconds(1) + frame_at_1m);
  EXPECT_EQ(bench.received[0].tag, 1U);
  bench.send(read_status);
  bench.pass(microseconds(500));
  bench.line.cut();
  bench.pass(milliseconds(5));
  EXPECT_EQ(bench.received.size(), 1U);
}

TEST(can_line, the_lowest_identifier_of_those_that_wait_goes_first_whatever_is_spoken) {
  CanLineOptions options = one_megabit();
  options.reply_delay = Time{};
  CanBench bench({a_leadshine(3), a_leadshine(2), KeyaCanDrive{a_keya()}}, options);
  bench.send(bus_frame(cob::nmt, {0x82, 0}));  // all answer it at the same instant
  bench.pass(milliseconds(5));
  BusFrame query = bus_frame(keya_can::command + 1, from_hex("40 00 21 01 00 00 00 00"));
  query.extended = true;
  bench.send(query);
  bench.send(bus_frame(cob::sdo_request + 2, sdo_request(0x40, {0x6041, 0})));
  bench.pass(milliseconds(5));
  std::vector<std::uint32_t> ids;
  for (const CanToHost& frame : bench.received) ids.push_back(frame.frame.id);
  EXPECT_THAT(ids, testing::ElementsAre(0x702, 0x703, keya_can::reply + 1, cob::sdo_reply + 2));
  EXPECT_EQ(bench.received[0].tag, 0U);
  EXPECT_EQ(bench.line.keya(1), nullptr);
  EXPECT_THROW((void)bench.line.node(2), std::invalid_argument);
}

TEST(can_line, the_journal_ties_each_reply_to_its_request) {
  CanBench bench({a_leadshine()});
  bench.sdo(sdo_request(0x40, {0x6041, 0}));
  bench.sdo(sdo_request(0x40, {0x6064, 0}));
  bench.send(bus_frame(cob::nmt, {1, 1}));  // is no request
  ASSERT_EQ(bench.line.journal().entries().size(), 2U);
  const CanExchange& second = bench.line.journal().entries().back();
  EXPECT_EQ(second.station, 1);
  EXPECT_EQ(second.request, from_hex("01 06 40 64 60 00 00 00 00 00"));
  EXPECT_EQ(second.sent, from_hex("81 05 43 64 60 00 00 00 00 00"));
}

TEST(can_line, a_request_while_a_reply_is_owed_is_counted) {
  CanBench bench({a_leadshine(1), a_leadshine(2)}, one_megabit());
  const auto after = [&](const BusFrame& frame, Time time) {
    bench.send(frame);
    bench.pass(time);
    return bench.line.overlapping_requests();
  };
  EXPECT_EQ(after(read_status, milliseconds(5)), 0U);
  EXPECT_EQ(after(read_status, microseconds(500)), 0U);
  EXPECT_EQ(after(bus_frame(cob::sdo_request + 2, sdo_request(0x40, {0x6041, 0})), milliseconds(5)), 1U);
  EXPECT_EQ(after(bus_remote_frame(cob::error_control + 2), microseconds(200)), 1U);  // guarding is no SDO
  EXPECT_EQ(after(read_status, milliseconds(5)), 1U);
}

TEST(can_line, refuses_a_node_that_cannot_be) {
  EXPECT_THROW(CanBench({a_leadshine(0)}), std::invalid_argument);
  EXPECT_THROW(CanBench({a_leadshine(128)}), std::invalid_argument);
}

// An adapter as a scene: "> S6|" sends S6 and CR; BELL is written as !.
Scene lawicel(const LawicelOptions& adapter) {
  struct Port {
    explicit Port(const LawicelOptions& adapter)
        : line(no_can_timing(), adapter, Random(1),
               [this](const ToHost& it) { heard.append(it.bytes.begin(), it.bytes.end()); }) {
      line.bus().add(a_leadshine());
    }
    Time now{};
    std::string heard;
    LawicelLine line;
  };
  const auto port = std::make_shared<Port>(adapter);
  Scene scene;
  scene.send = [port](std::string text) {
    std::ranges::replace(text, '|', '\r');
    port->heard.clear();
    port->line.from_host({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, port->now);
  };
  scene.received = [port] {
    std::string text = port->heard;
    std::ranges::replace(text, '\r', '|');
    std::ranges::replace(text, '\a', '!');
    return text;
  };
  scene.pass = [port](Time time) { port->line.advance(port->now += time); };
  scene.acts["bus_off"] = [port](const Row& words) { port->line.set_bus_off(words[0] == "on", port->now); };
  scene.acts["no_acknowledge"] = [port](const Row&) { port->line.miss_acknowledge(port->now); };
  scene.acts["cut"] = [port](const Row&) { port->line.cut(); };
  scene.facts["rate"] = [port] { return port->line.bus().bit_rate(); };
  scene.phrases["open"] = "> S6|O| < ||; timeless";
  scene.acts["timeless"] = [port](const Row&) { port->line.bus().set_bit_rate(0); };
  return scene;
}

Scene adapter(const Row&) { return lawicel({}); }
Scene silent_adapter(const Row&) { return lawicel({.acknowledges = false, .has_flags = false}); }

const Case adapters[] = {
    {"nothing_passes_until_the_channel_is_open", {adapter}, R"(
        > t60184041600000000000| < !; > O| < !; > C| < !; > S6|O| < ||; rate = 500000; > S4| < !; > O| < !
        > t60184041600000000000| < z|; > C| < |; > r7011| < !)"},
    {"frames_are_text_both_ways", {adapter}, R"(
        open; > t60184041600000000000| < t58184B41600050020000|z|; > r7011| < t70117F|z|)"},
    {"what_is_no_frame_is_refused",
     {adapter},
     "open; > $1| < !; > V| < V1013|; > | < |",
     {{"t601"}, {"t6019"}, {"t60124041604"}, {"t6012404"}, {"t60Z0"}, {"tF010 "}, {"Q"}, {std::string(100, 't')}}},
    {"flags_tell_bus_off_and_missing_acknowledges_until_they_are_read", {adapter}, R"(
        open; > F| < F00|; bus_off on; > F| < FA0|; bus_off off; > F| < FA0|; > F| < F00|; no_acknowledge
        > F| < FA4|)"},
    {"timestamps_follow_the_data", {adapter}, "> Z1| < |; open; pass 61234ms; > r7011| < t70117F04D2|z|"},
    {"a_pulled_cable_takes_its_power", {adapter}, "open; cut; > O| < !"},
    {"an_adapter_that_never_acknowledges_carries_frames_all_the_same", {silent_adapter}, R"(
        > S6|O| <; timeless; > F| <; > t60184041600000000000| < t58184B41600050020000|)"},
};
INSTANTIATE_TEST_SUITE_P(lawicel, Scripts, testing::ValuesIn(adapters), name_of_case);

TEST(lawicel, a_line_is_understood_however_it_is_split) {
  const std::string request = "t60184041600000000000|";
  for (std::size_t cut = 0; cut <= request.size(); ++cut) {
    Scene scene = adapter({});
    run(scene, "open");
    scene.send(request.substr(0, cut));
    const std::string first = scene.received();
    scene.send(request.substr(cut));
    EXPECT_EQ(first + scene.received(), "t58184B41600050020000|z|") << cut;
  }
}

// <linux/can.h>, <linux/can/error.h>
TEST(socket_can, frames_have_the_layout_of_the_kernels_header) {
  BusFrame extended = bus_frame(0x12345678, {9});
  extended.extended = true;
  for (const auto& [frame, hex] :
       {std::pair{bus_frame(0x581, {1, 2, 3}), "81 05 00 00 03 00 00 00 01 02 03 00 00 00 00 00"},
        {bus_remote_frame(0x701), "01 07 00 40 01 00 00 00 00 00 00 00 00 00 00 00"},
        {extended, "78 56 34 92 01 00 00 00 09 00 00 00 00 00 00 00"}}) {
    EXPECT_EQ(to_hex(socket_frame_of(frame)), to_hex(from_hex(hex)));
    EXPECT_EQ(frame_of_socket(from_hex(hex)), frame);
  }
  EXPECT_EQ(frame_of_socket(from_hex("40 00 00 20 08 00 00 00 00 00 00 00 00 00 00 00")), std::nullopt);
  EXPECT_EQ(frame_of_socket(from_hex("40")), std::nullopt);
}

TEST(socket_can, bus_off_is_told_by_error_frames) {
  std::vector<Bytes> heard;
  SocketCanLine line(no_can_timing(), Random(1), [&heard](const ToHost& it) {
    heard.push_back({it.bytes.begin(), it.bytes.end()});
  });
  line.bus().add(a_leadshine());
  line.from_host(socket_frame_of(bus_remote_frame(0x701)), Time{});
  line.set_bus_off(true, Time{});
  line.from_host(socket_frame_of(bus_remote_frame(0x701)), Time{});
  line.set_bus_off(false, Time{});
  line.miss_acknowledge(Time{});
  EXPECT_THAT(heard, testing::ElementsAre(from_hex("01 07 00 00 01 00 00 00 7F 00 00 00 00 00 00 00"),
                                          from_hex("40 00 00 20 08 00 00 00 00 00 00 00 00 00 00 00"),
                                          from_hex("00 01 00 20 08 00 00 00 00 00 00 00 00 00 00 00"),
                                          from_hex("24 00 00 20 08 00 00 00 00 20 00 00 00 00 00 00")));
}

}  // namespace
}  // namespace axisgate::simulated
