// SPDX-License-Identifier: Apache-2.0
// What the history of axisgate-web takes of memory and processor, in simulated time: axes whose eight values are others
// in each sample, 100 times a second, with the memory that is its own by default.
#pragma once

#include "tests/bench/report.hpp"

namespace axisgate::bench {

void history_figures(Report& report, bool quick);

}  // namespace axisgate::bench
