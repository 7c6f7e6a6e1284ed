// SPDX-License-Identifier: Apache-2.0
// A sample of axis_command as write batches for the command port: what it asks for, in the words that a Modbus client
// uses. Promises the order of checks that register writes have (role, what the drive has, what a register can hold);
// that a stop is carried out whatever nonsense stands beside it; that nothing is wrapped or guessed. Never looks at who
// owns the axis, nor at its limits: the command port does.
#pragma once

#include <boost/container/static_vector.hpp>
#include <variant>

#include "gateway/image/command.hpp"
#include "gateway/upstream/dds/dds_units.hpp"
#include "gateway/upstream/dds_link/command_mask.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

struct CommandPlan {
  /// To be submitted one after another, each when the one before it is done.
  boost::container::static_vector<WriteBatch, 2> batches;
  /// The answer when all of them are done: of what stood beside a stop.
  Errc afterwards = Errc::ok;
};
using PlannedCommand = std::variant<CommandPlan, Errc>;

/// Commands 2, 3, 4 and the end of a jog.
[[nodiscard]] bool stops(const CommandRecord& record);
/// What is never refused for its age or for the gateway's name: stops, and the release.
[[nodiscard]] bool lets_go(const CommandRecord& record);
/// May put torque on or set a motor going that stands: the press of a jog's button, but not the button held.
[[nodiscard]] bool starts(const CommandRecord& record, bool held);

/// A velocity run is on, as coil 7 shows it.
[[nodiscard]] bool velocity_runs(const AxisImage& axis);
/// What is written beside the command may set a motor going: a mode, or a target that is none of the motion that is on.
[[nodiscard]] bool begins_beside(const CommandRecord& record, const AxisImage& axis);

/// `from`: a write batch of this writer, with its deadlines, that asks for nothing yet. `axis`: nullptr where there is
/// none of that number. `held`: the sample's jog command is held already: this is no new press.
[[nodiscard]] PlannedCommand plan_command(const CommandRecord& record, const WriteBatch& from, const AxisImage* axis,
                                          const DdsUnits& units, bool held);

}  // namespace axisgate::dds
