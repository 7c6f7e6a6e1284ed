// The simulated iD286pro: registers, motion, inputs, homing, stops, what it stores (iD286pro 1 to 7, 10).
#include <algorithm>
#include <charconv>

#include "tests/unit/simulated/scenes.hpp"

namespace axisgate::simulated {
namespace {

// Register 109: 1 disabled, 2 stopped, 3 running. 117: position. 119: speed in 1/100 rev/s. 323: the command.
Maker with_stored(std::map<std::uint16_t, std::int64_t> stored) {
  return id286pro([&](auto& it) { it.stored = std::move(stored); });
}

void external(Id286proOptions& it) { it.internal_pulses = false; }

const Case id286pro_registers_cases[] = {
    {"a_hole_is_refused", {id286pro()}, R"(
        > 01 03 00 6A 00 03 < 01 83 02; > 01 03 01 F4 00 01 < 01 83 02; > 01 03 FF FF 00 02 < 01 83 02
        107 := 1 -> 2)"},
    {"or_a_hole_reads_as_zeros_and_is_not_written_either", {id286pro([](auto& it) { it.holes_read_zero = true; })}, R"(
        > 01 03 00 6A 00 03 < 01 03 06 00 01 00 00 00 00; 500 = 0; 107 := 1 -> 2)"},
    {"other_functions_and_impossible_counts_are_refused", {id286pro()}, R"(
        > 01 04 00 64 00 01 < 01 84 01; > 01 2B 0E 01 00 00 < 01 AB 01; > 01 03 01 2D 00 00 < 01 83 03
        > 01 03 01 2D 00 7E < 01 83 03; > 01 10 01 2D 00 02 02 00 01 < 01 90 03)"},
    {"a_request_may_be_bounded", {id286pro([](auto& it) { it.most_registers = 2; })}, R"(
        > 01 03 01 2D 00 02 < 01 03 04 00 64 00 64; > 01 03 01 2D 00 03 < 01 83 03)"},
    {"several_registers_are_written_together_or_not_at_all", {id286pro()}, R"(
        > 01 10 01 2D 00 02 04 00 C8 01 2C < 01 10 01 2D 00 02; 301 = 200; 302 = 300
        > 01 10 01 2D 00 03 06 00 D2 01 36 00 04 < 01 90 03; > 01 10 00 6C 00 02 04 00 00 00 00 < 01 90 02
        > 01 10 01 42 00 03 06 00 00 00 01 00 01 < 01 90 02; 301 = 200; 302 = 300; 303 = 500; 323 = 0)"},
    {"half_of_a_pair_leaves_the_other_half", {id286pro()}, R"(
        313 := -100000; 313:1 := 0x1234; 313 = -126412; 314 := 0x7FFF -> 3; 313 = -126412)"},
    {"the_segment_area_holds_plain_registers_saved_by_command_15", {id286pro()}, R"(
        1024 := 7; 1535 := 0xFFFF; 1024 = 7; 1535 = 0xFFFF; 1536 silent; 1023 silent; reboot; 1024 = 0
        1024 := 7; 323 := 15; saves = 1; reboot; 1024 = 7)"},
    {"status_mirrors_the_settings",
     {id286pro()},
     "242 := 51200; 244 := 2; 104 = 51200; 106 = 2; 101 = 4800; 109 := 1 -> 2"},
    {"the_current_falls_to_the_standstill_ratio_after_its_delay", {id286pro()}, R"(
        pass 1s; 100 = 1500; 323 := 4; pass 50ms; 100 = 3000; 323 := 7; pass 400ms; 100 = 3000; pass 200ms; 100 = 1500
        enable off; 100 = 0)"},
    {"the_global_address_is_255", {id286pro()}, R"(
        > FF 06 01 2D 00 4D <; 301 = 77; > 00 06 01 2D 00 4E <; 301 = 77; > FF 03 01 2D 00 01 <)"},
    {"or_the_standards_0_too",
     {id286pro([](auto& it) { it.obeys_address_zero = true; })},
     "> 00 06 01 2D 00 4E <; 301 = 78"},
    {"register_298_counts_when_all_switches_are_off_and_after_a_restart",
     {id286pro([](auto& it) { it.switches_off = true; })},
     R"(
        298 := 9; 301 = 100; reboot; 301 silent; 301@9 = 100)"},
    {"and_does_not_count_beside_switches", {id286pro()}, "298 := 9; reboot; 301 = 100"},
    {"a_write_of_a_stored_register_costs_even_with_the_same_value_and_a_highlighted_one_nothing", {id286pro()}, R"(
        repeat 3 305 := 1; 317 := 1000; 241 := 4000; 303 := 600; 304 := 600; 306 := 600; 307 := 600; 321 := 600
        323 := 6
        308 := 900; 313 := 900; 313 := 901; 305 := 9 -> 3; 301 = 100; eeprom 241:1 305:3 317:1 unknown 308:1 313:2)"},
    {"a_restart_keeps_what_is_stored_and_loses_the_rest", {id286pro()}, R"(
        301 := 150; 306 := 2500; 308 := 300; 313 := 4000; 323 := 1; stands; 117 = 4000; reboot
        301 = 150; 306 = 1000; 308 = 300; 323 = 0; 117 = 0; 109 = 2; restarts = 1)"},
    {"what_is_unknown_may_be_lost", {id286pro([](auto& it) { it.unknown_are_stored = false; })}, R"(
        308 := 300; reboot; 308 = 1000)"},
    {"user_command_1_resets_the_parameters_and_the_pulses_with_the_restart", {id286pro()}, R"(
        301 := 150; 306 := 2500; 206 := 1; 301 = 100; 306 = 1000; 296 = 0; internal = 1; reboot; internal = 0)"},
    {"user_command_3_restarts_after_the_answer_and_only_while_it_stands", {id286pro()}, R"(
        323 := 4; 206 := 3; pass 200ms; restarts = 0; 323 := 7; 206 := 3; pass 100ms; 109 silent; pass 1s
        109 = 2; restarts = 1)"},
};

const Case id286pro_motion_cases[] = {
    // 10 revolutions at 20 rev/s with ramps of 500 rev/s^2: 0.5 s and 0.04 s. Direction by the target alone.
    {"an_absolute_move_ends_exactly_on_its_target_with_the_speed_it_was_given", {id286pro()}, R"(
        306 := 2000; 313 := -100000; 109 = 2; 323 := 1; 109 = 3; pass 200ms; 119 = -2000
        pass 320ms; 109 = 3; pass 30ms; 109 = 2; 117 = -100000; 119 = 0)"},
    {"the_speed_begins_at_the_start_frequency_and_rises_with_the_acceleration", {id286pro()}, R"(
        301 := 300; 303 := 1000; 307 := 2000; 323 := 3; pass 1ms; 119 = 300; pass 10ms; 119 = 1300; pass 10ms
        119 = 2000)"},
    {"a_target_changed_on_the_way_takes_effect_in_an_absolute_move", {id286pro()}, R"(
        313 := 50000; 323 := 1; pass 100ms; 313 := -7000; stands; 117 = -7000; 313 := 9000; pass 1s; 117 = -7000)"},
    {"and_not_in_a_relative_one_nor_does_a_second_command", {id286pro()}, R"(
        313 := 50000; 323 := 2; pass 100ms; 313 := -7000; 323 := 2; stands; 117 = 50000)"},
    {"relative_moves_add_up_and_every_write_of_323_is_a_new_trigger", {id286pro()}, R"(
        313 := -2500; 323 := 2; 109 = 3; stands; 117 = -2500; repeat 2 move_on; 117 = -7500; starts = 3)"},
    {"speed_mode_has_a_sign_and_a_new_speed_acts_with_a_new_command", {id286pro()}, R"(
        307 := -500; 323 := 3; pass 500ms; 119 = -500; 117 < 0; 307 := 900; pass 500ms; 119 = -500
        323 := 3; pass 500ms; 119 = 900; 307 := 0; 323 := 3; stands)"},
    {"or_a_new_speed_acts_at_once", {id286pro([](auto& it) { it.speed_follows_register = true; })}, R"(
        307 := 500; pass 100ms; 109 = 2; 323 := 3; pass 100ms; 307 := -700; pass 200ms; 119 = -700)"},
    {"jog_runs_both_ways_until_a_stop", {id286pro()}, R"(
        308 := 250; 323 := 4; pass 300ms; 119 = 250; 323 := 5; pass 300ms; 119 = -250; 323 := 6; pass 100ms; 109 = 2)"},
    // 40 rev/s at 100 rev/s^2.
    {"a_decelerated_stop_takes_its_ramp_and_an_emergency_stop_none", {id286pro()}, R"(
        307 := 4000; 304 := 100; 323 := 3; pass 1s; 323 := 6; pass 380ms; 109 = 3; pass 40ms; 109 = 2
        323 := 3; pass 1s; 323 := 7; 109 = 2; keep 117; pass 100ms; 117 = kept)"},
    {"the_position_is_set_only_while_it_stands", {id286pro()}, R"(
        321 := 123456; 323 := 8; 117 = 123456; 323 := 4; pass 20ms; 321 := 0; 323 := 8; 117 > 123000; 109 = 3)"},
    {"a_command_at_the_wrong_time_may_be_refused", {id286pro([](auto& it) { it.refuses_what_cannot_act = true; })}, R"(
        323 := 4; 323 := 8 -> 4; 206 := 3 -> 4; 323 := 30 -> 3; 323 := 6)"},
    {"microsteps_scale_the_speed", {id286pro()}, R"(
        242 := 200; 307 := 1000; 323 := 3; pass 1s; pass 1s; 117 ~ 3982 2)"},
    {"the_command_reads_back", {id286pro()}, "323 := 6; 323 = 6"},
    {"or_clears_itself", {id286pro([](auto& it) { it.command_reads_back = false; })}, "323 := 6; 323 = 0"},
    // 0313 to 0323: target, unknown, limits, set position, command.
    {"set_points_and_start_in_one_request_act_in_their_order", {id286pro()}, R"(
        > 01 10 01 39 00 0B 16 0B B8 00 00 00 00 00 00 94 00 77 35 6C 00 88 CA 00 00 00 00 00 01; stands; 117 = 3000)"},
    {"commands_without_a_description_do_nothing",
     {id286pro()},
     "313 := 5000; 323 := $1; pass 10ms; 109 = 2; 117 = 0; starts = 0",
     {{"0"},
      {"9"},
      {"10"},
      {"11"},
      {"14"},
      {"16"},
      {"17"},
      {"18"},
      {"19"},
      {"20"},
      {"21"},
      {"22"},
      {"23"},
      {"24"},
      {"25"},
      {"26"},
      {"27"},
      {"28"},
      {"29"}}},
};

const Case id286pro_stops_cases[] = {
    {"the_soft_limits_end_the_way", {id286pro()}, R"(
        317 := 15000; 319 := -4000; 313 := 50000; 323 := 1; stands; 117 = 15000; 323 := 5; stands; 117 = -4000
        323 := 5; pass 100ms; 117 = -4000; 323 := 4; pass 10ms; 117 > -4000)"},
    {"a_limit_input_stops_at_once_in_its_direction_alone",
     {id286pro([](auto& it) {
       it.mechanics.positive_limit = 8000;
       it.stored = {{400, 9}};
     })},
     R"(
        323 := 4; stands; 117 ~ 8100 100; keep 117; 323 := 4; pass 50ms; 117 = kept; 323 := 5; pass 500ms
        117 < 8000)"},
    {"with_external_pulses_motion_commands_are_acknowledged_and_ignored",
     {id286pro(external)},
     R"(
        313 := 5000; 323 := $1; pass 50ms; 109 = 2; 117 = 0)",
     {{"1"}, {"2"}, {"3"}, {"4"}, {"5"}, {"12"}}},
    {"internal_pulses_act_after_a_restart", {id286pro(external)}, R"(
        296 := 1; 313 := 5000; 323 := 1; pass 50ms; 117 = 0; 206 := 3; pass 2s; 313 := 5000; 323 := 1; stands
        117 = 5000)"},
    {"with_external_pulses_the_third_terminal_frees_the_motor_and_functions_do_nothing",
     {id286pro([](auto& it) {
       external(it);
       it.stored = {{400, 13}};
     })},
     "109 = 2; input 3 on; 109 = 1; input 3 off; 109 = 2"},
    {"the_hard_wired_enable_stops_and_frees", {id286pro()}, R"(
        323 := 4; pass 50ms; enable off; 109 = 1; keep 117; 323 := 4; pass 50ms; 117 = kept; enable on; pass 50ms
        109 = 2)"},
    {"a_jammed_rotor_is_not_seen_by_an_open_loop_drive", {id286pro()}, R"(
        jam; 313 := 5000; 323 := 1; stands; 117 = 5000; physical = 0)"},
    {"the_direction_bit_turns_the_motor_and_not_the_numbers", {id286pro()}, R"(
        201 := 1; 313 := 5000; 323 := 1; stands; 117 = 5000; physical = -5000)"},
    {"a_rising_edge_triggers_the_function_once", {with_stored({{400, 2}, {402, 7}})}, R"(
        313 := 40000; input 1 on; 109 = 3; cause = 0; input 3 on; 109 = 2; pass 100ms; 109 = 2)"},
    {"a_simulated_input_triggers_like_a_real_one", {id286pro()}, R"(
        400 := 4; 109 = 2; 410 := 1; 109 = 3; 401 := 7; 411 := 1; 109 = 2)"},
    {"the_enable_function_frees_the_motor_while_its_input_is_off", {with_stored({{402, 20}})}, R"(
        109 = 1; input 3 on; 109 = 2; 323 := 4; input 3 off; 109 = 1)"},
    {"nothing_that_is_on_at_power_up_triggers", {with_stored({{400, 4}, {410, 1}})}, R"(
        pass 50ms; 109 = 2; reboot; 109 = 2; starts = 0)"},
    {"a_fault_stops_the_motor_and_is_cleared_by_either_command_once_its_cause_is_gone",
     {id286pro()},
     R"(
        323 := 4; pass 100ms; inject $1; 108 = $1; 109 = 1; keep 117; 323 := 4; pass 50ms; 117 = kept; $2; 108 = $1
        cure; pass 50ms; 108 = $1; $2; 108 = 0; pass 50ms; 109 = 2)",
     {{"10", "323 := 13"}, {"11", "206 := 2"}, {"13", "323 := 13"}, {"14", "206 := 2"}}},
    {"a_fault_of_the_hardware_needs_the_power_off", {id286pro()}, R"(
        inject 14 hardware; cure; 323 := 13; 206 := 2; 108 = 14; reboot; 108 = 0; 109 = 2)"},
    {"a_fault_whose_cause_stays_is_there_again_after_a_restart", {id286pro()}, "inject 13; reboot; 108 = 13"},
};

