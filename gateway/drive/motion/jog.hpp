// SPDX-License-Identifier: Apache-2.0
// A jog: the axis runs while a button is held, and not a moment longer (design 3.4 Jog). Pure.
// Promises that it ends by itself once its coil was not written 1 again within its time, and that nothing but a new
// press begins it again. Never moves or stops an axis: the axis asks it, and halts.
#pragma once

#include <cstdint>
#include <optional>

#include "gateway/core/rational.hpp"
#include "gateway/drive/motion/asked.hpp"

namespace axisgate::drive {

class Jog {
 public:
  /// `pressed`: the point in its axis's record, which names this jog.
  void start(Command direction, ClientId client, Instant now, Duration timeout, AxisRecord::Point pressed) {
    if (!active()) speed_.reset();
    direction_ = direction;
    client_ = client;
    until_ = now + timeout;
    timeout_ = timeout;
    carried_ = false;
    pressed_ = pressed;
  }
  /// Its coil was written 1 once more; false: it is no jog of this client's, or has ended.
  [[nodiscard]] bool again(Command direction, ClientId client, Instant now) {
    const bool mine = active() && direction == direction_ && client == client_;
    if (mine) until_ = now + timeout_;
    return mine;
  }
  void end() { direction_ = Command::none; }
  /// Its turn has come: it runs at this target velocity, which is its own and no client's.
  void runs_at(const Wanted& speed) { speed_ = speed; }
  /// A client runs the axis: at what clients have asked for, and at the speed of the button no more.
  void give_way() { speed_.reset(); }
  [[nodiscard]] std::optional<Wanted> speed() const { return active() ? speed_ : std::nullopt; }
  /// The drive is out of sight, or its answer was lost: the axis may run all the same, so its button counts on.
  void carry() { carried_ = true; }
  [[nodiscard]] bool carried() const { return active() && carried_; }
  /// The point at which this jog was begun; 0: none runs.
  [[nodiscard]] AxisRecord::Point pressed() const { return active() ? pressed_ : 0; }

  [[nodiscard]] bool active() const { return direction_ != Command::none; }
  /// jog_forward, jog_reverse, or none.
  [[nodiscard]] Command direction() const { return direction_; }
  [[nodiscard]] ClientId client() const { return client_; }
  [[nodiscard]] Instant until() const { return active() ? until_ : kNever; }
  [[nodiscard]] bool expired(Instant now) const { return active() && now >= until_; }

 private:
  Command direction_ = Command::none;
  ClientId client_ = 0;
  Instant until_ = kNever;
  Duration timeout_{};
  bool carried_ = false;
  AxisRecord::Point pressed_ = 0;
  std::optional<Wanted> speed_{};
};

/// What a jog near a position limit is judged by. All in register units.
struct JogTravel {
  std::int64_t position = 0;
  std::int64_t velocity = 0;  ///< signed, 0.001 rpm: the faster of what is shown and what was asked for
  std::optional<std::int64_t> deceleration{};  ///< 0.1 rpm/s; none: not known, the ramp's way is not reckoned
  Rational units_per_rev{10000};
  Range limits;
};
/// How long from this position on, at this speed, until a halt that acts then comes to rest at the limit in the jog's
/// direction; 0: it is too late. At most an hour.
[[nodiscard]] Duration time_left(const JogTravel& travel, Command direction);

}  // namespace axisgate::drive
