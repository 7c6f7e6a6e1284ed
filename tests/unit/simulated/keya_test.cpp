// The simulated Keya KYDAS4860-2E: watchdog, motors, faults, each point its manual leaves open, and each of its
// interfaces. Its own CAN protocol: 200D.01 enables motor A, 200C disables, 2000 is a speed, 2001 a torque, 2002 a
// position. In CANopen mode the codes 030D2001h (enable A, speed), 030C2001h (disable A) and others are written to 607A
// (A) and 6083 (B).
#include "tests/unit/simulated/scenes.hpp"

namespace axisgate::simulated {
namespace {

constexpr KeyaWiring rs232 = KeyaWiring::rs232, rs485 = KeyaWiring::rs485;

// TPDOs come after their periods alone.
KeyaOptions periodic(std::map<int, std::int64_t> parameters = {}) {
  KeyaOptions options = a_keya(std::move(parameters));
  options.pdo_on_change = false;
  return options;
}

// 0.1 s up, 0.2 s down, brake after 1 s; 25 turns/s at 5 turns/s^2 would take 5 s. The row's first word: does it ramp?
Scene lost_motor(const Row& row) {
  KeyaOptions options = a_keya({{13, 1}, {30, 2}, {27, 10}});
  options.loss_stop = row.at(0) == "1" ? KeyaStop::ramp : KeyaStop::coast;
  options.mechanics.coasting_rps_per_s = 5;
  return keya_own_can(options)(row);
}

Scene enable_with_zero(const Row& row) {
  KeyaOptions options = periodic({{20, 3}});
  options.enable_with_zero_moves = row.at(0) == "1";
  return keya_canopen(options)(row);
}

const Case keya_drive_cases[] = {
    {"on_can_the_watchdog_trips_after_1000_ms_without_a_command_and_not_before", {keya_own_can()}, R"(
        200D.01 := 1; 2000.01 := 5000; pass 999ms; a.faults = 0; 2000.01 := 5000; pass 1s; trips = 0; pass 1ms
        trips = 1
        a.faults = 0x4001; b.faults = 0x4001; a.enabled = 0; 2112.01 = 0x40014001)"},
    {"after_it_a_command_moves_nothing_until_a_new_enable", {keya_own_can()}, R"(
        200D.01 := 1; 2000.01 := 5000; pass 5s; a.rpm = 0; 2000.01 := 5000; pass 500ms; a.rpm = 0; 200D.01 := 1
        a.faults = 0
        pass 500ms; a.rpm = 0; 2000.01 := 5000; pass 500ms; a.rpm > 0; trips = 1)"},
    {"a_command_to_one_motor_feeds_both", {keya_own_can()}, R"(
        200D.01 := 1; 200D.02 := 1; pass 900ms; 2000.02 := 0; pass 900ms; 2000.02 := 0; pass 900ms; a.enabled = 1
        trips = 0)"},
    {"queries_feed_it_only_where_a_test_wants_that",
     {keya_own_can_if(&KeyaOptions::queries_feed_watchdog)},
     R"(
        200D.01 := 1; pass 900ms; > 40 03 21 01 00 00 00 00; arrived = 1; pass 900ms; a.enabled = $1; trips = $2)",
     {{"1", "0"}, {"0", "1"}}},
    {"it_sleeps_while_no_motor_is_enabled",
     {keya_own_can()},
     "200D.01 := 1; 200C.01 := 1; pass 10s; trips = 0; a.faults = 1"},
    {"on_rs232_it_is_fault_sixteen", {keya_serial(rs232)}, R"(
        control 3 1000 1000; pass 999ms; trips = 0; pass 2ms; a.faults = 0x8001; b.faults = 0x8001)"},
    {"on_rs485_there_is_none", {keya_serial(rs485)}, "control 3 1000 1000; pass 60s; a.faults = 0; a.rpm = 150"},
    {"a_lost_motor_coasts_or_ramps_down_and_the_brake_falls",
     {lost_motor},
     R"(
        200D.01 := 1; 2000.01 := 10000; pass 1001ms; trips = 1; count a 0; pass 900ms; a.rpm $2 0; pass 200ms; a.rpm = 0
        a.count $3)",
     {{"1", "=", "< 40000"}, {"0", ">", "> 120000"}}},
    {"a_speed_ramps_up_in_the_time_of_parameter_0013", {keya_own_can(a_keya({{13, 10}, {2, 3000}}))}, R"(
        200D.01 := 1; 2000.01 := -10000; pass 500ms; a.rpm ~ -1500 10; pass 490ms; 2000.01 := -10000; pass 20ms
        a.rpm = -3000)"},
    {"torque_turns_a_motor_that_is_in_torque_mode_alone", {keya_own_can(a_keya({{20, 2}}))}, R"(
        200D.01 := 1; 200D.02 := 1; 2001.01 := -8000; 2001.02 := -8000; 2000.01 := 5000; pass 100ms
        a.rpm < 0; a.current = 12; b.rpm = 0)"},
    {"absolute_positions_are_reached_exactly_and_repeating_them_moves_nothing", {keya_own_can(in_mode(3))}, R"(
        count a -500; 200D.01 := 1; 2002.01 := 50000; pass 500ms; 2002.01 := 50000; pass 900ms; 2002.01 := 50000
        pass 900ms
        2002.01 := 50000; pass 900ms; a.count = 50000; a.moves = 1)"},
    // A command to the other motor, which is disabled, feeds the watchdog.
    {"the_same_relative_position_again_is_another_move_unless_a_test_says_no",
     {keya_own_can_if(&KeyaOptions::repeated_move_moves, in_mode(4))},
     R"(
        200D.02 := 1; repeat 3 2002.02 := -18000; pass 900ms; 2002.01 := 0; pass 900ms; 2002.01 := 0; pass 900ms
        b.count = $2; b.moves = $3)",
     {{"1", "-54000", "3"}, {"0", "-18000", "1"}}},
    // A second zero is a command in either reading.
    {"a_zero_in_the_enabling_frame_is_a_move_to_zero_unless_a_test_says_no",
     {keya_serial_if(&KeyaOptions::enable_with_zero_moves, rs485, in_mode(3))},
     R"(
        count a 7000; control 1; pass 5s; a.count = $2; control 1; pass 5s; a.count = 0)",
     {{"1", "0"}, {"0", "7000"}}},
    {"code_one_disables_motor_b_unless_a_test_says_no",
     {keya_serial_if(&KeyaOptions::code_disables_other, rs232)},
     R"(
        control 3 1000 2000; control 1 1000 2000; a.enabled = 1; b.enabled = $2; control 2 1000 2000; a.enabled = $2
        b.enabled = 1; control 0; a.enabled = 0; b.enabled = 0)",
     {{"1", "0"}, {"0", "1"}}},
    // The nine rows of the manual: given to A and B, of motor 1 and 2. Motor A enables both.
    {"mixed_mode_executes_the_rows_of_the_manual",
     {keya_own_can(a_keya({{17, 1}}))},
     R"(
        200D.01 := 1; b.enabled = 1; 2000.01 := $1; 2000.02 := $2; a.value = $3; b.value = $4)",
     {{"0", "0", "0", "0"},
      {"1000", "0", "1000", "1000"},
      {"1000", "500", "1500", "500"},
      {"1000", "-500", "500", "1500"},
      {"0", "5000", "5000", "-5000"},
      {"0", "-8000", "-8000", "8000"},
      {"8000", "-8000", "0", "10000"},
      {"10000", "2000", "10000", "8000"},
      {"-10000", "2000", "-8000", "-10000"}}},
    {"mixed_mode_on_a_serial_line",
     {keya_serial(rs232, {a_keya({{17, 1}})})},
     "control 1 1000 -500; a.value = 500; b.value = 1500"},
    {"in_mixed_mode_the_fault_of_one_motor_stops_both", {keya_own_can(a_keya({{17, 1}}))}, R"(
        200D.01 := 1; inject b 0x0800; b.faults = 0x0801; a.faults = 0x0201)"},
    // Overvoltage and undervoltage go by themselves, overcurrent and Hall with a disable, hardware overcurrent without
    // power.
    {"each_fault_goes_in_the_way_the_manual_says", {keya_own_can()}, R"(
        200D.01 := 1; inject a 0x0856; a.faults = 0x0857; b.faults = 1; 200D.01 := 1; a.enabled = 0; 200C.01 := 1
        a.faults = 0x0857; cure a 0x0856; a.faults = 0x0845; 200C.01 := 1; a.faults = 0x0005; 200D.01 := 1
        a.enabled = 0
        restart; pass 1001ms; a.faults = 1; 200D.01 := 1; a.enabled = 1)"},
    {"a_restart_disables_both_is_silent_while_it_boots_and_forgets_the_counts_unless_a_test_says_no",
     {keya_own_can_if(&KeyaOptions::keeps_counts)},
     R"(
        count a 1234; 200D.01 := 1; 200D.02 := 1; restart; 200D.01 := 1 silent; pass 1001ms; a.faults = 1; b.faults = 1
        a.count = $2; 200D.01 := 1; restarts = 1)",
     {{"1", "1234"}, {"0", "0"}}},
};

