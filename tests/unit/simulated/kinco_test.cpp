// The simulated Kinco JD and MD on their own serial protocol: wire, inputs, state machine, EEPROM, motion, faults
// (JD 1.4, 2, 4, 5, 6, 7; MD 1, 2, 6, 7, 8, 9, M).
#include <algorithm>

#include "tests/simulated/trapezoid.hpp"
#include "tests/unit/simulated/scenes.hpp"

namespace axisgate::simulated {
namespace {

void fresh(DriveOptions& drive) { drive.factory_fresh = true; }

DriveOptions in_chain(KincoType type, std::uint8_t station) {
  DriveOptions options = a_drive(type, station);
  options.cascade = true;
  return options;
}

void on_rs485(LineOptions& line) { line.wiring = Wiring::rs485; }

const Case kinco_wire_cases[] = {
    {"another_station_a_wrong_sum_and_a_frame_that_broke_off_meet_silence", {jd(), md()}, R"(
        6041@2 silent; > 01 2B 40 60 00 2F 00 00 00 06 <; handled = 0
        > 01 40 41 60 00 00 00 <; pass 25ms; 6041 & 0x40 = 0x40)"},
    {"two_glued_requests_are_both_answered", {jd()}, R"(
        > 01 40 41 60 00 00 00 00 00 1E 01 40 41 60 00 00 00 00 00 1E
        < 01 4B 41 60 00 50 40 00 00 83 01 4B 41 60 00 50 40 00 00 83)"},
    {"refusals_carry_the_codes_of_cia_301", {jd()}, R"(
        9999 := 0 -> 0x06020000; 6041 := 1 -> 0x06010002; 6040:1 := 1 -> 0x06070010; 6060 := 2 -> 0x06090030)"},
    {"the_jd_clamps_what_is_out_of_range", {jd()}, "60FF := 20000000; 60FF = 16777215"},
    {"the_md_refuses_what_is_out_of_range", {md()}, "60FF := 60000000 -> 0x06090030; 60FF = 0"},
    {"unused_bytes_of_a_short_reply_may_be_ff", {md([](auto& it) { it.unused_bytes = 0xFF; })}, R"(
        control 06; > 01 40 41 60 00 00 00 00 00 1E < 01 4B 41 60 00 31 40 FF FF A4)"},
    {"a_drive_at_another_baud_hears_nothing",
     {kincos({a_drive(KincoType::jd)},
             [](auto& line) {
               line.baud = 115200;
               line.check_baud = true;
             })},
     "> 01 40 41 60 00 00 00 00 00 1E; pass 50ms; < "},
    {"a_chain_returns_the_hosts_bytes_before_the_reply",
     {kincos({in_chain(KincoType::jd, 1), in_chain(KincoType::jd, 2)})},
     R"(
        > 01 2B 40 60 00 3F 00 00 00 F5 < 01 2B 40 60 00 3F 00 00 00 F5 01 60 40 60 00 3F 00 00 00 C0
        > 09 40 41 60 00 00 00 00 00 16 < 09 40 41 60 00 00 00 00 00 16
        607A@1 := 11; 607A@2 := 22; 607A@1 = 11; 607A@2 = 22)"},
    {"a_drive_left_one_to_one_breaks_the_chain", {kincos({a_drive(KincoType::jd, 1), in_chain(KincoType::jd, 2)})}, R"(
        > 01 40 41 60 00 00 00 00 00 1E; arrived = 10; > 02 40 41 60 00 00 00 00 00 1D <)"},
    {"a_drive_that_reboots_silences_the_whole_chain",
     {kincos({in_chain(KincoType::jd, 1), in_chain(KincoType::jd, 2)})},
     R"(
        restart 1; 6041@1 silent; arrived = 0; pass 2s; 6041@1 = 0x4050; arrived = 20)"},
    {"cascade_is_written_stored_and_acts_after_a_restart", {jd()}, R"(
        6510.0B := 1; store; 6041 = 0x4050; arrived = 10; reboot; 6041 = 0x4050; arrived = 20)"},
    {"on_rs485_all_hear_the_host_and_nothing_echoes",
     {kincos({a_drive(KincoType::md, 1), a_drive(KincoType::md, 2)}, on_rs485)},
     R"(
        6041@1 & 0x40 = 0x40; arrived = 10; 6041@2 & 0x40 = 0x40; arrived = 10)"},
    {"an_md_switched_to_modbus_no_longer_answers_here", {kincos({a_drive(KincoType::md)}, on_rs485)}, R"(
        6510.0C := 0; store; 6510.0C = 0; reboot; 6041 silent)"},
};

const Case kinco_inputs_cases[] = {
    // JD 1.4, MD 6.1: DIN1 and DIN3 block the bus.
    {"a_fresh_drive_acknowledges_and_stays_as_its_inputs_say", {jd(fresh), md(fresh)}, R"(
        6040 := 0x0F; pass 10ms; 6041 & 0x6F = 0x21; 6040 = 6; handled = 1
        6060 := 1; 6060 = -4; input 3 on; pass 2ms; 6060 = -3)"},
    {"a_fresh_drives_input_enables_it", {jd(fresh), md(fresh)}, R"(
        input 1 on; pass 2ms; 6041 & 0x6F = 0x27; cause = 0; input 1 off; pass 2ms; 6041 & 0x6F = 0x21)"},
    {"a_fresh_drive_obeys_once_the_functions_are_removed_and_until_a_restart_without_a_store",
     {jd(fresh), md(fresh)},
     R"(
        2010.03 := 0; 2010.05 := 0; control 0F; 6041 & 0x6F = 0x27; cause = 3; 6060 := 1; 6060 = 1
        reboot; control 0F; 6041 & 0x6F != 0x27)"},
    {"a_fresh_jd_without_switches_sits_in_limit_state", {jd(fresh)}, R"(
        60FD = 3; 6041 & 0x0800 = 0x0800; 2010.07 := 0; 2010.08 := 0; 60FD = 0; 6041 & 0x0800 = 0)"},
    {"a_polarity_of_normally_closed_lifts_the_limits", {jd(fresh)}, "2010.01 := 0xCF; 60FD = 0"},
    {"a_wired_switch_stops_the_axis_in_its_direction_only",
     {jd([](auto& it) {
       it.mechanics.positive_limit = 30000;
       it.mechanics.negative_limit = -30000;
     })},
     R"(
        60FD = 0; 6060 := 3; 60FF := 500rpm; control 0F; pass 3s
        60FD = 2; 6041 & 0x0800 = 0x0800; 60F9.19 = 0; 6063 ~ 30500 500
        60FF := -500rpm; pass 100ms; 6063 < 30000; 6041 & 0x0800 = 0)"},
    {"simulation_makes_an_input_active", {jd(fresh)}, "2010.02 := 1; pass 2ms; 6041 & 0x6F = 0x27; 2010.0A = 0"},
    {"the_fault_reset_input_acts_on_its_rising_edge", {jd(fresh)}, R"(
        inject 1 0x80; cure 1 0x80; input 2 on; pass 2ms; 2601 = 0; 6041 & 0x4F != 8)"},
    {"outputs_tell_ready_and_error", {jd()}, "2010.14 & 1 = 1; inject 1 0x80; 2010.14 & 0x41 = 0x40"},
};

const Case kinco_states_cases[] = {
    {"walks_up_and_down", {jd()}, R"(
        6041 = 0x4050; control 06; 6041 & 0x6F = 0x21; control 07; 6041 & 0x6F = 0x23; control 0F; 6041 & 0x6F = 0x27
        control 07; pass 5ms; 6041 & 0x6F = 0x23; control 06; 6041 & 0x6F = 0x21; control 00; 6041 & 0x4F = 0x40)"},
    {"each_transition_names_the_request_that_caused_it",
     {md()},
     "control 06; cause = 1; control 0F; cause = 2; enabled = 1"},
    {"may_insist_on_a_first_shutdown", {jd([](auto& it) { it.needs_shutdown_first = true; })}, R"(
        control 0F; 6041 & 0x4F = 0x40; control 06 0F; 6041 & 0x6F = 0x27)"},
    {"a_quick_stop_of_a_jd_ends_with_the_voltage_off", {jd()}, R"(
        6060 := 3; 60FF := 1000rpm; control 06 0F; pass 1s
        control 0B; 6041 & 0x6F = 0x07; pass 1s; 6041 & 0x4F = 0x40; 60F9.19 = 0)"},
    // 1000 rpm: 33 ms at 500 rps/s (6085), 167 ms at 100 rps/s (6084).
    {"a_quick_stop_of_an_md_follows_605a",
     {md()},
     R"(
        605A := $1; 6060 := 3; 60FF := 1000rpm; control 06 0F; pass 1s; control 0B; 6041 & 0x6F = 0x07
        pass 100ms; 606C $2 0; pass 1s; 6041 & 0x4F = $3)",
     {{"1", ">", "0x40"}, {"2", "=", "0x40"}, {"5", ">", "0x07"}, {"6", "=", "0x07"}}},
    {"an_md_that_stays_in_its_quick_stop_can_be_enabled_again", {md()}, R"(
        605A := 6; 6060 := 3; 60FF := 100rpm; control 06 0F; pass 1s; control 0B; pass 1s; control 0F
        6041 & 0x6F = 0x27)"},
    {"quick_stop_option_0_lets_it_coast", {md()}, R"(
        605A := 0; 6060 := 3; 60FF := 1000rpm; control 06 0F; pass 1s; control 0B; 6041 & 0x4F = 0x40; 606C > 0)"},
    {"a_shutdown_of_an_md_follows_605b", {md()}, R"(
        605B := 1; 6060 := 3; 60FF := 1000rpm; control 06 0F; pass 1s
        control 06; pass 50ms; 6041 & 0x6F = 0x27; pass 200ms; 6041 & 0x6F = 0x21)"},
    {"a_halt_of_an_md_stops_a_move_and_its_end_goes_on_with_it", {md()}, R"(
        6060 := 1; control 0F; 607A := 400000; 6081 := 1000rpm; start_move; pass 200ms; control 13F; pass 500ms
        606C = 0; 6041 & 0x6F = 0x27; 6063 < 400000; control 3F; pass 2s; 6063 = 400000)"},
    {"a_jd_knows_no_halt",
     {jd()},
     "6060 := 3; 60FF := 300rpm; control 06 0F; pass 1s; control 10F; pass 1s; 606C = 300"},
    {"torque_knows_no_halt", {md()}, "6060 := 4; 60F6.08 := 200; control 0F 10F; pass 1s; 606C != 0"},
    {"a_fault_goes_with_0x80_once_its_cause_is_gone", {jd()}, R"(
        control 0F; inject 1 0x20; 6041 & 0x4F = 0x08; 2601 = 0x20; control 80; 6041 & 0x4F = 0x08
        cure 1 0x20; control 06 80; 6041 & 0x4F = 0x40; 2601 = 0)"},
    {"a_fault_of_an_md_wants_0x86", {md()}, R"(
        inject 1 0x80; cure 1 0x80; control 80; 6041 & 0x4F = 0x08; control 06 86; 6041 & 0x4F = 0x40)"},
    {"word_two_of_an_md_shows_in_bit_zero_of_word_one", {md()}, "inject 2 8; 2601 = 1; 2602 = 8"},
    {"a_fault_never_enables_again_by_itself", {jd()}, R"(
        6060 := 3; 60FF := 100rpm; control 06 0F; pass 1s; inject 1 0x0800; cure 1 0x0800; control 8F; pass 5s
        6041 & 0x4F = 0x40)"},
    {"a_jam_leads_to_a_following_error", {jd()}, R"(
        6060 := 3; 60FF := 300rpm; control 06 0F; pass 1s; jam; pass 100ms; 60FB.08 > 1000
        pass 1s; 2601 = 0x0200; 6041 & 0x2008 = 0x2008)"},
    {"a_limit_after_homing_is_an_alarm_on_an_md_that_asks_for_it",
     {md([](auto& it) { it.mechanics.positive_limit = 5000; })},
     R"(
        2010.06 := 0x10; 2010.19 := 0; home_here; 60FF := 100rpm; 6060 := 3; pass 1s; 2602 = 0x0200)"},
};

const Case kinco_eeprom_cases[] = {
    {"a_store_keeps_parameters_and_a_restart_loses_the_rest", {jd()}, R"(
        6083 := 50000; reboot; 6083 = 100000
        6083 := 50000; 6060 := 1; 2FF0.09 := 100; 6071 := 50; 607A := 1234; store; stores = 1; reboot
        6083 = 50000; 6060 = -4; 6061 = -4; 2FF0.09 = 0; 6071 = 0; 607A = 0)"},
    {"the_store_command_reads_back_zero_when_it_is_done", {jd([](auto& it) { it.store_time = milliseconds(300); })}, R"(
        2FF0.01 := 1; pass 299ms; 2FF0.01 = 1; stores = 0; pass 1ms; 2FF0.01 = 0; stores = 1)"},
    {"a_power_cut_during_a_store_loses_it", {jd()}, R"(
        6083 := 50000; 2FF0.01 := 1; pass 10ms; reboot; 6083 = 100000; stores = 0)"},
    {"ten_restores_the_defaults_of_all_but_the_motor", {jd()}, R"(
        6083 := 50000; 6410.05 := 5; 2FF0.01 := 10; 6083 = 100000; 2010.03 = 1; 6410.05 = 5)"},
    {"motor_parameters_have_their_own_store", {jd()}, R"(
        6410.05 := 5; store; reboot; 6410.05 = 3; 6410.05 := 5; 2FF0.03 := 1; pass 100ms; reboot; 6410.05 = 5)"},
    {"the_mds_gains_carry_no_s_and_are_lost", {md()}, R"(
        60F9.01 := 321; 60FB.01 := 200; store; reboot; 60F9.01 = 100; 60FB.01 = 200)"},
    {"a_new_station_acts_after_store_and_restart", {jd()}, R"(
        100B := 5; store; 6041 = 0x4050; reboot; 6041 silent; 6041@5 = 0x4050)"},
    {"the_mds_dip_switches_win_over_its_station_object", {md()}, "100B := 5; 100B = 1"},
    {"a_password_locks_parameters_after_a_restart",
     {jd()},
     R"(
        2FFD := 4711; 6083 := 60000; store; reboot; 6083 := 50000 -> $1; 2FFD := 4712 -> $1
        6040 := 6; 2FFD := 4711; 6083 := 50000)",
     {{"0x08000022"}}},
    {"a_restarted_drive_is_silent_disabled_and_unreferenced", {jd()}, R"(
        home_here; restart; 6041 silent; pass 999ms; 6041 silent; pass 1ms; 6041 = 0x4050)"},
    {"auto_enable_acts_at_power_up_without_a_request",
     {jd()},
     "2000 := 1; store; reboot; 6041 & 0x6F = 0x27; cause = 0"},
};

