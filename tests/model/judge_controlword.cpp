// SPDX-License-Identifier: Apache-2.0
// What controlwords do, and what they are answered with (3.4).
#include "tests/model/judge.hpp"

namespace axisgate::test::reference {

bool Judge::controlword(std::int64_t value, bool single, Verdict& verdict) {
  verdict = {"acts: controlword " + std::to_string(value), {0}, true};
  const std::int64_t step = value & 15;
  const bool start = (value & 16) != 0;
  me().controlword.refused = true;  // unless it comes to the end
  if (step == 15 && refuse_foreign(verdict)) return false;
  // 3.4: "from a client that does not own the axis these last two count only as single writes".
  if ((step == 6 || step == 7) && foreign() && (!single || readings_.other())) return !refuse_foreign(verdict);
  me().controlword.refused = false;
  // 3.4: stops are "open to every operator, without taking the lease".
  if (!foreign() && (step == 15 || world_.owner == client_ || readings_.other())) claim();
  if (world_.faulted && (!options_.by_gateway || readings_.other())) {
    world_.faulted = (value & 128) == 0 || readings_.other();
    stopped(false);
    return true;
  }
  if (step == 15 && !world_.enabled) {
    // 3.4: the latch lasts until "controlword 6 or 7 and then 15". From 6 straight to 15 drives differ, and what a
    // disable or a quick stop leaves is the drive's affair.
    if (world_.latched && world_.ladder == 0) {
      verdict = {"refused: controlword 15 while latched, without 6 or 7", {4}};
      return false;
    }
    if (world_.ladder != 7 && readings_.other()) return true;
    world_.enabled = true;
    world_.enable_asked_ms = seen_.now_ms;
    world_.latched = false;
    world_.ladder = 15;
    world_.start_bit = start;
    world_.motor = Motor::stands;
    // Whether a mode that a command has left is a raw mode is not said.
    if ((world_.accepted.contains(row::mode) && world_.accepted[row::mode] == kVelocityMode) ||
        ((world_.speed_mode || !options_.rows.contains(row::target_position)) && readings_.other())) {
      world_.raw_mode = kVelocityMode;
      world_.motor = Motor::runs;  // 3.4: raw mode 3 runs
      renew_speed();
    }
    if (start) world_.motor = Motor::unknown;
    return true;
  }
  if (step == 15) {
    const bool rising = start && !world_.start_bit;
    const bool maybe = start && world_.start_bit;  // the gateway's own words set bit 4 as they like
    world_.start_bit = start;
    const bool position = world_.accepted.contains(row::mode) && world_.accepted[row::mode] == 1;
    if (position && (rising || (maybe && readings_.other()))) {
      world_.motor = world_.held ? Motor::unknown : Motor::moves;
      world_.target = world_.accepted.contains(row::target_position) ? world_.accepted[row::target_position] : 0;
    }
    // Whether a mode that a command has left is a raw mode is not said.
    if (world_.speed_mode && readings_.other()) world_.raw_mode = kVelocityMode;
    // In mode 3, standing: see accept(). 3.4, what survives: "velocity, torque and start are needed anew": by one that
    // was accepted before a stop, or beside it, nothing runs.
    if (world_.raw_mode == 3 && world_.motor == Motor::stands && !world_.stale_speed && readings_.other())
      world_.motor = Motor::runs;
    return true;
  }
  // 3.3: bit 1 = 0, bit 2 = 0, or bits 0..3 = 6 or 7; 3.3 Zeros: going to 0 is a stop.
  stopped(step == 0 && readings_.other());
  // 3.4: "from a client that does not own the axis these last two count only as single writes": also where nobody does.
  if ((step == 6 || step == 7) && !single && (!options_.leases || world_.owner != client_) && readings_.other())
    stopped_ = false;
  world_.off_asked_ms = seen_.now_ms;
  const bool from_ready = world_.ladder == 6 || world_.ladder == 7 || world_.enabled;
  world_.enabled = false;
  if (step != 7)
    world_.ladder = step == 6 ? 6 : 0;
  else if (from_ready || options_.by_gateway || readings_.other())
    world_.ladder = 7;
  return true;
}

}  // namespace axisgate::test::reference
