// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/cia402.hpp"

#include <array>

namespace axisgate::simulated {
namespace {

using enum Cia402State;
using enum Cia402Command;

struct TransitionRule {
  Cia402State from;
  Cia402Command command;
  Cia402State to;
};

// Numbers as in CiA 402. 0x06 means "motor off" in every state (JD 6.1, MD 8.1), hence the row out of quick stop.
constexpr std::array<TransitionRule, 18> transitions{{
    {switch_on_disabled, shutdown, ready_to_switch_on},         // 2
    {switch_on_disabled, switch_on, switched_on},               // 2 and 3 in one
    {switch_on_disabled, enable_operation, operation_enabled},  // 2, 3 and 4 in one: the printed RS232 sequences
    {ready_to_switch_on, switch_on, switched_on},               // 3
    {ready_to_switch_on, enable_operation, operation_enabled},  // 3 and 4 in one
    {ready_to_switch_on, disable_voltage, switch_on_disabled},  // 7
    {ready_to_switch_on, quick_stop, switch_on_disabled},       // 7
    {switched_on, shutdown, ready_to_switch_on},                // 6
    {switched_on, enable_operation, operation_enabled},         // 4
    {switched_on, disable_voltage, switch_on_disabled},         // 10
    {switched_on, quick_stop, switch_on_disabled},              // 10
    {operation_enabled, switch_on, switched_on},                // 5
    {operation_enabled, shutdown, ready_to_switch_on},          // 8
    {operation_enabled, disable_voltage, switch_on_disabled},   // 9
    {operation_enabled, quick_stop, quick_stop_active},         // 11
    {quick_stop_active, disable_voltage, switch_on_disabled},   // 12
    {quick_stop_active, shutdown, ready_to_switch_on},          // motor off
    {quick_stop_active, enable_operation, operation_enabled},   // 16, where the drive stays in quick stop
}};

}  // namespace

std::string_view name_of(Cia402State state) {
  switch (state) {
    case not_ready_to_switch_on:
      return "not_ready_to_switch_on";
    case switch_on_disabled:
      return "switch_on_disabled";
    case ready_to_switch_on:
      return "ready_to_switch_on";
    case switched_on:
      return "switched_on";
    case operation_enabled:
      return "operation_enabled";
    case quick_stop_active:
      return "quick_stop_active";
    case fault_reaction_active:
      return "fault_reaction_active";
    case fault:
      return "fault";
  }
  return "?";
}

Cia402Command command_in(std::uint16_t controlword) {
  if ((controlword & 0x0002) == 0) return disable_voltage;
  if ((controlword & 0x0004) == 0) return quick_stop;
  if ((controlword & 0x0001) == 0) return shutdown;
  return (controlword & 0x0008) == 0 ? switch_on : enable_operation;
}

std::optional<Cia402State> next_state(Cia402State from, Cia402Command command, bool only_from_ready) {
  if (only_from_ready && from == switch_on_disabled && command != shutdown) return std::nullopt;
  for (const TransitionRule& row : transitions) {
    if (row.from == from && row.command == command) return row.to;
  }
  return std::nullopt;
}

std::uint16_t state_bits(Cia402State state) {
  switch (state) {
    case not_ready_to_switch_on:
      return 0x0000;
    case switch_on_disabled:
      return 0x0050;
    case ready_to_switch_on:
      return 0x0031;
    case switched_on:
      return 0x0033;
    case operation_enabled:
      return 0x0037;
    case quick_stop_active:
      return 0x0017;
    case fault_reaction_active:
      return 0x001F;
    case fault:
      return 0x0018;
  }
  return 0;
}

}  // namespace axisgate::simulated