// Searches at 5 rev/s: the edge is seen within 50 pulses. $1 mode, $2 function of IN2, $3 where the edge is.
Scene homing_machine(const Row& row) {
  Id286proOptions it;
  it.mechanics.positive_limit = 32345;
  it.mechanics.negative_limit = -32345;
  const std::int64_t edge = std::stoll(row.at(2));
  it.mechanics.home_from = edge > 0 ? edge : edge - 5000;
  it.mechanics.home_to = edge > 0 ? edge + 5000 : edge;
  it.stored = {{305, std::stoll(row[0])}, {309, 500}, {310, 50}, {401, std::stoll(row[1])}};
  return rtu({it})(row);
}

const Case id286pro_homing_cases[] = {
    {"a_mode_ends_on_the_edge_of_its_signal_and_reads_zero_there",
     {homing_machine},
     R"(
        321 := 777; 323 := 8; > 01 06 01 43 00 0C < 01 06 01 43 00 0C; 109 = 3; stands; 117 = 0; physical ~ $3 50)",
     {{"0", "11", "20000"}, {"1", "11", "-20000"}, {"2", "9", "32345"}, {"3", "10", "-32345"}}},
    {"it_runs_on_and_on_without_an_input_for_its_signal_and_past_soft_limits",
     {with_stored({{305, 0}, {309, 500}})},
     R"(
        317 := 1000; 319 := -1000; 323 := 12; pass 5min; 109 = 3; 117 > 14000000; 323 := 6; stands; 117 != 0)"},
    {"a_limit_on_the_way_to_the_origin_ends_it",
     {id286pro([](auto& it) {
       it.mechanics.positive_limit = 3000;
       it.stored = {{305, 0}, {400, 9}, {401, 11}};
     })},
     "323 := 12; stands; 117 > 2999"},
    {"the_origin_may_be_the_simulated_input_or_the_command_11",
     {with_stored({{305, 0}, {401, 11}})},
     R"(
        323 := 12; pass 500ms; 109 = 3; $1; pass 5s; 109 = 2; 117 = 0)",
     {{"411 := 1"}, {"323 := 11"}}},
};

