// A sample of axis_command as groups for the command port: what it asks for, in the words that a Modbus client uses.
// Promises the order of checks that register writes have (role, what the drive has, what a register can hold); that a
// stop is carried out whatever nonsense stands beside it; that nothing is wrapped or guessed. Never looks at who owns
// the axis, nor at its limits: the command port does.
#pragma once

#include <boost/container/static_vector.hpp>
#include <variant>

#include "gateway/image/command.hpp"
#include "gateway/upstream/dds/dds_units.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

/// AxisCommand.mask (schemas/axisgate.idl).
enum Has : std::uint32_t {
  kHasMode = 1,
  kHasTargetPosition = 2,
  kHasTargetVelocity = 4,
  kHasTargetTorque = 8,
  kHasMaxTorque = 16,
  kHasProfileVelocity = 32,
  kHasProfileAcceleration = 64,
  kHasProfileDeceleration = 128,
  kHasJogVelocity = 256,
  kHasHomingMethod = 512,
  kHasSetPositionValue = 1024,
};
inline constexpr std::uint32_t kHasAny = 2047;

struct CommandPlan {
  /// To be submitted one after another, each when the one before it is done.
  boost::container::static_vector<Group, 2> groups;
  /// The answer when all of them are done: of what stood beside a stop.
  Errc afterwards = Errc::ok;
};
using PlannedCommand = std::variant<CommandPlan, Errc>;

/// Commands 2, 3, 4 and the end of a jog.
[[nodiscard]] bool stops(const CommandRecord& record);

/// `from`: a group of this writer, with its deadlines, that asks for nothing yet. `axis`: nullptr where there is none
/// of that number. `held`: the sample's jog command is held already: this is no new press.
[[nodiscard]] PlannedCommand plan_command(const CommandRecord& record, const Group& from, const AxisImage* axis,
                                          const DdsUnits& units, bool held);

}  // namespace axisgate::dds
