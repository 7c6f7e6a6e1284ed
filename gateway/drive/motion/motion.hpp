// SPDX-License-Identifier: Apache-2.0
// The motion rules of design 3.4 for one axis, the same on every drive: the stop latch, what runs, what survives, and
// which set-points may reach the drive now. Promises that only start() begins a motion, that every stop, fault,
// disable, restart and loss of the drive ends it for good, and that a latched axis starts nothing. Never sends:
// planners ask it, the axis tells it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "gateway/drive/motion/sightings.hpp"
#include "gateway/image/axis_image.hpp"

namespace axisgate::drive {

enum class MotionKind : std::uint8_t { none, discrete, velocity, torque, homing };

/// The stop latch: a quick stop or a lease's action sets it; an enable leaves it, or two raw words, 6 or 7 and then 15.
/// Axes that are stopped as one have one: each that was stopped has to leave it, the others are latched with it.
class StopLatch {
 public:
  void set(AxisSlot axis) { by_ |= bit(axis); }
  void leave(AxisSlot axis) {
    by_ &= ~bit(axis);
    armed_ = false;
  }
  /// A 6 or 7 that went before was no step out of it.
  void disarm() { armed_ = false; }
  [[nodiscard]] bool latched() const { return by_ != 0; }
  /// By the stop of another axis: this one's enable does not leave it.
  [[nodiscard]] bool latched_by_another(AxisSlot axis) const { return (by_ & ~bit(axis)) != 0; }
  /// While latched, `controlword` passes only stops and the two steps.
  [[nodiscard]] bool passes(model::Request402 request, AxisSlot axis) const;
  /// Such a word was carried out; true: it was the second step.
  bool passed(model::Request402 request);

 private:
  [[nodiscard]] static unsigned bit(AxisSlot axis) { return 1U << axis; }
  unsigned by_ = 0;     ///< the axes that were stopped
  bool armed_ = false;  ///< the first step was taken
};

class Motion {
 public:
  /// `velocity_lag`: how long after a change the sampled velocity may still show what was before.
  /// `record`: its axis's, where it notes each stop, each end, and what it sees of faults and losses.
  Motion(Duration velocity_lag, AxisRecord& record) : velocity_lag_(velocity_lag), record_(record) {}

  [[nodiscard]] AxisRecord& record() const { return record_; }
  /// It is the axis at `slot` of those that have this one's latch.
  void share(const Motion& first, AxisSlot slot) {
    latch_ = first.latch_;
    slot_ = slot;
  }

  // --- Stops and the stop latch -------------------------------------------------------------------------------------

  /// A stop was accepted: the motion is over, velocity and torque are needed again. `latch`: quick_stop and lease
  /// actions. `at`: the point of what it is a part of; none: it is accepted now.
  void stop(bool latch, Instant now, std::optional<AxisRecord::Point> at = {});
  /// One was accepted while it moved, or may have, and it was not seen to stand since.
  [[nodiscard]] bool stopping() const { return stopping_; }
  /// An enable accepted after the stop has been carried out (command 1, coil 0).
  void enabled() {
    raw_run_ = false;
    latch_->leave(slot_);
  }
  /// The same of an axis that was enabled all the time: nothing was sent, and a raw run goes on.
  void unlatch() { latch_->leave(slot_); }
  [[nodiscard]] bool latched() const { return latch_->latched(); }
  /// By the stop of an axis that is stopped as one with it.
  [[nodiscard]] bool latched_by_another() const { return latch_->latched_by_another(slot_); }
  /// The quick stop that latched it goes to the drive now, or the drive has restarted or is out of sight.
  void disarm() { latch_->disarm(); }
  [[nodiscard]] bool passes(model::Request402 request) const { return latch_->passes(request, slot_); }
  void passed(model::Request402 request) {
    if (latch_->passed(request)) enabled();
  }

  // --- What runs -----------------------------------------------------------------------------------------------------

