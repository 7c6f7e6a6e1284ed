// SPDX-License-Identifier: Apache-2.0
// One change of a drive's CiA 402 state, and the request that caused it.
// Promises that tag 0 means "no request": an input, the motor, a fault or the power-up did it.
// Never refers to a request of another drive.
#pragma once

#include <cstdint>

#include "tests/simulated/cia402.hpp"
#include "tests/simulated/time.hpp"

namespace axisgate::simulated {

struct Transition {
  Time at;
  std::uint64_t tag;
  Cia402State from;
  Cia402State to;
};

}  // namespace axisgate::simulated
