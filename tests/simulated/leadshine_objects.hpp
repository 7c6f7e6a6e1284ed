// SPDX-License-Identifier: Apache-2.0
// The Leadshine LD2-CAN's objects from 2000h on and its alarms, as tables from its manual.
// Promises every row of the sheet's sections 3.2 to 3.5 and 6, with what is printed of width, range and default.
// Never lists the communication objects (1000h): CanopenNode holds those.
#pragma once

#include <span>

#include "tests/simulated/object_entry.hpp"

namespace axisgate::simulated {

std::span<const ObjectEntry> leadshine_parameters();
std::span<const ObjectEntry> leadshine_objects();

struct LeadshineAlarm {
  std::uint16_t error_code;     // 603Fh
  std::uint16_t alarm;          // as the PC tool shows it, in hex
  std::uint8_t error_register;  // 1001h
};

// One of the table, or an unknown one.
LeadshineAlarm leadshine_alarm(std::uint16_t error_code);

}  // namespace axisgate::simulated