INSTANTIATE_TEST_SUITE_P(id286pro_registers, Scripts, testing::ValuesIn(id286pro_registers_cases), name_of_case);
INSTANTIATE_TEST_SUITE_P(id286pro_motion, Scripts, testing::ValuesIn(id286pro_motion_cases), name_of_case);
INSTANTIATE_TEST_SUITE_P(id286pro_stops, Scripts, testing::ValuesIn(id286pro_stops_cases), name_of_case);
INSTANTIATE_TEST_SUITE_P(id286pro_homing, Scripts, testing::ValuesIn(id286pro_homing_cases), name_of_case);

// Every reply of the sheet comes out, byte for byte, when the drive holds what it tells; the one whose printed CRC is
// wrong, as corrected.
TEST(id286pro, answers_every_frame_of_the_sheet_as_printed) {
  int pairs = 0;
  Bytes request;
  const auto vectors = sheet_of("id286pro", "vectors");
  for (const auto& vector : vectors) {
    const std::string id = vector.at("id").get<std::string>();
    SCOPED_TRACE(id);
    const bool bad = vector.at("checksum_ok").is_boolean() && !vector.at("checksum_ok").get<bool>();
    const Bytes bytes = from_hex(vector.at(bad ? "hex_corrected" : "hex").get<std::string>());
    const bool asks = vector.at("direction") == "request";
    if (asks) request = bytes;
    if (asks && id != "derived-broadcast-decel-stop-req") continue;
    RtuBench bench({Id286proOptions{}});
    const std::map<std::string, std::vector<std::pair<int, int>>> holds{
        {"ex2-read-304x2-rsp", {{304, 10000}, {305, 0}}},
        {"derived-read-position-rsp", {{321, -12345}, {323, 8}, {323, 0}}}};
    bench.line.id286pro(0)->poke(302, 1000);
    for (const auto& [row, value] : holds.contains(id) ? holds.at(id) : std::vector<std::pair<int, int>>{}) {
      bench.line.id286pro(0)->poke(static_cast<std::uint16_t>(row), value);
    }
    EXPECT_EQ(bench.exchange(request), asks ? Bytes{} : bytes);
    ++pairs;
  }
  EXPECT_EQ(pairs, 18);
}

