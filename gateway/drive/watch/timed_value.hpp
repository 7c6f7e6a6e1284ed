// SPDX-License-Identifier: Apache-2.0
// One number that a drive has shown, and the instant before which it was not so. Pure. Promises no unit: its reader
// says it. Never tells whether it is still true.
#pragma once

#include "gateway/core/clock.hpp"

namespace axisgate::drive {

struct TimedValue {
  double value = 0;
  Instant at = kLongAgo;  ///< its request went on the wire; of what came by itself, its reception
};

}  // namespace axisgate::drive