const Case keya_lines_cases[] = {
    {"what_is_wrong_on_can_meets_silence",
     {keya_own_can()},
     "> $1 <; handled = 0; > 40 00 21 01 00 00 00 00; arrived = 1",
     {{"23 00 20 03 00 00 00 00"},
      {"23 00 20 00 00 00 00 00"},
      {"23 00 20 01 00 00 27 11"},
      {"23 01 20 01 FF FF D8 EF"},
      {"23 00 21 01 00 00 00 00"},
      {"40 00 20 01 00 00 00 00"},
      {"40 00 21 02 00 00 00 00"},
      {"40 0D 21 01 00 00 00 00"},
      {"40 04 21 01 00 00 00 00"},
      {"41 00 21 01 00 00 00 00"},
      {"23 0E 20 01 00 00 00 00"},
      {"40 00 21 01 00 00 00"}}},
    // 29 bits and its own number alone.
    {"a_frame_for_another_number_or_in_11_bits_meets_silence", {can({KeyaCanDrive{a_keya()}})}, R"(
        > 06000002#4000210100000000 <; > 001#4000210100000000 <; > 06000001#4000210100000000; arrived = 1)"},
    {"an_acknowledge_repeats_the_sub_index_unless_a_test_says_no",
     {keya_own_can_if(&KeyaOptions::echoes_sub)},
     R"(
        > 23 0D 20 02 00 00 00 00 < 60 0D 20 $2 00 00 00 00; > 40 04 21 03 00 00 00 00 < 60 04 21 03 00 00 00 00)",
     {{"1", "02"}, {"0", "00"}}},
    {"with_another_interface_selected_can_is_not_there", {keya_own_can(a_keya({{19, 5}}))}, R"(
        2100.01 silent; listen; pass 5s; arrived = 0)"},
    {"with_another_interface_selected_rs232_answers_queries_but_obeys_nothing",
     {keya_serial_if(&KeyaOptions::queries_always, rs232, a_keya({{19, 2}}))},
     R"(
        control 3 1000 1000; a.enabled = 0; query 5; arrived = $2)",
     {{"1", "12"}, {"0", "0"}}},
    {"on_rs485_each_of_two_hears_its_own_number_alone", {keya_serial(rs485, {a_keya({}, 1), a_keya({}, 9)})}, R"(
        query 5 1; arrived = 12; query 5 9; arrived = 12; query 5 2; arrived = 0; query 5 0; arrived = 0
        control 3 1000 1000 9; a.enabled = 0; heard = 3)"},
    {"a_wrong_checksum_on_rs485_meets_silence_and_changes_nothing", {keya_serial(rs485)}, R"(
        > E0 01 01 00 00 03 E8 00 00 00 00 CE <; a.enabled = 0; > ED 01 07 00 00 00 00 00 00 00 00 F6 <
        > ED 01 07 00 00 00 00 00 00 00 00 F5; arrived = 12)"},
    {"a_frame_is_found_after_rubbish_and_after_one_that_broke_off", {keya_serial(rs232)}, R"(
        > 00 FF 13 ED 05 00 00 00 00 00 00 00 00 00 00; arrived = 12; > ED 05 00 00 00 <; pass 21ms; query 5
        arrived = 12)"},
    {"a_code_above_three_is_no_command",
     {keya_serial(rs232)},
     "control 4 1000 1000; control 0xFF 1000 1000; handled = 0"},
    {"the_heartbeat_of_rs232_has_a_period_that_can_be_set", {keya_serial(rs232)}, R"(
        heartbeat 100; pass 1s; arrived = 120; heartbeat 250; listen; pass 1s; arrived = 48
        heartbeat 0; listen; pass 1s; arrived = 0)"},
    {"a_late_answer_does_not_keep_the_heartbeat_back", {keya_serial(rs232)}, R"(
        heartbeat 100; late_by 300; fault late; query 7; pass 250ms; arrived = 24; pass 100ms; arrived = 48)"},
};

