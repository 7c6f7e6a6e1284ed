// Everything that is known of one axis, for those who decide: its model, its drive's objects, its motion rules.
// Promises that facts() and value() read the newest good samples and nothing else.
// Never sends and never waits.
#pragma once

#include "gateway/drive/model.hpp"
#include "gateway/drive/motion.hpp"
#include "gateway/drive/object_store.hpp"

namespace axisgate::drive {

struct AxisCore {
  const DriveModel& drive;
  const AxisModel& model;
  ObjectStore& store;
  Motion motion{};
  std::uint32_t alarms = 0;               ///< AxisAlarm bits found by checks and by what was seen
  bool reachable = false;                 ///< link_state online or suspect
  bool homing_method_given = false;       ///< written or configured since bring-up
  bool mode_chosen = false;               ///< a client has chosen the mode since bring-up
  bool homed = false;                     ///< latched (design 3.1, discrete input 6)
  std::int32_t set_position_value = 0;    ///< row 78, the gateway's own

  [[nodiscard]] AxisFacts facts() const;
  /// The newest number of the quantity in register units; none where there is no good one.
  [[nodiscard]] std::optional<std::int64_t> value(Quantity quantity) const;
  /// The unified number of the mode in force, 0 where it is unknown or the drive's number stands for none.
  [[nodiscard]] int mode_in_force() const;
  /// The controlword in effect: sent last by anyone, or read.
  [[nodiscard]] std::uint16_t controlword() const;
  [[nodiscard]] bool alarm(AxisAlarm a) const { return (alarms & bit(a)) != 0; }
  [[nodiscard]] const ObjectDef& object(ObjectId id) const { return drive.object(id); }
  /// A write of this target would by itself move the axis on this drive, now.
  [[nodiscard]] bool held_back(Quantity target) const;
  /// What a start uses: what a client asked for last, else what the drive holds.
  [[nodiscard]] std::optional<std::int64_t> target(Quantity quantity) const;
};

/// The faults words of an axis and what they mean: the first active row of the profile's alarm table.
[[nodiscard]] const AlarmRow* active_alarm(const AxisCore& core);

}  // namespace axisgate::drive