const Case kinco_motion_cases[] = {
    // 100 rps/s at 10000 counts; 600 rpm do not fit 0.01 rpm in 16 bits.
    {"acceleration_is_as_the_sheet_converts_it", {jd()}, R"(
        6060 := 3; 6083 := 16384; 60FF := 600rpm; control 0F; pass 50ms; 60F9.19 ~ 30000 1000
        pass 52ms; 60F9.19 = 32767; 60F9.1A = 100)"},
    // MD 10.1: "150 rpm" at 10000 counts are 22.9 rpm of a 16-bit encoder: 1500831 counts a minute.
    {"a_16_bit_encoder_turns_at_the_printed_speeds_over_sixty", {md()}, R"(
        6060 := 3; > 01 23 FF 60 00 00 40 06 00 37; control 0F; pass 61s; 6063 ~ 1525843 6554)"},
    {"speed_limit_6080_bounds_every_mode", {jd()}, R"(
        6080 := 200; 6060 := 4; 60F6.08 := 1000; control 0F; pass 1s; 606C = 200; 60F6.17 = 1000
        60FF := 1000rpm; 6060 := 3; pass 1s; 606C = 200)"},
    {"enabling_in_a_velocity_mode_runs_at_once", {jd()}, R"(
        6060 := -3; 60FF := -100rpm; 60FF = -273067; control 0F; pass 1s; 606C = -100)"},
    {"software_limits_end_every_motion", {jd()}, R"(
        607D.01 := 5000; 607D.02 := -5000; 6060 := 1; control 0F; 607A := 100000; start_move; pass 3s
        6063 = 5000; 6041 & 0x0C00 = 0x0800; 60FF := -300rpm; 6060 := 3; pass 3s; 6063 ~ -5000 2)"},
    {"the_position_counter_wraps_at_32_bits", {jd()}, R"(
        607C := -2147480000; home_here; 6063 = 2147480000; 60FF := 600rpm; 6060 := 3; pass 200ms; 6063 < -2147000000)"},
    {"without_bit_5_a_second_set_point_waits_for_the_first", {jd()}, R"(
        6060 := 1; control 0F; 607A := 4000; control 1F 0F; 607A := 1000; control 1F; until 6063 = 4000; pass 3s
        6063 = 1000)"},
    {"the_simplified_objects_are_other_views", {jd()}, R"(
        2FF0.09 := 200; 60FF = 546133; 2FF0.06 := 610; 6083 = 99942; 2FF0.0E := 50; 6065 = 5000
        2FF0.05 := 1; 6041 & 0x6F = 0x27; 2FF0.05 := 0; 6041 & 0x6F = 0x21)"},
    {"a_disabled_motor_coasts_and_its_next_move_starts_where_it_stands", {jd()}, R"(
        6060 := 3; 60FF := 600rpm; control 0F; pass 500ms; keep 6063; control 06; pass 2s; 6063 > kept
        6060 := 1; control 0F; keep 6063; pass 1s; 6063 = kept)"},
    {"inverted_counting_turns_the_motor_the_other_way", {md()}, R"(
        607E := 1; 6060 := 1; control 0F; 607A := 5000; start_move; until 6041 & 0x400 = 0x400; pass 20ms
        6063 = 5000; physical = -5000)"},
};

