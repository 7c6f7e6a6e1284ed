// SPDX-License-Identifier: Apache-2.0
// Everything that is known of one axis, for those who decide: its model, its drive's objects, its motion rules.
// Promises that facts(), state(), moving() and value() read the newest good samples and nothing else.
// Never sends and never waits.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "gateway/drive/motion/jog.hpp"
#include "gateway/drive/motion/motion.hpp"
#include "gateway/drive/motion/virtual_axis.hpp"
#include "gateway/drive/state/fault_watch.hpp"
#include "gateway/drive/state/nvm_budget.hpp"
#include "gateway/drive/state/object_store.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::drive {

/// Where it is in the drive: "0x6079:00", "register 26752".
[[nodiscard]] std::string place_of(const model::DriveModel& model, model::ObjectId object);

/// The axis's statusword is made from this object, or is it.
[[nodiscard]] bool tells_state(const model::AxisModel& model, model::ObjectId id);

struct AxisCore;

/// The turn of the loop in which a drive is called: all who decide see the same instant and the same link.
struct Turn {
  Instant now = kLongAgo;
  LinkState link = LinkState::unknown;  ///< the drive's
  std::vector<AxisCore*> axes{};        ///< the drive's, as its model has them
};

struct AxisCore {
  const model::DriveModel& drive;
  const model::AxisModel& model;
  ObjectStore& store;
  const Turn& turn;  ///< its drive's
  Motion motion;
  Asked asked{motion.record()};                ///< what clients asked of it
  Jog jog{};                                   ///< the button that is held, if one is
  std::uint32_t alarms = 0;                    ///< AxisAlarm bits found by checks and by what was seen
  std::uint16_t loss_stop_ms = kLossNotKnown;  ///< row 98
  FaultWatch fault{};                          ///< what names a fault, and what must be read for it
  CauseObjects causes = cause_objects(model);  ///< what names the cause of one
  bool mode_chosen = false;                    ///< a client has chosen the mode since bring-up
  bool homed = false;                          ///< latched (design 3.1, discrete input 6)
  bool counter_wrapped = false;                ///< its position has jumped, and no homing was begun since
  std::int32_t set_position_value = 0;         ///< row 78, the gateway's own
  VirtualAxis machine{};                       ///< of a virtual axis alone
  /// Where the motion started last was sent, in register units, and the store's invalidations() then: the drive may
  /// hold another target since.
  struct SentTo {
    std::int64_t position = 0;
    std::uint64_t invalidations = 0;
  };
  std::optional<SentTo> sent_to{};
  NvmBudget nvm{};

