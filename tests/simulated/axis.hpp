// SPDX-License-Identifier: Apache-2.0
// The motor: demanded and actual position in 1/16384 count, moved one millisecond at a time.
// Promises exact integer steps, index pulses at their exact place, and a stand-still at stops or while jammed.
// Never decides where to go.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "tests/simulated/mechanics.hpp"
#include "tests/simulated/units.hpp"

namespace axisgate::simulated {

class Axis {
 public:
  Axis(const Mechanics& mechanics, std::int64_t encoder_counts)
      : mechanics_(mechanics), revolution_(encoder_counts * fine_per_count) {}

  // One millisecond at this demanded speed. Without a position loop the demand follows the actual position.
  // `direction` is 1, or -1 where 607E turns the counting direction round.
  void step(Dec speed, bool position_loop, int direction);

  Dec speed() const { return speed_; }                // demanded
  Dec actual_speed() const { return actual_speed_; }  // 0 while jammed or at a stop
  FinePosition demand() const { return demand_; }
  FinePosition actual() const { return actual_; }
  FinePosition physical() const { return physical_; }
  std::int64_t following_error() const { return counts_of(demand_ - actual_); }
  bool stalled() const { return stalled_; }
  // Where, in the drive's own counting, the last step passed an index pulse.
  std::optional<FinePosition> index_passed() const { return index_passed_; }

  void redefine(FinePosition actual);  // the position counter only; nothing moves
  void forget_demand() { demand_ = actual_; }
  void jam(bool jammed) { jammed_ = jammed; }
  // From now on the position loop follows only what is further away than this: its static error.
  void fall_short(FinePosition by) { short_by_ = by; }
  FinePosition short_by() const { return short_by_; }
  // What is told of its speed: up to so much more or less, and so many steps late.
  void blur(Dec noise, std::size_t late) { blur_ = {noise, late}; }
  bool blurred() const { return blur_.noise != 0 || blur_.late != 0; }
  Dec told_speed() const;

 private:
  const Mechanics& mechanics_;
  FinePosition revolution_;
  Dec speed_ = 0;
  Dec actual_speed_ = 0;
  FinePosition demand_ = 0;
  FinePosition actual_ = 0;
  FinePosition physical_ = 0;
  FinePosition short_by_ = 0;
  struct {
    Dec noise = 0;
    std::size_t late = 0;
  } blur_;
  std::deque<Dec> told_;     // the newest last
  std::uint64_t steps_ = 0;  // of a blurred one
  bool jammed_ = false;
  bool stalled_ = false;
  std::optional<FinePosition> index_passed_;
};

}  // namespace axisgate::simulated