// "1-5000", "-5000-5000", "-2000000000..2000000000 (...)", "0-1 printed; 0-3 described": the widest that is printed.
std::pair<std::int64_t, std::int64_t> limits_in(std::string text) {
  if (text == "0-1 printed; 0-3 described") text = "0-3";
  std::pair<std::int64_t, std::int64_t> limits;
  const char* end = text.data() + text.size();
  const char* dash = std::from_chars(text.data(), end, limits.first).ptr;
  (void)std::from_chars(dash + (std::string_view(dash).starts_with("..") ? 2 : 1), end, limits.second);
  return limits;
}

TEST(id286pro, has_every_row_of_the_sheet_with_its_default_and_range) {
  const auto objects = sheet_of("id286pro", "objects");
  EXPECT_EQ(objects.size(), 49U);
  EXPECT_EQ(id286pro_rows().size(), 49U);
  for (const auto& row : objects) {
    SCOPED_TRACE(row.dump());
    Scene scene = id286pro()({});
    const std::string number = std::to_string(row.at("address").get<int>());
    const auto held = scene.read(number);
    ASSERT_TRUE(held.has_value());
    if (row.at("access") == "R") {
      EXPECT_EQ(scene.write(number, 1), 2U);
      continue;
    }
    // As delivered but for the run mode, which a commissioned drive has changed.
    const auto delivered = row.at("default");
    EXPECT_TRUE(!delivered.is_number() || number == "296" || *held == delivered.get<std::int64_t>());
    if (row.at("range").is_null() || row.at("range") == "") continue;
    const auto [lowest, highest] = limits_in(row.at("range"));
    for (const auto& [value, code] : {std::pair{lowest, 0U}, {highest, 0U}, {highest + 1, 3U}, {lowest - 1, 3U}}) {
      EXPECT_EQ(scene.write(number, value), code);
      EXPECT_EQ(scene.read(number), value == lowest ? lowest : highest);
    }
  }
}

