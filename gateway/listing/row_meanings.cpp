// SPDX-License-Identifier: Apache-2.0
#include "gateway/listing/row_meanings.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace axisgate::listing {
namespace {

struct Meaning {
  std::string_view name;
  std::string_view words;
};

constexpr auto kAxisMeanings = std::to_array<Meaning>({
    {"statusword", "CiA 402 statusword of the drive"},
    {"mode_display", "mode that the drive is in"},
    {"position_actual", "where the motor is"},
    {"velocity_actual", "how fast it turns, with its sign"},
    {"torque_actual", "torque, of the rated one"},
    {"current_actual", "current of the motor"},
    {"following_error", "how far it is behind its target"},
    {"error_code", "fault of the drive, 0: none"},
    {"digital_inputs", "inputs of the drive, by bit"},
    {"vendor_error", "fault words as the drive has them"},
    {"digital_outputs", "outputs of the drive, by bit"},
    {"drive_temperature", "temperature of the drive"},
    {"motor_temperature", "temperature of the motor"},
    {"dc_voltage", "voltage of the drive's DC link"},
    {"link_state", "whether the drive answers, 2: yes"},
    {"age_ms", "age of the oldest cyclic value"},
    {"supported", "quantities that it has, by bit"},
    {"valid", "quantities that are good, by bit"},
    {"sequence", "steps when anything changes"},
    {"command_result", "what became of the last command"},
    {"command_detail", "why it was refused"},
    {"owner", "who has the axis"},
    {"lease_remaining_ms", "until the lease runs out"},
    {"command_id_seen", "last command_id that has come"},
    {"axis_state", "what the axis does"},
    {"motion_state", "what became of the motion"},
    {"motion_id", "command_id of the motion"},
    {"axis_alarms", "alarms of the axis, by bit"},
    {"supported_commands", "commands that it has, by bit"},
    {"supported_modes", "modes that it has, by bit"},
    {"controlword", "CiA 402 controlword"},
    {"mode", "mode that it shall be in"},
    {"target_position", "where it shall go, commands 6, 7"},
    {"target_velocity", "how fast it shall run, command 8"},
    {"target_torque", "torque that it shall hold, command 9"},
    {"max_torque", "most torque that it may use"},
    {"profile_velocity", "speed of moves"},
    {"profile_acceleration", "ramp up"},
    {"profile_deceleration", "ramp down"},
    {"command", "what it shall do, 0: nothing"},
    {"command_id", "a new number for each command"},
    {"heartbeat", "changes while the client is alive"},
    {"jog_velocity", "speed of the jog coils"},
    {"homing_method", "how it finds its reference"},
    {"homing_speed_switch", "speed to the reference switch"},
    {"homing_speed_zero", "speed from there to the zero"},
    {"homing_acceleration", "ramp of homing"},
    {"homing_offset", "offset of the zero to the reference"},
    {"quick_stop_deceleration", "ramp of quick stops"},
    {"position_limit_min", "least position that it takes"},
    {"position_limit_max", "greatest position that it takes"},
    {"max_velocity", "highest speed that it takes"},
    {"set_position_value", "position that command 11 sets"},
    {"object_request", "reads or writes an object"},
    {"object_index", "index of the object"},
    {"object_subindex", "subindex of the object"},
    {"object_size", "size of the object"},
    {"object_data", "value of the object"},
    {"object_status", "what became of the request"},
    {"object_detail", "why it has failed"},
    {"units_per_rev_numerator", "units of a turn, numerator"},
    {"units_per_rev_denominator", "units of a turn, denominator"},
    {"rated_speed", "rated speed of the motor"},
    {"owner_address", "IPv4 address of the owner"},
    {"loss_stop_ms", "until it stops without a gateway"},
});

constexpr auto kGatewayMeanings = std::to_array<Meaning>({
    {"map_version", "version of this map"},
    {"axis_count", "axes that are configured"},
    {"gateway_state", "how the gateway is"},
    {"axes_online", "axes that answer"},
    {"uptime_s", "time since its start"},
    {"alarms", "alarms of the gateway, by bit"},
    {"role", "what this client may do"},
    {"heartbeat", "changes while the client is alive"},
    {"word_order_test", "tells the order of the halves"},
});

constexpr auto kBusMeanings = std::to_array<Meaning>({
    {"link", "whether the bus is up"},
    {"load", "share of its time that is in use"},
    {"cycle_ms", "time of one round of fast values"},
    {"queue_depth", "requests that wait"},
    {"requests", "requests that were sent"},
    {"replies", "replies that have come"},
    {"timeouts", "replies that did not come"},
    {"bad_frames", "frames that were damaged"},
    {"late_replies", "replies that came too late"},
    {"dropped_bytes", "bytes that belonged to nothing"},
    {"refused", "refused, as its queue was full"},
    {"coalesced", "reads that joined one that waited"},
    {"superseded", "set-points that a newer one replaced"},
    {"reconnects", "times that it was opened anew"},
    {"echoes", "own requests that came back"},
});

constexpr auto kCoilMeanings = std::to_array<Meaning>({
    {"enable", "1: torque on, 0: torque off"},
    {"fault_reset", "clears a fault"},
    {"quick_stop", "stops at once, and latches"},
    {"halt", "1: halts, 0: ends the halt"},
    {"start_absolute", "moves to target_position"},
    {"start_relative", "moves by target_position"},
    {"home", "looks for its reference"},
    {"run_velocity", "1: runs at target_velocity, 0: halts"},
    {"jog_forward", "runs while 1 is written on and on"},
    {"jog_reverse", "the same, the other way"},
});

constexpr auto kInputMeanings = std::to_array<Meaning>({
    {"online", "the drive answers"},
    {"ready", "it could be enabled"},
    {"enabled", "it has torque"},
    {"fault", "the drive has a fault"},
    {"warning", "a warning, or an alarm of the axis"},
    {"target_reached", "it is where it shall be"},
    {"homed", "it knows where it is"},
    {"moving", "it moves"},
    {"limit_active", "it is at a limit"},
    {"quick_stop_active", "a quick stop is there, or latched"},
    {"following_error", "it is too far behind its target"},
    {"owned_by_me", "this client owns the axis"},
    {"stop_latched", "a stop waits for the next enable"},
});

std::string_view found_in(std::span<const Meaning> meanings, std::string_view name) {
  const auto found = std::ranges::find(meanings, name, &Meaning::name);
  return found == meanings.end() ? std::string_view{} : found->words;
}

}  // namespace

std::string_view register_meaning(Block block, std::string_view name) {
  if (block == Block::gateway) return found_in(kGatewayMeanings, name);
  return block == Block::bus ? found_in(kBusMeanings, name) : found_in(kAxisMeanings, name);
}
std::string_view coil_meaning(std::string_view name) { return found_in(kCoilMeanings, name); }
std::string_view input_meaning(std::string_view name) { return found_in(kInputMeanings, name); }

}  // namespace axisgate::listing
