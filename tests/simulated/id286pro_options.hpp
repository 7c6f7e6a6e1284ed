// SPDX-License-Identifier: Apache-2.0
// How one simulated iD286pro is made: address, what its EEPROM holds, its mechanics, and the points the sheet leaves
// open. Promises that the defaults give a commissioned drive: internal pulses chosen and stored.
// Never changes while the drive runs.
#pragma once

#include <cstdint>
#include <map>

#include "tests/simulated/mechanics.hpp"
#include "tests/simulated/time.hpp"

namespace axisgate::simulated {

struct Id286proOptions {
  std::uint8_t unit = 1;        // up to 31 on the switches; above, all switches are OFF and it stands in 0298
  bool switches_off = false;    // 0298 holds the address whatever it is
  bool internal_pulses = true;  // 0296 as stored; delivered with 0, external pulses
  std::map<std::uint16_t, std::int64_t> stored{};  // other registers as they were stored before the world began
  // Places in pulses. A switch is wired to each input that has its function: 9 positive limit, 10 negative limit,
  // 11 origin; active beyond its place, or between home_from and home_to.
  Mechanics mechanics{};
  Time answer_delay = std::chrono::milliseconds(20);

  // Not in the sheet (iD286pro 12), so tests may choose.
  Time boot_time = std::chrono::seconds(1);
  Time restart_after = std::chrono::milliseconds(50);  // from 0206 = 3 to the restart
  bool holes_read_zero = false;                        // a read across a gap: zeros, or exception 2
  bool speed_follows_register = false;   // a changed 0307 acts while it runs; else only with a new 0323 = 3
  bool command_reads_back = true;        // 0323 reads the last command; else it clears itself
  bool refuses_what_cannot_act = false;  // a command at the wrong time: exception 4; else acknowledged without effect
  bool obeys_address_zero = false;       // "global" is 255; the standard's 0 is not mentioned
  bool unknown_are_stored = true;        // 0308 to 0315 survive a restart
  std::uint16_t most_registers = 125;    // of one request
};

}  // namespace axisgate::simulated