// The sequences the manuals print, with the statuswords they print (JD 6.2, 6.4; MD 8.2, 8.4).
const Case kinco_printed_cases[] = {
    {"a_jd_homes_on_the_next_index_pulse_and_says_c037", {jd()}, R"(
        > 01 2B 40 60 00 0F 00 00 00 25; > 01 2F 60 60 00 06 00 00 00 0A; > 01 2F 98 60 00 21 00 00 00 B7
        > 01 23 99 60 01 55 55 08 00 30; > 01 23 99 60 02 00 40 06 00 9B; 6041 = 0x4037
        > 01 2B 40 60 00 1F 00 00 00 15; pass 50ms; 6041 = 0x4037; until 6041 & 0x8000 = 0x8000
        > 01 40 41 60 00 00 00 00 00 1E < 01 4B 41 60 00 37 C0 00 00 1C; 6063 = 0; physical = -10000)"},
    // D037: acknowledged, and the old target_reached is gone at once. The window of 6067 is reached before the last
    // count.
    {"a_jd_after_homing_says_d037_then_d437_and_goes_on_relatively", {jd()}, R"(
        home_here; > 01 2B 40 60 00 0F 00 00 00 25; > 01 2F 60 60 00 01 00 00 00 0F; > 01 23 7A 60 00 50 C3 00 00 EF
        > 01 23 81 60 00 55 55 08 00 49; > 01 2B 40 60 00 2F 00 00 00 05; > 01 2B 40 60 00 3F 00 00 00 F5
        6041 = 0xD037; pass 500ms; 606C = 200; until 6041 & 0x400 = 0x400; pass 20ms
        > 01 40 41 60 00 00 00 00 00 1E < 01 4B 41 60 00 37 D4 00 00 08; 6063 = 50000
        control 4F; 6041 = 0xC437; control 5F; until 6041 & 0x1400 = 0x1400; pass 20ms; 6063 = 100000)"},
    {"a_jd_in_mode_1_says_5037_and_4437", {jd()}, R"(
        control 0F; 6060 := 1; 607A := 20000; start_move; pass 20ms; 6041 = 0x5037
        until 6041 & 0x400 = 0x400; control 2F; 6041 = 0x4437)"},
    {"a_jd_in_mode_3_says_c637_at_speed", {jd()}, R"(
        home_here; control 06; > 01 2F 60 60 00 03 00 00 00 0D; > 01 23 FF 60 00 00 40 06 00 37
        > 01 2B 40 60 00 0F 00 00 00 25; pass 400ms; 6041 = 0xC637; 606C = 150; 60F9.19 = 15000; 60F9.1A = 25)"},
    {"a_jd_in_its_immediate_mode_says_4037_then_4437",
     {jd([](auto& it) { it.mechanics.rps_per_s_at_full_current = 50; })},
     R"(
        6060 := -3; 60FF := 600rpm; control 0F; pass 20ms; 6041 = 0x4037; pass 500ms; 6041 = 0x4437)"},
    {"a_jd_refreshes_606c_each_200_ms", {jd()}, R"(
        6060 := 3; 60FF := 300rpm; pass 201ms; control 0F; pass 190ms; 606C = 0; pass 10ms; 606C = 300)"},
    {"an_md_moves_and_reports_606c_in_dec", {md()}, R"(
        > 01 2B 40 60 00 0F 00 00 00 25; > 01 2F 60 60 00 01 00 00 00 0F; > 01 23 7A 60 00 50 C3 00 00 EF
        > 01 23 81 60 00 03 9D 36 00 25; > 01 2B 40 60 00 2F 00 00 00 05; > 01 2B 40 60 00 3F 00 00 00 F5
        pass 120ms; 606C = 3579139; until 6041 & 0x400 = 0x400; pass 20ms; 6041 = 0x5437; 6063 = 50000)"},
    {"an_md_reads_minus_50000_as_the_sheet_computes_it", {md()}, R"(
        control 0F; 6060 := 1; 607A := -50000; start_move; until 6041 & 0x400 = 0x400; pass 20ms
        > 01 40 63 60 00 00 00 00 00 FC < 01 43 63 60 00 B0 3C FF FF 0F)"},
    {"follow_target_moves_with_each_write_of_607a", {md()}, R"(
        6060 := 1; control 06 103F; 607A := 3000; pass 3s; 6063 = 3000; 607A := -1000; pass 3s; 6063 = -1000)"},
    {"a_second_move_needs_a_second_edge", {jd()}, R"(
        control 0F; 6060 := 1; 607A := 1000; start_move; pass 2s; 607A := 2000; control 3F; pass 2s; 6063 = 1000
        start_move; pass 2s; 6063 = 2000)"},
};