const Case keya_canopen_cases[] = {
    {"its_dictionary_has_no_identity",
     {keya_canopen()},
     "> 601#40$1000000000 < 581#80$100000206",
     {{"081000"}, {"101000"}, {"161000"}, {"181000"}, {"406000"}, {"416000"}, {"606000"}, {"3F6000"}}},
    {"its_heartbeat_time_has_four_bytes_and_only_expedited_transfers_work", {keya_canopen(periodic())}, R"(
        607A.01 silent; 1017:2 := 500 -> 0x06070010; 1017:4 := 500; listen; pass 1500ms; frames 701 3; newest 701#7F
        nmt 1; pass 500ms; newest 701#05; 1009 = 1; > 601#2181600004000000 < 581#8081600001000405)"},
    // Of the other motor; torque has none; a mode while it is enabled; counts to zero; clearing faults.
    {"it_obeys_the_codes_of_the_manual_and_refuses_others", {keya_canopen()}, R"(
        607A := 0x030D2002 -> 0x06090030; 607A := 0x030D2021 -> 0x06090030; 607A := 0x030D2001; a.mode = 1
        607A := 0x030D2031; a.mode = 3; 6083 := 0x030D2042; b.mode = 4; count a 777; 607A := 0x030D0000; a.count = 0
        a.enabled = 1; 607A := 0x030C2001; a.enabled = 0; inject b 0x40; cure b 0x40; 2021 = 0x41; 6083 := 0x030C20F2
        2021 = 1; 6081 := 10001 -> 0x06090030)"},
    {"the_speed_limit_of_position_mode_slows_a_move_down", {keya_canopen(a_keya({{20, 3}, {13, 1}, {30, 1}}))}, R"(
        6099.01 := 1000; 6099.02 := 10001 -> 0x06090030; 607A := 0x030D2001; 6081 := 100000; pass 900ms; a.rpm = 150)"},
    {"an_rpdo_commands_and_a_code_of_zero_leaves_the_enabling_alone", {keya_canopen(periodic())}, R"(
        > 201#01200D0300000000; a.enabled = 0; nmt 1; > 201#01200D0300000000; a.enabled = 1; > 201#00000000E8030000
        a.enabled = 1; a.value = 1000; > 301#02200D0300000000; b.enabled = 1; > 201#01200C0300000000; a.enabled = 0
        > 201#01200D03E8030000; a.value = 1000)"},
    {"enable_and_zero_in_one_rpdo_is_a_move_to_zero_unless_a_test_says_no",
     {enable_with_zero},
     R"(
        nmt 1; count a 5000; > 201#01200D0300000000; a.moves = $1)",
     {{"1"}, {"0"}}},
    // The other motor's data will do; a read will not.
    {"after_an_enable_data_must_come_each_1000_ms", {keya_canopen(periodic())}, R"(
        607A := 0x030D2001; pass 999ms; 6084 := 0; pass 1s; 2012 = 0; trips = 0; pass 1ms; trips = 1
        2011 = 0x4001; 203B = 0x40014001)"},
    // What TPDO4 holds is not described.
    {"tpdos_come_after_their_periods", {keya_canopen(periodic())}, R"(
        nmt 1; listen; pass 999ms; arrived = 0; pass 1ms; frames 181 1; pass 11ms; frames 281 1; pass 11ms; frames 381 1
        newest 381#0100010030002100; 1800.05 := 20; listen; pass 1s; frames 181 50 1; frames 481 0)"},
    // 25 counts a millisecond; the inhibit time is in milliseconds, as printed; motor B stands.
    {"tpdos_carry_what_the_sheet_maps_and_go_on_change_no_sooner_than_the_inhibit_time", {keya_canopen()}, R"(
        nmt 1; 607A := 0x030D2001; 6081 := 1000; pass 900ms; show_current a 5; count a 4772343; listen; pass 10ms
        among 181#96000500F1D24800; 1800.03 := 20; 6081 := 1000; listen; pass 200ms; frames 181 10 1; frames 281 0 1)"},
    {"a_mapping_is_written_before_the_start_without_further_steps_and_kept_over_power_off",
     {keya_canopen(periodic())},
     R"(
        1A00.01 := 0x20110010; 1A00.05 := 0 -> 0x06090011; 1600.02 = 0x60810020; 1400.05 = 1000; 1802.05 = 1022; restart
        pass 1001ms; 1A00.01 = 0x20110010; nmt 1; 1A00.01 := 0x20120010 -> 0x08000022)"},
};

INSTANTIATE_TEST_SUITE_P(keya_drive, Scripts, testing::ValuesIn(keya_drive_cases), name_of_case);
INSTANTIATE_TEST_SUITE_P(keya_lines, Scripts, testing::ValuesIn(keya_lines_cases), name_of_case);
INSTANTIATE_TEST_SUITE_P(keya_canopen, Scripts, testing::ValuesIn(keya_canopen_cases), name_of_case);

TEST(keya, refuses_what_the_manual_does_not_have) {
  EXPECT_THROW(KeyaDrive(a_keya({{20, 5}}), KeyaInterface::can), std::invalid_argument);
  EXPECT_THROW(KeyaDrive(a_keya({{99, 1}}), KeyaInterface::can), std::invalid_argument);
  EXPECT_THROW(KeyaBench(rs232, {a_keya(), a_keya()}), std::invalid_argument);
  EXPECT_EQ(KeyaDrive(a_keya(), KeyaInterface::rs485).parameters().get(19), 7);
}

TEST(keya, sends_no_heartbeat_on_rs485) {
  KeyaOptions options = a_keya();
  options.heartbeat = milliseconds(100);
  KeyaBench bench(rs485, {options});
  bench.pass(seconds(10));
  EXPECT_TRUE(bench.arrivals.empty());
}

// At every moment of an exchange at 115200 baud: whole frames, one after the other, the answer among them.
TEST(keya, a_heartbeat_comes_between_frames_at_whatever_moment_it_falls_due) {
  for (int shift = 0; shift < 300; ++shift) {
    KeyaOptions options = a_keya();
    options.heartbeat = milliseconds(5);
    KeyaBench bench(rs232, {options}, 115200);
    if (shift % 2 == 1) bench.line.faults(0).next(DriveFault::split);
    bench.line.faults(0).split_gap = milliseconds(2);
    bench.pass(microseconds(20 * shift));
    bench.line.from_host(from_hex("ED 07 00 00 00 00 00 00 00 00 00 00"), bench.now);
    bench.pass(milliseconds(30));
    ASSERT_EQ(bench.received.size() % keya_frame_length, 0U);
    EXPECT_GE(bench.received.size() / keya_frame_length, 5U);
    int answers = 0;
    for (std::size_t at = 0; at < bench.received.size(); at += keya_frame_length) {
      ASSERT_THAT(bench.received[at], testing::AnyOf(keya_start::query, keya_start::heartbeat)) << "shift " << shift;
      answers += bench.received[at] == keya_start::query ? 1 : 0;
    }
    EXPECT_EQ(answers, 1);
  }
}

}  // namespace
}  // namespace axisgate::simulated
