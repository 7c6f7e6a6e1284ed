// SPDX-License-Identifier: Apache-2.0
// The built-in CiA 402 machine of an axis whose drive has none (design 2 and 3.4): its state, and what became of the
// motion it started. Pure: controlwords, starts and samples in, a statusword out.
// Promises that it shows nothing the drive did not tell: enabled only while the drive holds torque and the gate is
// open, target reached only where the axis has stopped at its target. Never opens a gate of its own but by a
// controlword; an axis found moving at bring-up is shown enabled, because it is, and so is a motor whose drive has an
// enable for it (VirtualProperties::gate_only false), whenever it holds torque.
#pragma once

#include <cstdint>
#include <optional>

#include "gateway/drive/motion/motion.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::drive {

class VirtualAxis {
 public:
  /// A start shows in the drive's state by then, or the motion was too short to be seen.
  static constexpr Duration kStartShows = std::chrono::milliseconds(300);

  /// The newest samples, judged by the profile's conditions.
  struct Seen {
    Instant at = kLongAgo;       ///< now
    std::uint64_t exchange = 0;  ///< the oldest of those that gave the state
    bool enabled = false;        ///< the drive holds torque
    bool fault = false;
    bool limit = false;
    bool moving = false;
    bool standing = true;  ///< the profile's "reached" condition
    bool homed_at = true;  ///< the position is where homing leaves it
    bool at_velocity = false;
    std::optional<std::int64_t> position;  ///< as the drive counts
    std::uint64_t position_exchange = 0;
    std::uint16_t controlword = 0;
    int mode = 0;
    MotionKind running = MotionKind::none;
    bool speed_asked = false;  ///< the set-point of a run is not 0
    /// Grows with each loss of an exchange: what the drive did meanwhile nobody has seen.
    std::uint64_t invalidations = 0;
  };

  /// The drive comes up from scratch: switch on disabled, nothing known.
  void reset() { *this = VirtualAxis{}; }
  /// The drive counts from somewhere else: what a homing has found is true no more.
  void forget_homing() {
    if (run_.kind == MotionKind::homing) end_ = End::none;
  }
  /// A controlword was carried out: its step in the state machine (CiA 402-2, 8.4).
  void control(std::uint16_t word, const model::VirtualProperties& facts);
  /// The drive has acknowledged a start in this exchange. `goal`: where the position will be, as the drive counts.
  void started(MotionKind kind, std::optional<std::int64_t> goal, Instant now, std::uint64_t exchange);
  void observe(const Seen& seen, const model::VirtualProperties& facts);
  /// The first look after reset() has found it enabled, by no word of ours (once).
  [[nodiscard]] bool take_found_enabled();

  [[nodiscard]] std::uint16_t statusword(const Seen& seen) const;
  /// The motion started last ended, but not where it should have.
  [[nodiscard]] bool motion_failed() const { return end_ == End::failed && run_.kind != MotionKind::homing; }
  [[nodiscard]] bool homing_failed() const { return end_ == End::failed && run_.kind == MotionKind::homing; }
  [[nodiscard]] bool homing_attained() const { return end_ == End::reached && run_.kind == MotionKind::homing; }
  /// Torque is on although the axis is not enabled, and no command of the bus can take it away.
  [[nodiscard]] bool cannot_deenergise(const Seen& seen, const model::VirtualProperties& facts) const {
    return facts.gate_only && seen.enabled && gate_ != Gate::open;
  }

 private:
  enum class Gate : std::uint8_t { unknown, disabled, ready, switched_on, open, quick_stopped };
  enum class End : std::uint8_t { none, reached, failed };
  struct Run {
    MotionKind kind = MotionKind::none;
    std::optional<std::int64_t> goal;
    Instant since = kLongAgo;
    std::uint64_t exchange = 0;
    bool under_way = false;
    bool moved = false;
    std::uint64_t seen_moving = 0;       ///< Seen::invalidations then
    std::uint64_t stopped = 0;           ///< exchange that showed the axis standing again; 0: none yet
    std::optional<std::int64_t> rest{};  ///< the first position read since
    std::uint64_t rest_exchange = 0;
  };
  void keep_gate(const Seen& seen);
  void follow_drive(const Seen& seen);
  void follow(const Seen& seen, const model::VirtualProperties& facts);

  Gate gate_ = Gate::unknown;
  bool found_enabled_ = false;
  bool shows_gate_ = false;  ///< what a disabled axis was sent (6, 7) shows: its drive has an enable of its own
  Run run_;
  End end_ = End::none;
};

}  // namespace axisgate::drive