TEST(id286pro, reads_the_runs_of_the_sheet_at_once) {
  RtuBench bench({Id286proOptions{}});
  const auto words = [&](int from, int count) {
    const auto frame = open_rtu(
        bench.exchange(seal_rtu(1, read_pdu(static_cast<std::uint16_t>(from), static_cast<std::uint16_t>(count)))));
    return frame->pdu[0] == function::read ? to_hex(RtuView(frame->pdu).subspan(2)) : "";
  };
  for (const auto& [from, to] : {std::pair{100, 101},
                                 {104, 106},
                                 {108, 111},
                                 {117, 119},
                                 {241, 245},
                                 {298, 323},
                                 {400, 402},
                                 {410, 412},
                                 {428, 430}}) {
    const int count = to - from + 1;
    EXPECT_EQ(words(from, count).size(), static_cast<std::size_t>(4 * count)) << from;
    EXPECT_EQ(words(from - 1, count) + words(from, count + 1), "") << from;
  }
  // The check of the numbering that the sheet proposes for bring-up.
  EXPECT_EQ(words(301, 7), "0064006401F401F4000003E803E8");
  EXPECT_EQ(words(317, 4), "940077356C0088CA");
}

TEST(id286pro, steps_of_time_do_not_matter) {
  const auto position_after = [](Time step) {
    RtuBench bench({Id286proOptions{}});
    bench.exchange(seal_rtu(1, write_long_pdu(313, 123456)));
    bench.exchange(seal_rtu(1, write_pdu(323, 1)));
    while (bench.now < milliseconds(777)) bench.pass(step);
    return bench.line.id286pro(0)->position();
  };
  EXPECT_EQ(position_after(milliseconds(777)), position_after(microseconds(100)));
  EXPECT_NE(position_after(milliseconds(777)), 0);
}

}  // namespace
}  // namespace axisgate::simulated