// JD 6.5, MD 8.5. Limits at -50000 and 50000, home switch from 10000 to 14000, index pulses each 10000 from 2000.
void machine(DriveOptions& it) {
  it.mechanics.negative_limit = -50000;
  it.mechanics.positive_limit = 50000;
  it.mechanics.home_from = 10000;
  it.mechanics.home_to = 14000;
  it.mechanics.negative_stop = -60000;
  it.mechanics.positive_stop = 60000;
  it.mechanics.index_offset = 2000;
}

void without_home_switch(DriveOptions& it) {
  machine(it);
  it.mechanics.home_from.reset();
  it.mechanics.home_to.reset();
}

const Case kinco_homing_cases[] = {
    // Switches are seen at millisecond steps: 20 rpm are 3.4 counts each.
    {"each_method_finds_its_reference_from_every_start",
     {jd(machine)},
     R"(
        6060 := 1; control 0F; 6081 := 1000rpm; 607A := $3; start_move; until 6041 & 0x400 = 0x400; control 0F
        6060 := 6; 6098 := $1; 6099.01 := 200rpm; 6099.02 := 20rpm; control 1F; pass 2ms
        until 6041 & 0xA000 != 0; until 6041 & 0xA000 = 0x8000; 6063 = 0; physical ~ $2 5)",
     {{"1", "-48000", "0"},     {"1", "-48000", "20000"},  {"2", "42000", "0"},      {"2", "42000", "20000"},
      {"17", "-50000", "0"},    {"17", "-50000", "12000"}, {"18", "50000", "0"},     {"18", "50000", "12000"},
      {"3", "2000", "0"},       {"3", "2000", "12000"},    {"19", "10000", "0"},     {"19", "10000", "12000"},
      {"4", "12000", "0"},      {"4", "12000", "12000"},   {"20", "10000", "0"},     {"20", "10000", "12000"},
      {"21", "14000", "20000"}, {"21", "14000", "12000"},  {"22", "14000", "20000"}, {"22", "14000", "12000"},
      {"7", "2000", "0"},       {"7", "2000", "12000"},    {"7", "2000", "20000"},   {"23", "10000", "0"},
      {"23", "10000", "12000"}, {"23", "10000", "20000"},  {"24", "10000", "0"},     {"24", "10000", "12000"},
      {"25", "14000", "0"},     {"25", "14000", "12000"},  {"26", "14000", "0"},     {"26", "14000", "12000"},
      {"26", "14000", "20000"}, {"27", "14000", "20000"},  {"27", "14000", "12000"}, {"27", "14000", "0"},
      {"28", "14000", "20000"}, {"28", "14000", "12000"},  {"29", "10000", "20000"}, {"29", "10000", "12000"},
      {"30", "10000", "20000"}, {"30", "10000", "12000"},  {"30", "10000", "0"},     {"10", "22000", "0"},
      {"10", "22000", "12000"}, {"10", "22000", "20000"},  {"14", "2000", "20000"},  {"14", "2000", "12000"},
      {"14", "2000", "0"},      {"33", "2000", "5000"},    {"34", "12000", "5000"},  {"35", "5000", "5000"},
      {"-17", "-60000", "0"},   {"-18", "60000", "0"}}},
    {"a_reserved_method_sets_bit_13_at_once_and_the_next_homing_clears_it",
     {jd(machine)},
     R"(
        control 0F; 6060 := 6; 6098 := $1; control 1F; pass 2ms; 6041 & 0xA000 = 0x2000
        control 0F; 6098 := 35; control 1F; until 6041 & 0x8000 = 0x8000; 6041 & 0x2000 = 0)",
     {{"0"}, {"15"}, {"16"}, {"31"}, {"32"}, {"36"}}},
    {"without_a_home_switch_both_limits_end_the_search",
     {jd(without_home_switch)},
     R"(
        control 0F; 6060 := 6; 6098 := $1; 6099.01 := 200rpm; control 1F; pass 2ms; until 6041 & 0xA000 = 0x2000)",
     {{"23"}, {"19"}}},
    {"the_offset_of_an_md_is_run_to_or_read",
     {md()},
     "6099.05 := $1; 607C := 3000; home_here; 6063 = $2; physical = $3",
     {{"0", "0", "3000"}, {"1", "-3000", "0"}}},
    {"taking_the_start_bit_away_stops_it", {jd(machine)}, R"(
        6060 := 6; 6098 := 17; control 0F 1F; pass 200ms; control 0F; pass 5s; 6041 & 0xA000 = 0; 60F9.19 = 0)"},
};

