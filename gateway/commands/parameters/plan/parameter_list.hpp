// SPDX-License-Identifier: Apache-2.0
// The objects of a drive that may hold settings: all that the profile or an EDS says can be written, and of each
// whether it may be put into an exchanged drive. Pure.
// Promises that nothing which could start, move or enable a motor, or lose the drive on its line, is called writable;
// in doubt it is not. Never says what a drive holds.
#pragma once

#include <string>
#include <vector>

#include "gateway/model/model.hpp"
#include "gateway/profile/eds/eds.hpp"

namespace axisgate::commands {

/// More are refused: reading them would take minutes.
inline constexpr std::size_t kMaxParameters = 10000;

struct Parameter {
  model::ObjectDef object;  ///< the profile's, or as the EDS has it
  std::string never{};      ///< why it is not written; empty: it may be
  /// Its number is another one from hour to hour, or is set at each start: a difference is no matter.
  bool changes_itself = false;
};

/// Of this axis and of its whole drive, by address, each place once. `eds`: null where there is none; what the profile
/// has is the profile's.
[[nodiscard]] std::vector<Parameter> parameters_of(const model::DriveModel& model, AxisSlot slot,
                                                   const profile::Eds* eds);
/// An EDS says something of this protocol: its objects have an index and a sub-index.
[[nodiscard]] bool takes_eds(const model::DriveModel& model);

}  // namespace axisgate::commands