  /// Commands 6 to 11 need an axis that is enabled, not faulted and not stop-latched.
  [[nodiscard]] bool may_start(const AxisFacts& facts) const {
    return facts.enabled() && facts.commanded && !latched();
  }
  /// Standstill, as a relative move and set_position need it, and as axis_state shows it of an enabled axis.
  [[nodiscard]] bool at_rest(const AxisFacts& facts) const;
  /// It has been seen at rest from then on; kNever: not by the newest samples.
  [[nodiscard]] Instant rests_since() const { return rests_since_; }
  /// The motion started last was completed, and nothing has ended anything since.
  [[nodiscard]] bool arrived() const { return run_.arrived; }
  /// A motion command was accepted: target_reached reads 0 from now until it is `masked` no more.
  void mask_target_reached(bool masked = true) { target_reached_masked_ = masked; }
  [[nodiscard]] bool target_reached_masked() const {
    return target_reached_masked_ || (run_.awaits_fall && run_.kind == MotionKind::discrete) || end_wants_position();
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
  /// New samples. Ends the motion where they show its end.
  void observe(const AxisFacts& facts, Duration homing_timeout);
  /// Homing has run longer than its timeout: the axis must be halted (once).
  [[nodiscard]] bool take_homing_timeout() { return std::exchange(homing_timed_out_, false); }
  /// A value that came by itself shows its end, and may be of before its start (ANS-2): only a read now settles it.
  [[nodiscard]] bool end_wants_sample(const AxisFacts& facts) const;
  /// The drive has reported that it is at its target, and the position shown is of before: it is read next, and only
  /// then is the motion completed. Who acts on the end of a move looks where the axis is.
  [[nodiscard]] bool end_wants_position() const { return run_.end.has_value(); }
  /// Whether it stands after a stop only a velocity sampled now can tell.
  [[nodiscard]] bool rest_wants_sample(const AxisFacts& facts) const;
  /// When observe() must be called even without samples.
  [[nodiscard]] Instant deadline() const;

  [[nodiscard]] MotionKind running() const { return run_.kind; }
  [[nodiscard]] MotionState state() const { return run_.state; }
  [[nodiscard]] std::uint16_t id() const { return run_.id; }
  [[nodiscard]] AxisState axis_state(const AxisFacts& facts) const;

  // --- Set-points are not starts -------------------------------------------------------------------------------------

  /// Whether a write of this quantity may go to the drive now. `held_back`: by this drive the write itself would move
  /// the axis (profile `trigger`, or a maker's bit in the controlword in effect).
  [[nodiscard]] bool target_acts_now(Quantity target, const AxisFacts& facts, bool held_back) const;

 private:
  /// What was started last: it runs, or has ended.
  struct Run {
    /// A statusword has shown its end, while an older position is shown.
    struct End {
      std::uint64_t exchange = 0;  ///< of that statusword
      Instant until = kNever;      ///< so long a newer position is waited for
    };
    MotionKind kind = MotionKind::none;  ///< none: it has ended
    MotionState state = MotionState::none;
    std::uint16_t id = 0;
    Instant since = kLongAgo;
    std::uint64_t by = 0;  ///< exchange: only statuswords sampled after it tell of this motion
    /// Bit 10 may still tell of the move before, until it was seen to fall or the axis stands all the same.
    bool awaits_fall = false;
    bool arrived = false;  ///< it was completed, and nothing has ended anything since
    std::optional<End> end{};
    Instant homing_until = kNever;
  };
  /// Nothing runs any more: it has ended so, or completed where its end was shown before.
  void over(MotionState how);
  void end(MotionState how);
  void complete(Instant now);
  /// The statusword shows the end of the motion: completes it once the position shown is no older.
  void complete_with_position(const AxisFacts& facts);
  /// A velocity sampled late enough to show the newest start, stop or end shows that the axis stands.
  [[nodiscard]] bool stands(const AxisFacts& facts) const;
  void look_for_end(const AxisFacts& facts, Duration homing_timeout);
  void observe_homing(const AxisFacts& facts, Duration timeout);
  [[nodiscard]] bool move_under_way(const AxisFacts& facts) const;
  /// A start of ours runs by a target velocity or torque.
  [[nodiscard]] bool follows_target() const {
    return run_.kind == MotionKind::velocity || run_.kind == MotionKind::torque;
  }

  Duration velocity_lag_;
  AxisRecord& record_;
  std::shared_ptr<StopLatch> latch_ = std::make_shared<StopLatch>();
  AxisSlot slot_ = 0;
  Run run_{};
  bool raw_run_ = false;
  bool stopping_ = false;
  bool target_reached_masked_ = false;
  bool homing_timed_out_ = false;
  bool acknowledges_ = true;      ///< the drive says that it took a set-point, as far as seen last
  Instant rests_since_ = kNever;  ///< by the newest samples, with no set-point that it follows; kNever: not
  /// The sampled velocity tells the truth of the newest start, stop or end from then on.
  Instant settled_from_ = kLongAgo;
  Instant seen_ = kLongAgo;  ///< the newest instant of observe()
  Sightings sightings_{};
};

}  // namespace axisgate::drive