INSTANTIATE_TEST_SUITE_P(kinco_wire, Scripts, testing::ValuesIn(kinco_wire_cases), name_of_case);
INSTANTIATE_TEST_SUITE_P(kinco_inputs, Scripts, testing::ValuesIn(kinco_inputs_cases), name_of_case);
INSTANTIATE_TEST_SUITE_P(kinco_states, Scripts, testing::ValuesIn(kinco_states_cases), name_of_case);
INSTANTIATE_TEST_SUITE_P(kinco_eeprom, Scripts, testing::ValuesIn(kinco_eeprom_cases), name_of_case);
INSTANTIATE_TEST_SUITE_P(kinco_motion, Scripts, testing::ValuesIn(kinco_motion_cases), name_of_case);
INSTANTIATE_TEST_SUITE_P(kinco_printed, Scripts, testing::ValuesIn(kinco_printed_cases), name_of_case);
INSTANTIATE_TEST_SUITE_P(kinco_homing, Scripts, testing::ValuesIn(kinco_homing_cases), name_of_case);

TEST(trapezoid, ends_exactly_on_every_target_from_every_speed) {
  Random random(3);
  for (int run = 0; run < 2000; ++run) {
    const auto maximum = static_cast<Dec>(1 + random.below(1000000));
    const auto acceleration = static_cast<Dec>(1 + random.below(50000));
    const auto deceleration = static_cast<Dec>(1 + random.below(50000));
    const auto target = static_cast<FinePosition>(random.below(20000000)) - 10000000;
    FinePosition position = 0;
    Dec speed = 0;
    for (int steps = 0; position != target || speed != 0; ++steps) {
      const Dec next = approach(speed, target - position, maximum, acceleration, deceleration);
      ASSERT_LE(std::abs(next), maximum);
      ASSERT_LE(std::abs(next) - std::abs(speed), acceleration);
      ASSERT_LE(std::abs(speed) - std::abs(next), deceleration);
      position += next;
      ASSERT_LE(std::abs(position), std::abs(target)) << "beyond the target";
      speed = next;
      ASSERT_LT(steps, 30000000);
    }
  }
}