  /// Axes that are enabled and stopped as one with it.
  [[nodiscard]] std::vector<AxisCore*> shared() const {
    std::vector<AxisCore*> out;
    for (const AxisSlot slot : model.shares) out.push_back(turn.axes.at(slot));
    return out;
  }
  /// `holds` is true of this axis or of one that is shared with it.
  [[nodiscard]] bool any_shared(const auto& holds) const {
    return holds(*this) ||
           std::ranges::any_of(model.shares, [&](AxisSlot slot) { return holds(std::as_const(*turn.axes.at(slot))); });
  }
  /// One that is shared with it runs or turns: what takes the torque or changes the mode of all has to wait.
  [[nodiscard]] bool another_runs() const {
    return std::ranges::any_of(model.shares, [this](AxisSlot slot) {
      const AxisCore& other = *turn.axes.at(slot);
      return other.motion.running() != MotionKind::none || other.motion.runs_raw() || other.moving();
    });
  }
  /// link_state online or suspect.
  [[nodiscard]] bool reachable() const { return turn.link == LinkState::online || turn.link == LinkState::suspect; }
  /// All of it, worked out again: of one thing alone ask state() or moving().
  [[nodiscard]] AxisFacts facts() const;
  [[nodiscard]] ShownState state() const;
  [[nodiscard]] bool moving() const;
  /// What state() tells was read after the last sending.
  [[nodiscard]] bool state_is_of_now() const { return store.shows_now(model.statusword); }
  [[nodiscard]] bool is_virtual() const { return model.virtual_axis.has_value(); }
  /// Virtual axes: makes the statusword from the newest samples.
  void refresh_virtual();
  /// Virtual axes: the mode in force is the one that the drive begins with.
  void begin_mode();
  /// Carries out the write of an `emulated` object.
  void make(model::ObjectId id, std::int64_t number);
  /// The drive has acknowledged a start. `relative`: the target is a distance. `ends_at`: see Action.
  void started(MotionKind kind, bool relative, std::optional<std::int64_t> ends_at);
  /// What must be read to know this object: itself, or the whole it is a part of; of an `emulated` statusword and of a
  /// directed object the oldest of its samples.
  [[nodiscard]] model::ObjectId to_read(model::ObjectId id) const;
  /// New samples, or time has passed: whether there is a fault, and what names it.
  void watch_fault();
  /// A sample of this object names the cause of the fault that there is now, not of one before.
  [[nodiscard]] bool names_cause(model::ObjectId id) const;
  /// The newest number of the quantity in register units; none where there is no good one.
  [[nodiscard]] std::optional<std::int64_t> value(Quantity quantity) const;
  /// The object that a quantity is read from or written to, where the drive has it; else kNoObject.
  [[nodiscard]] model::ObjectId object_of(Quantity quantity) const;
  /// What tells whether it moves, likewise.
  [[nodiscard]] model::ObjectId motion_object() const;
  /// The unified number of the mode in force, 0 where it is unknown or the drive's number stands for none.
  [[nodiscard]] int mode_in_force() const;
  /// In this mode a target velocity or torque acts at once.
  [[nodiscard]] bool is_continuous(int mode) const;
  /// The controlword in effect: sent last by anyone, or read.
  [[nodiscard]] std::uint16_t controlword() const;
  [[nodiscard]] bool alarm(AxisAlarm a) const { return (alarms & bit(a)) != 0; }
  [[nodiscard]] const model::ObjectDef& object(model::ObjectId id) const { return drive.object(id); }
  /// A write of this target would by itself move the axis on this drive, now.
  [[nodiscard]] bool held_back(Quantity target) const;
  /// The position a move uses: what a client asked for last, else what the drive holds.
  [[nodiscard]] std::optional<Wanted> target_position() const;
  /// Where a relative move begins that is carried out as an absolute one: at the target of the move that was completed
  /// last, as long as the drive holds it, however short of it the motor stands; else at a position sampled since it
  /// stands. None: there is no such sample yet.
  [[nodiscard]] std::optional<std::int64_t> setpoint_position() const;
  /// The motor is held or moved by the drive, as far as that shows: enabled, in a quick stop, or never without torque.
  [[nodiscard]] bool shows_torque() const;
  /// The bus cannot take this virtual axis's torque away, and it is not enabled.
  [[nodiscard]] bool cannot_deenergise() const;
  /// Velocity and torque: what a client has asked for since the last stop, fault, disable or loss. The velocity of a
  /// jog is the jog's. None: a start is refused, and whatever else enables goes by 0.
  [[nodiscard]] std::optional<Wanted> running_target(Quantity quantity) const;
  /// What a client has asked for since bring-up, else the configured one.
  [[nodiscard]] std::optional<std::int64_t> homing_method() const;

 private:
  [[nodiscard]] bool follows(const AxisFacts& facts) const;
  [[nodiscard]] std::optional<VirtualAxis::Seen> seen() const;
};

/// The fault words of an axis and what they mean: the first active row of the profile's alarm table.
[[nodiscard]] const model::AlarmRow* active_alarm(const AxisCore& core);
/// What the drive names now: the code of that row, or else what it holds as its error code itself; 0: nothing.
[[nodiscard]] std::uint16_t named_code(const AxisCore& core);
/// The cause of the fault that there is, what is to be done, and the words it was found in (fault_text.cpp).
[[nodiscard]] std::string fault_text(const AxisCore& core);

}  // namespace axisgate::drive
