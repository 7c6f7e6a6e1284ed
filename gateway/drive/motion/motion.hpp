// SPDX-License-Identifier: Apache-2.0
// The motion rules of design 3.4 for one axis, the same on every drive: the stop latch, what runs, what survives, and
// which set-points may reach the drive now. Promises that only start() begins a motion, that every stop, fault,
// disable, restart and loss of the drive ends it for good, and that a latched axis starts nothing. Never sends:
// planners ask it, the axis tells it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "gateway/drive/motion/sightings.hpp"
#include "gateway/image/axis_image.hpp"

namespace axisgate::drive {

enum class MotionKind : std::uint8_t { none, discrete, velocity, torque, homing };

/// A target as a client asked for it.
struct Wanted {
  std::int64_t value = 0;               ///< in register units
  std::optional<std::int64_t> exact{};  ///< as the drive counts, where the object mailbox gave it so
  /// False: a velocity or torque that came in the request of a stop, or from who owns the axis no more. A command
  /// starts by it, and an enable; no raw word or mode on an axis that is enabled does.
  bool fresh = true;
};

class Motion {
 public:
  /// `velocity_lag`: how long after a change the sampled velocity may still show what was before.
  /// `record`: its axis's, where it notes each stop, each end, and what it sees of faults and losses.
  Motion(Duration velocity_lag, AxisRecord& record) : velocity_lag_(velocity_lag), record_(record) {}

  [[nodiscard]] AxisRecord& record() const { return record_; }

  // --- Stops and the stop latch -------------------------------------------------------------------------------------

  /// A stop was accepted: the motion is over, velocity and torque are needed again. `latch`: quick_stop and lease
  /// actions. `at`: the point of what it is a part of; none: it is accepted now.
  void stop(bool latch, Instant now, std::optional<AxisRecord::Point> at = {});
  /// One was accepted while it moved, or may have, and it was not seen to stand since.
  [[nodiscard]] bool stopping() const { return stopping_; }
  /// An enable accepted after the stop has been carried out (command 1, coil 0).
  void enabled() {
    raw_run_ = false;
    unlatch();
  }
  /// The same of an axis that was enabled all the time: nothing was sent, and a raw run goes on.
  void unlatch() {
    latched_ = false;
    unlatch_armed_ = false;
  }
  [[nodiscard]] bool latched() const { return latched_; }
  /// The quick stop that latched it goes to the drive now, or the drive has restarted or is out of sight: a 6 or 7 that
  /// went before it was no step out of the latch.
  void disarm() { unlatch_armed_ = false; }

  enum class Pass : std::uint8_t { refused, passes, passes_and_unlatches };
  /// While latched, `controlword` passes only stops and the two steps: 6 or 7, and then 15.
  [[nodiscard]] Pass pass(model::Request402 request) const;
  void passed(model::Request402 request);

  // --- What runs -----------------------------------------------------------------------------------------------------

  /// Commands 6 to 11 need an axis that is enabled, not faulted and not stop-latched.
  [[nodiscard]] bool may_start(const AxisFacts& facts) const { return facts.enabled() && facts.commanded && !latched_; }
  /// Standstill, as a relative move and set_position need it, and as axis_state shows it of an enabled axis.
  [[nodiscard]] bool at_rest(const AxisFacts& facts) const;
  /// It has been seen at rest from then on; kNever: not by the newest samples.
  [[nodiscard]] Instant rests_since() const { return rests_ ? rests_since_ : kNever; }
  /// The motion started last was completed, and nothing has ended anything since.
  [[nodiscard]] bool arrived() const { return arrived_; }
  /// A motion command was accepted: target_reached reads 0 from now until unmask().
  void mask_target_reached() { target_reached_masked_ = true; }
  void unmask_target_reached() { target_reached_masked_ = false; }
  [[nodiscard]] bool target_reached_masked() const {
    return target_reached_masked_ || (awaits_fall_ && kind_ == MotionKind::discrete) || ended_by_.has_value();
  }

