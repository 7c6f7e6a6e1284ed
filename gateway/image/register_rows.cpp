// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/register_rows.hpp"

#include <string>

#include "gateway/core/words.hpp"
#include "gateway/image/command.hpp"

namespace axisgate {
namespace {

using enum RegisterType;
constexpr Role kViewer = Role::viewer;
constexpr Role kOperator = Role::operator_;
constexpr Role kEngineer = Role::engineer;

/// Name, type and unit of a quantity are its own.
RegisterRow of(std::uint16_t offset, Quantity quantity, std::string_view note = {}) {
  const QuantityRow& q = row(quantity);
  return {.offset = offset, .name = q.name, .type = q.type, .kind = q.kind, .quantity = quantity, .note = note};
}
RegisterRow of(std::uint16_t offset, Quantity quantity, Role may_write, std::string_view note = {}) {
  RegisterRow made = of(offset, quantity, note);
  made.writable = true;
  made.may_write = may_write;
  return made;
}
RegisterRow shows(std::uint16_t offset, std::string_view name, RegisterType type, Source source,
                  std::string_view note = {}, std::string_view unit = {}) {
  return {.offset = offset, .name = name, .type = type, .unit = unit, .source = source, .note = note};
}
RegisterRow takes(std::uint16_t offset, std::string_view name, RegisterType type, Source source, Role may_write,
                  std::string_view note = {}, std::string_view unit = {}) {
  RegisterRow made = shows(offset, name, type, source, note, unit);
  made.writable = true;
  made.may_write = may_write;
  return made;
}
RegisterRow zero_leaves(RegisterRow made) {
  made.zero_leaves = true;
  return made;
}
RegisterRow in(Kind kind, RegisterRow made) {
  made.kind = kind;
  return made;
}

std::string list_of_commands() {
  std::string out;
  for (std::uint16_t number = 1; number <= kLastCommand; ++number) {
    const auto command = static_cast<Command>(number);
    out += (out.empty() ? "" : ", ") + std::to_string(number) + " " + std::string(text(command));
    if (command == Command::save_parameters) out += " (engineer)";
  }
  return out;
}

/// What the numbers of a row are called: the table of words says it, for every place where they are shown.
struct Lists {
  std::string link_state = list_of(WordKind::link_state);
  std::string result = list_of(WordKind::result);
  std::string axis_state = list_of(WordKind::axis_state) +
                           "; 5: or a stop is latched; 7: link_state is not 2 or 3, and the motor may be running";
  std::string motion_state = list_of(WordKind::motion_state);
  std::string axis_alarms = list_of(WordKind::axis_alarm);
  std::string mode = "CiA 402: " + list_of(WordKind::mode) + "; negative: the drive's own";
  std::string command = list_of_commands();
  std::string gateway_state = list_of(WordKind::gateway_state);
  std::string gateway_alarms = list_of(WordKind::gateway_alarm);
};

const Lists& lists() {
  static const Lists kLists;
  return kLists;
}

}  // namespace

std::vector<RegisterRow> axis_register_rows() {
  using enum Quantity;
  return {
      of(0, statusword),
      of(1, mode_display),
      of(2, position_actual),
      of(4, velocity_actual),
      of(6, torque_actual),
      of(7, current_actual),
      of(8, following_error),
      of(10, error_code,
         "CiA 402 603Fh code of the first active row of the profile's alarm table, 0 none; 65535 and not valid: a "
         "fault "
         "whose cause is being read, 500 ms at most; 0x1000: it has named none"),
      of(11, digital_inputs, "bit 0 negative limit, 1 positive limit, 2 home, 3 interlock or E-stop, 4..15 DI1..DI12"),
      of(12, vendor_error,
         "the drive's first fault word in bits 0..15, its second in 16..31; of a fault not valid until they were read"),
      of(14, digital_outputs, "bit 0 brake released, 4..15 DO1..DO12"),
      of(15, drive_temperature),
      of(16, motor_temperature),
      of(17, dc_voltage),
      shows(18, "link_state", u16, Source::link_state, lists().link_state),
      shows(19, "age_ms", u16, Source::age_ms, "age of the oldest cyclic value, saturating", "ms"),
      shows(20, "supported", u32, Source::supported, "this drive on this protocol has the quantity"),
      shows(22, "valid", u32, Source::valid, "the value is good now"),
      shows(24, "sequence", u16, Source::sequence, "steps when anything of the axis changes but ages"),
      shows(25, "command_result", u16, Source::command_result, lists().result),
      shows(26, "command_detail", u32, Source::command_detail,
            "SDO abort code, Modbus exception or the drive's own code; of result 11 the step, from 1, 0: nothing was "
            "sent; of a single write refused with 0x03 by a limit: that limit, in the row's units; of a block write "
            "refused with 0x01, 0x02 or 0x03: 0x0A000000 + offset of the first row, or coil, "
            "refused"),
      shows(28, "owner", u16, Source::owner, "0 nobody, 1 this client, 2 another"),
      shows(29, "lease_remaining_ms", u16, Source::lease_remaining_ms,
            "until the lease runs out as things stand, saturating; 0: none runs", "ms"),
      shows(30, "command_id_seen", u16, Source::command_id_seen, "the last command_id from this client's address"),
      shows(31, "axis_state", u16, Source::axis_state, lists().axis_state),
      shows(32, "motion_state", u16, Source::motion_state, lists().motion_state),
      shows(33, "motion_id", u16, Source::motion_id, "command_id of that motion"),
      shows(34, "axis_alarms", u32, Source::axis_alarms, lists().axis_alarms),
      shows(36, "supported_commands", u32, Source::supported_commands, "bit = command number"),
      shows(38, "supported_modes", u16, Source::supported_modes, "as 6502h, low word"),
      of(40, controlword, kOperator, "reads the controlword in effect"),
      zero_leaves(of(41, mode, kOperator, lists().mode)),
      of(42, target_position, kOperator),
      of(44, target_velocity, kOperator),
      of(46, target_torque, kOperator),
      zero_leaves(of(47, max_torque, kOperator)),
      zero_leaves(of(48, profile_velocity, kOperator)),
      zero_leaves(of(50, profile_acceleration, kOperator)),
      zero_leaves(of(52, profile_deceleration, kOperator)),
      takes(54, "command", u16, Source::command, kOperator, lists().command),
      takes(55, "command_id", u16, Source::command_id, kOperator),
      takes(56, "heartbeat", u16, Source::heartbeat, kOperator, "a changed value renews a lease with renew heartbeat"),
      zero_leaves(in(Kind::velocity, takes(58, "jog_velocity", u32, Source::jog_velocity, kOperator,
                                           "of coils 8 and 9; the gateway's own, the same for every client"))),
      of(60, homing_method, kOperator),
      zero_leaves(of(62, homing_speed_switch, kOperator)),
      zero_leaves(of(64, homing_speed_zero, kOperator)),
      zero_leaves(of(66, homing_acceleration, kOperator)),
      of(68, homing_offset, kOperator),
      zero_leaves(of(70, quick_stop_deceleration, kEngineer)),
      of(72, position_limit_min, kEngineer, "72 to 75 are checked as a pair"),
      of(74, position_limit_max, kEngineer),
      zero_leaves(of(76, max_velocity, kEngineer)),
      in(Kind::position, takes(78, "set_position_value", i32, Source::set_position_value, kOperator)),
      takes(80, "object_request", u16, Source::object_request, kViewer, "1 read, 2 write (engineer)"),
      takes(81, "object_index", u16, Source::object_index, kViewer, "for Modbus RTU drives: the register"),
      takes(82, "object_subindex", u16, Source::object_subindex, kViewer),
      takes(83, "object_size", u16, Source::object_size, kViewer, "1, 2 or 4", "bytes"),
      takes(84, "object_data", u32, Source::object_data, kViewer),
      shows(86, "object_status", u16, Source::object_status, "0 idle, 1 busy, 2 done, 3 failed"),
      shows(88, "object_detail", u32, Source::object_detail),
      shows(90, "units_per_rev_numerator", u32, Source::units_numerator,
            "position units of a motor turn, in lowest terms: 90 divided by 92"),
      shows(92, "units_per_rev_denominator", u32, Source::units_denominator),
      shows(94, "rated_speed", u32, Source::rated_speed,
            "of the motor, as its drive's constants say; 4294967295: not known", "0.001 rpm"),
      shows(96, "owner_address", u32, Source::owner_address,
            "IPv4 address of the owner, 192.168.1.7 as 0xC0A80107; 0: nobody, or not IPv4"),
      shows(98, "loss_stop_ms", u16, Source::loss_stop_ms,
            "the drive begins to stop by itself so soon after the gateway has died; 0: it goes on (alarm "
            "no_comm_watchdog); 65535: not known, as of a drive that was not set up, or was found enabled",
            "ms"),
  };
}

std::vector<RegisterRow> overview_register_rows() {
  using enum Quantity;
  return {
      of(0, statusword),
      of(1, mode_display),
      of(2, position_actual),
      of(4, velocity_actual),
      of(6, torque_actual),
      of(7, error_code),
      shows(8, "link_state", u16, Source::link_state),
      shows(9, "sequence", u16, Source::sequence),
  };
}

std::vector<RegisterRow> gateway_register_rows() {
  return {
      shows(0, "map_version", u16, Source::map_version),
      shows(1, "axis_count", u16, Source::axis_count),
      shows(2, "gateway_state", u16, Source::gateway_state, lists().gateway_state),
      shows(3, "axes_online", u16, Source::axes_online),
      shows(4, "uptime_s", u32, Source::uptime_s, {}, "s"),
      shows(6, "alarms", u16, Source::gateway_alarms, lists().gateway_alarms),
      shows(7, "role", u16, Source::role, "of this client: 0 none, 1 viewer, 2 operator, 3 engineer"),
      takes(8, "heartbeat", u16, Source::gateway_heartbeat, kViewer,
            "a changed value renews this client's leases with renew heartbeat"),
      shows(10, "word_order_test", u32, Source::word_order_test, "always 0x01020304"),
  };
}

std::vector<RegisterRow> bus_register_rows() {
  return {
      shows(0, "link", u16, Source::bus_link, "0 down, 1 up, 2 suspect"),
      shows(1, "load", u16, Source::bus_load, {}, "0.1 %"),
      shows(2, "cycle_ms", u16, Source::bus_cycle_ms, {}, "ms"),
      shows(3, "queue_depth", u16, Source::bus_queue_depth),
      shows(4, "requests", u32, Source::bus_requests),
      shows(6, "replies", u32, Source::bus_replies),
      shows(8, "timeouts", u32, Source::bus_timeouts),
      shows(10, "bad_frames", u32, Source::bus_bad_frames),
      shows(12, "late_replies", u32, Source::bus_late_replies),
      shows(14, "dropped_bytes", u32, Source::bus_dropped_bytes),
      shows(16, "refused", u32, Source::bus_refused),
      shows(18, "coalesced", u32, Source::bus_coalesced),
      shows(20, "superseded", u32, Source::bus_superseded),
      shows(22, "reconnects", u32, Source::bus_reconnects),
      shows(24, "echoes", u32, Source::bus_echoes, "copies of its own requests that the line brought back"),
  };
}

}  // namespace axisgate
