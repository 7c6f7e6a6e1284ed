// SPDX-License-Identifier: Apache-2.0
// The options of a Keya in `--line`: any parameter of its manual as NUMBER=VALUE (0020=3: motor A in absolute position
// mode), and the points the manual leaves open: coast or ramp (on the watchdog's expiry), queries-feed, repeat-ignored
// (the same relative position again moves nothing), zero-ignored (enable with value 0 is no move to 0), other-kept
// (serial code 01 leaves motor B as it is), sub-00 (in acknowledges), keeps-counts (over a restart), period-only
// (TPDOs do not go when a value changes), heartbeat=MS (RS232's period, 0 for none; 1017h on CANopen).
// Promises messages that name the word which is wrong. Never makes a drive.
#pragma once

#include "tests/axisgate_sim/spec_words.hpp"
#include "tests/simulated/keya_options.hpp"

namespace axisgate::simulated {

void modify_keya(KeyaOptions& drive, std::string_view word);

}  // namespace axisgate::simulated