  /// The drive has acknowledged a start in this exchange; a motion under way is aborted by it.
  void start(MotionKind kind, std::uint16_t id, Instant now, std::uint64_t exchange);
  /// A raw enable or mode write that lets set-points act at once (raw modes 3, 4, 9, 10). A drive may take its time to
  /// become enabled after it: only leaving that state ends the run, not that it is not reached yet. `by_enable`: it was
  /// not enabled before.
  void run_raw(bool by_enable = false);
  [[nodiscard]] bool runs_raw() const { return raw_run_; }
  /// Of a target that acts by this: a run that was found running goes on in the drive, in a mode that follows it.
  [[nodiscard]] bool goes_on(Quantity target, const AxisFacts& facts) const;
  /// It was enabled when the gateway first saw it, and nothing was asked of it since: whose motion it is nobody knows.
  [[nodiscard]] bool found_at_start() const { return sightings_.found_at_start() && !raw_run_; }
  /// Another client owns the axis: what runs goes on, and what stands is not run by what the one before has asked for.
  void owner_changed();
  /// The mode was changed: what ran in the mode before is over.
  void mode_changed();
  /// The drive counts otherwise from now on: what was asked for in its numbers is what the registers show of it.
  void scale_changed() {
    for (auto& wanted : wanted_)
      if (wanted) wanted->exact.reset();
  }
  /// New samples. Ends the motion where they show its end.
  void observe(const AxisFacts& facts, Duration homing_timeout);
  /// Homing has run longer than its timeout: the axis must be halted (once).
  [[nodiscard]] bool take_homing_timeout();
  /// A value that came by itself shows its end, and may be of before its start (ANS-2): only a read now settles it.
  [[nodiscard]] bool end_wants_sample(const AxisFacts& facts) const;
  /// The drive has reported that it is at its target, and the position shown is of before: it is read next, and only
  /// then is the motion completed. Who acts on the end of a move looks where the axis is.
  [[nodiscard]] bool end_wants_position() const { return ended_by_.has_value(); }
  /// Whether it stands after a stop only a velocity sampled now can tell.
  [[nodiscard]] bool rest_wants_sample(const AxisFacts& facts) const;
  /// When observe() must be called even without samples.
  [[nodiscard]] Instant deadline() const;

  [[nodiscard]] MotionKind running() const { return kind_; }
  [[nodiscard]] MotionState state() const { return state_; }
  [[nodiscard]] std::uint16_t id() const { return id_; }
  [[nodiscard]] AxisState axis_state(const AxisFacts& facts) const;

  // --- Set-points are not starts -------------------------------------------------------------------------------------

  /// A client has written a target: it is kept, whether or not it may reach the drive now.
  void want(Quantity target, Wanted wanted);
  /// What clients asked for last. Velocity and torque: none after anything that ended a motion for good.
  [[nodiscard]] std::optional<Wanted> wanted(Quantity target) const;
  /// Whether a write of this quantity may go to the drive now. `held_back`: by this drive the write itself would move
  /// the axis (profile `trigger`, or a maker's bit in the controlword in effect).
  [[nodiscard]] bool target_acts_now(Quantity target, const AxisFacts& facts, bool held_back) const;

 private:
  void end(MotionState how);
  void mark_targets(bool fresh);
  void complete(Instant now);
  /// The statusword shows the end of the motion: completes it once the position shown is no older.
  void complete_with_position(const AxisFacts& facts);
  /// A velocity sampled late enough to show the newest start, stop or end shows that the axis stands.
  [[nodiscard]] bool stands(const AxisFacts& facts) const;
  void observe_homing(const AxisFacts& facts, Duration timeout);
  [[nodiscard]] bool move_under_way(const AxisFacts& facts) const;

  Duration velocity_lag_;
  AxisRecord& record_;
  bool latched_ = false;
  bool unlatch_armed_ = false;
  bool raw_run_ = false;
  bool stopping_ = false;
  bool rests_ = false;  ///< by the newest samples, with no set-point that it follows
  Instant rests_since_ = kLongAgo;
  bool arrived_ = false;  ///< the motion started last was completed, and nothing has ended anything since
  bool target_reached_masked_ = false;
  bool homing_timed_out_ = false;
  MotionKind kind_ = MotionKind::none;
  MotionState state_ = MotionState::none;
  std::uint16_t id_ = 0;
  Instant started_ = kLongAgo;
  Instant settled_from_ =
      kLongAgo;  ///< the sampled velocity tells the truth of the newest start, stop or end from then on
  std::uint64_t started_by_ = 0;  ///< exchange: only statuswords sampled after it tell of this motion
  std::optional<std::uint64_t>
      ended_by_;                     ///< exchange whose statusword showed the end, while an older position is shown
  Instant position_until_ = kNever;  ///< and how long the end waits for a newer one
  Instant homing_until_ = kNever;
  bool acknowledges_ = true;  ///< the drive says that it took a set-point, as far as seen last
  /// It does not: bit 10 may still tell of the move before, until it was seen to fall or the axis stands all the same.
  bool awaits_fall_ = false;
  Instant seen_ = kLongAgo;  ///< the newest instant of observe()
  Sightings sightings_{};
  /// What clients last asked for: position, velocity, torque.
  std::array<std::optional<Wanted>, 3> wanted_;
};

}  // namespace axisgate::drive
