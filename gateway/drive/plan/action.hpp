// SPDX-License-Identifier: Apache-2.0
// An action: one thing a write batch does on the wire or to the motion rules, in the order in which a plan lists them.
// Promises that a plan is data: it can be printed, compared in a test, and carried out one exchange at a time.
// Never more than kMaxActions in a plan.
#pragma once

#include <vector>

#include "gateway/drive/state/axis_core.hpp"
#include "gateway/drive/state/effect_watch.hpp"

namespace axisgate::drive {

/// Turning points that a plan reaches between its exchanges.
enum class Mark : std::uint8_t {
  enabled,         ///< the stop latch is cleared
  found_enabled,   ///< it was so already: nothing was sent, and the stop latch is cleared
  start_discrete,  ///< the drive has acknowledged the start of such a motion
  start_velocity,
  start_torque,
  start_homing,
  controlword_passed,  ///< a raw controlword was acknowledged: one of the two steps out of the latch, perhaps
  quick_stopped,       ///< a quick stop took the place of the stop that was asked for: it latches
  halted,              ///< bit 8 of a raw controlword: the motion is cancelled, as by command 4
  run_raw,             ///< raw modes 3, 4, 9, 10 run: set-points act at once
  mode_changed,
  values_invalidated,  ///< nothing is taken as cached any more, but Action::object
  not_homed,
  borrow_homing,  ///< set_position is about to change method and offset
  return_homing,  ///< and has put them back
  look_again,     ///< the rest of this part is planned again with what was just read
};

struct Action {
  enum class Kind : std::uint8_t { write, read, wait, mark };
  Kind kind = Kind::write;
  model::ObjectId object = model::kNoObject;  ///< write, read; see Mark::values_invalidated
  std::int64_t number = 0;  ///< write: as the drive counts; Mark::start_discrete: 1, the target is a distance;
                            ///< Mark::run_raw: 1, it was not enabled before
  model::ObjectId copy_of = model::kNoObject;  ///< write: the newest number of this object instead
  model::Condition until;                      ///< wait: must hold on a sample asked for after the last acknowledgement
  bool joined = false;                         ///< write: in one request with the one after it, which is a write
  Effect effect = Effect::none;                ///< wait: for this instead of a condition
  Duration limit{};                            ///< wait
  bool optional = false;  ///< no failure: a wait that runs out, a write of what the drive says it does not have
  Errc otherwise = Errc::not_reached;
  Mark mark{};
  std::optional<std::int64_t> ends_at{};  ///< Mark::start_discrete: in register units; none: the drive reckons it

  [[nodiscard]] static Action write(model::ObjectId object, std::int64_t number) {
    Action a;
    a.object = object;
    a.number = number;
    return a;
  }
  [[nodiscard]] static Action copy(model::ObjectId from, model::ObjectId to) {
    Action a;
    a.object = to;
    a.copy_of = from;
    return a;
  }
  [[nodiscard]] static Action read(model::ObjectId object) {
    Action a;
    a.kind = Kind::read;
    a.object = object;
    return a;
  }
  [[nodiscard]] static Action wait(model::Condition until, Duration limit, bool optional = false,
                                   Errc otherwise = Errc::not_reached) {
    Action a;
    a.kind = Kind::wait;
    a.until = std::move(until);
    a.limit = limit;
    a.optional = optional;
    a.otherwise = otherwise;
    return a;
  }
  [[nodiscard]] static Action wait(Effect effect, Duration limit) {
    Action a;
    a.kind = Kind::wait;
    a.effect = effect;
    a.limit = limit;
    return a;
  }
  [[nodiscard]] static Action at(Mark mark, model::ObjectId object = model::kNoObject) {
    Action a;
    a.kind = Kind::mark;
    a.mark = mark;
    a.object = object;
    return a;
  }
  [[nodiscard]] static Action run_raw(bool by_enable) {
    Action a = at(Mark::run_raw);
    a.number = by_enable ? 1 : 0;
    return a;
  }
};

inline constexpr std::size_t kMaxActions = 48;

/// The low `size` bytes of a number, as they go on the wire.
[[nodiscard]] constexpr std::uint32_t wire_bits(std::int64_t number, std::uint8_t size) {
  const std::uint32_t mask = size >= 4 ? ~0U : (1U << (8U * size)) - 1U;
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(number)) & mask;
}

/// What a part of a write batch comes to: refused, with the reason, or a list of actions (empty: nothing needs to be
/// sent).
struct Plan {
  Outcome refusal;
  std::vector<Action> actions;
  [[nodiscard]] bool refused() const { return refusal.code != Errc::ok; }

  [[nodiscard]] static Plan refuse(Errc code) { return {axisgate::refusal(code), {}}; }
  void add(Action action) {
    assert(actions.size() < kMaxActions);
    actions.push_back(std::move(action));
  }
};

}  // namespace axisgate::drive
