// SPDX-License-Identifier: Apache-2.0
// How one simulated Keya KYDAS4860-2E is made: node, parameters as the maker's tool has stored them, mechanics, and the
// points the manual leaves open. Promises that where the manual has two readings the default is the one that can hurt.
// Never changes while the drive runs.
#pragma once

#include <cstdint>
#include <map>

#include "tests/simulated/mechanics.hpp"
#include "tests/simulated/time.hpp"

namespace axisgate::simulated {

enum class KeyaMotorName : std::uint8_t { a, b };

// Parameter 0019.
enum class KeyaInterface : std::uint8_t {
  analog = 1,
  can = 2,
  rs232 = 3,
  rc = 4,
  canopen = 5,
  rs485 = 7,
  centred_analog = 8,
};

// Parameters 0020 and 0050.
enum class KeyaMode : std::uint8_t { speed = 1, torque = 2, absolute = 3, relative = 4 };

// How a motor ends that the watchdog has disabled.
enum class KeyaStop : std::uint8_t { coast, ramp };

struct KeyaOptions {
  std::uint8_t node = 1;                            // 0018
  std::map<int, std::int64_t> parameters{};         // by their numbers; 0019 is the interface it hangs on if not here
  std::uint32_t version = 20220313;                 // of the program, yyyymmdd
  Time boot_time = std::chrono::seconds(1);         // not in the manual
  Time heartbeat = std::chrono::milliseconds(100);  // on RS232: "period not stated"; 0: none
  std::uint16_t producer_heartbeat = 0;             // 1017h as stored, ms; the default is not printed
  Mechanics mechanics{};

  // Not in the manual (12), or printed in two ways, so tests may choose.
  bool queries_feed_watchdog = false;    // "control commands", so they do not
  KeyaStop loss_stop = KeyaStop::coast;  // on the watchdog's expiry; the brake falls after 0027/0057 in any case
  bool repeated_move_moves = true;       // the same relative position again is one more move
  bool enable_with_zero_moves = true;    // enable and value 0 in one frame is a move to 0 in absolute position mode
  bool code_disables_other = true;       // serial code 01 disables motor B, 02 motor A; else it is left as it is
  bool echoes_sub = true;                // of CAN acknowledges; other Keya products send 00 there (13)
  bool keeps_counts = false;             // over a power cycle; an incremental encoder does not
  bool queries_always = true;            // answered although 0019 names another interface, as the maker's tool needs it
  bool pdo_on_change = true;  // TPDOs go when a value changes (sub 3 apart) and after sub 5; else after sub 5
};

}  // namespace axisgate::simulated