TEST(trapezoid, ramps_through_zero_without_a_skip) {
  Dec speed = 100;
  for (int i = 0; i < 3; ++i) speed = ramp(speed, -50, 20, 40);
  EXPECT_EQ(speed, 0);
  for (int i = 0; i < 3; ++i) speed = ramp(speed, -50, 20, 40);
  EXPECT_EQ(speed, -50);
}

TEST(kinco, a_jd_speaks_modbus_on_rs485_and_is_refused_there) {
  LineOptions line;
  line.wiring = Wiring::rs485;
  EXPECT_THROW(KincoBench({a_drive(KincoType::jd)}, line), std::invalid_argument);
}

TEST(kinco, steps_of_time_do_not_matter) {
  const auto position_after = [](Time step) {
    KincoBench bench({a_drive(KincoType::jd)});
    for (const auto& [index, value] :
         {std::pair{0x6060, 1}, {0x6040, 0x0F}, {0x607A, 123456}, {0x6040, 0x2F}, {0x6040, 0x3F}}) {
      const ObjectKey key{static_cast<std::uint16_t>(index), 0};
      const int width = bytes_of(bench.line.drive(0).entry(key)->type);
      EXPECT_EQ(bench.line.drive(0).write(key, width, static_cast<std::uint32_t>(value), 0, bench.now), Refusal::none);
    }
    while (bench.now < milliseconds(1777)) bench.pass(step);
    return bench.line.drive(0).axis().actual();
  };
  EXPECT_EQ(position_after(milliseconds(1777)), position_after(microseconds(100)));
  EXPECT_NE(position_after(milliseconds(1777)), 0);
}

}  // namespace
}  // namespace axisgate::simulated
