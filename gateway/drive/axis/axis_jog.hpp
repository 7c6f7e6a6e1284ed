// SPDX-License-Identifier: Apache-2.0
// A jog of one axis (design 3.4): whether it may begin, when it must be halted before a position limit, and whether
// what turns may be one. Pure: the axis's newest samples go in. Promises that a jog is over once another command has
// its mode, and that one which nobody can see still needs its button. Never moves or stops the axis: the guard says so.
#pragma once

#include <optional>

#include "gateway/drive/axis/pending_batches.hpp"
#include "gateway/drive/motion/jog.hpp"
#include "gateway/drive/state/axis_core.hpp"
#include "gateway/image/command.hpp"

namespace axisgate::drive {

class AxisJog {
 public:
  /// `image`: its jog_velocity.
  AxisJog(AxisCore& core, const AxisImage& image) : core_(core), image_(image), jog_(core.jog) {}

  /// jog_forward or jog_reverse: not_supported, bad_value where its velocity is beyond a limit, state_unsuitable where
  /// the position limit is too close. ok: the batch is a run at the jog velocity. `cycle`: of the position's polls.
  [[nodiscard]] Errc begin(WriteBatch& batch, Duration cycle);
  /// New samples. `waits`: its start waits for the wire or is under way.
  void observe(bool waits, Duration cycle);
  /// A write batch has ended. True: it has taken the mode of a jog, and nothing watches what turns: halt it.
  [[nodiscard]] bool finished(const Pending& pending, Errc code);
  /// When a halt must be sent that ends the jog before the position limit, as far as is known now; kNever: never.
  [[nodiscard]] Instant limit_due() const;
  /// Nobody watches the button of what turns, and nothing has begun in its place.
  [[nodiscard]] bool runs_unwatched() const;
  /// What turns may be a jog whose end nobody has asked for yet.
  [[nodiscard]] bool may_be_jog() const;

 private:
  [[nodiscard]] Duration usual_gap(Duration cycle) const;
  /// No value: it is not homed, or nobody knows where it is, so no limit ends the jog.
  [[nodiscard]] std::optional<JogTravel> travel(std::int64_t velocity) const;

  AxisCore& core_;
  const AxisImage& image_;
  Jog& jog_;
  bool waits_ = false;
  bool ended_without_halt_ = false;  ///< and nothing was started since
  Instant started_ = kLongAgo;       ///< until then it stood, or moved otherwise
  Instant position_at_ = kLongAgo;   ///< the newest sample of the position
  Duration position_gap_{};          ///< between two of them, while it jogs
};

}  // namespace axisgate::drive
