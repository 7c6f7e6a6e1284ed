// SPDX-License-Identifier: Apache-2.0
// The two clocks of a program: the steady one, which the gateway shares, and the time of day.
// Promises nanoseconds.
// Never is looked at by what decides.
#pragma once

#include <ctime>

#include "gateway/upstream/link/coder.hpp"

namespace axisgate::program {

using link::SteadyNs;

[[nodiscard]] inline SteadyNs clock_ns(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return SteadyNs{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

[[nodiscard]] inline SteadyNs steady_now() { return clock_ns(CLOCK_MONOTONIC); }
/// What is to be added to a steady instant.
[[nodiscard]] inline std::int64_t time_of_day_difference() { return clock_ns(CLOCK_REALTIME) - steady_now(); }

/// An instant of the time of day; 0 where there is none.
[[nodiscard]] inline SteadyNs to_steady(std::int64_t of_day) {
  return of_day <= 0 ? 0 : of_day - time_of_day_difference();
}
/// When something was received, by the time of day: never ahead of now, and now where that is not known.
[[nodiscard]] inline SteadyNs received_at(std::int64_t of_day) {
  const SteadyNs at = to_steady(of_day);
  const SteadyNs now = steady_now();
  return at <= 0 || at > now ? now : at;
}

}  // namespace axisgate::program
