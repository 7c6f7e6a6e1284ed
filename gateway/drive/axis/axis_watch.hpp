// SPDX-License-Identifier: Apache-2.0
// The watch of one axis (configuration key "watch"): what its drive shows, held against what was asked of it. Promises
// an alarm and an event for what nothing explains, and says what stop is due then. Never stops anything itself: the
// axis does, as all stops of the gateway's own.
#pragma once

#include <string>
#include <utility>

#include "gateway/drive/axis/axis_host.hpp"
#include "gateway/drive/guard/guard.hpp"
#include "gateway/drive/state/axis_core.hpp"
#include "gateway/drive/watch/motion_watch.hpp"
#include "gateway/drive/watch/target_watch.hpp"
#include "gateway/drive/watch/units_watch.hpp"
#include "gateway/image/command.hpp"

namespace axisgate::drive {

class AxisWatch {
 public:
  AxisWatch(AxisCore& core, AxisHost& host);

  /// While a write batch of this kind waits or is carried out it explains that the axis moves.
  [[nodiscard]] static bool explains(const WriteBatch& batch);
  void accepted(const WriteBatch& batch);
  /// `begun`: something of it was sent.
  void finished(const WriteBatch& batch, Errc code, bool begun);
  void stopped(const WriteBatch& batch, StopKind kind);
  /// The position counts from elsewhere, or the drive is another.
  void renumbered();
  /// New samples. `asked`: something that explains a motion waits or is carried out.
  void observe(bool asked);
  /// What is due against what was seen: once.
  [[nodiscard]] std::optional<Command> take_stop() { return std::exchange(due_, std::nullopt); }

  /// The stop that was accepted at this point.
  struct Stop {
    StopKind kind = StopKind::halt;
    AxisRecord::Point at = 0;
    bool of_client = false;  ///< it stands in a client's result
  };
  /// The drive has shown it: from now on it is held against what the motor does, also where nothing else is watched.
  void shown(Stop stop) { shown_ = Shown{stop, Slowing(core_.turn.now)}; }
  /// The motor turns on after it: once.
  [[nodiscard]] std::optional<Stop> take_unheeded();

 private:
  /// So long after its answer a start whose outcome is unknown may come.
  static constexpr Duration kLateStart = std::chrono::seconds(5);

  [[nodiscard]] bool explained(const AxisFacts& facts, bool asked) const;
  /// The stop that was shown is the newest, and the motor, with torque, was not seen to stand since.
  [[nodiscard]] bool stop_holds() const;
  void watch_motion(const AxisFacts& facts, bool asked);
  void watch_torque();
  void watch_units(const AxisFacts& facts, bool asked);
  void watch_target(const AxisFacts& facts);
  [[nodiscard]] std::optional<TargetWatch::Seen> standing_move(const AxisFacts& facts) const;
  /// What tells that a move has reached its target, for whoever has to mend it.
  [[nodiscard]] std::string reached_by() const;
  /// A number that no row can show.
  void watch_signs();
  void tell_unexpected(const std::string& what);
  [[nodiscard]] std::optional<Command> reaction();
  void warn(AxisAlarm alarm, std::string text);
  [[nodiscard]] std::optional<TimedValue> value(Quantity quantity, double units) const;
  /// In each of these a stop must make the motor slower.
  [[nodiscard]] Duration window() const;
  /// How often it is read, or confirmed.
  [[nodiscard]] Duration period(Quantity quantity) const;

  AxisCore& core_;
  AxisHost& host_;
  MotionWatch motion_;
  UnitsWatch units_;
  TargetWatch target_;
  std::uint32_t signs_reported_ = 0;  ///< bits of quantities
  AxisRecord::Point move_ = 0;        ///< of the move that was under way last
  AxisRecord::Point asked_ = 0;       ///< of what was accepted last that explains some motion
  Instant unknown_until_ = kLongAgo;  ///< until then a start may come of which nobody knows
  struct Shown {
    Stop stop;
    Slowing slowing;
  };
  std::optional<Shown> shown_{};
  std::optional<Stop> unheeded_{};  ///< one of them that the motor was seen to move after as nothing explains
  std::optional<StopKind> stop_{};  ///< the newest of what was accepted is this stop
  int reactions_ = 0;               ///< so often something was done about what goes against it
  std::optional<Command> due_{};
  Instant reacted_at_ = kLongAgo;  ///< a stop without a client that is accepted at this instant is a reaction
  struct {
    bool unwanted = false;     ///< a disable was accepted last
    bool seen_off = false;     ///< and was shown
    Instant back_at = kNever;  ///< it has torque since then all the same
  } torque_;
  std::string since_ = "it was found standing";  ///< what it should stand since
};

}  // namespace axisgate::drive
