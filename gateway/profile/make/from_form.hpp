// SPDX-License-Identifier: Apache-2.0
// A profile made from a drive's table of registers (form.hpp): a virtual one on Modbus RTU, whose commands are a form
// that a person has to fill in.
// Promises a file that `axisgate profile check` takes and that enables nothing before its questions are answered; a
// quick stop that waits until the motor stands. Never guesses which number enables, stops or starts a motor.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "gateway/profile/make/form.hpp"
#include "gateway/profile/make/from_eds.hpp"

namespace axisgate::profile {

/// Rows of these names have a meaning: "control" is what is written to start and stop, "status" tells what the motor
/// does, "fault" is 0 without a fault; a quantity's own name (register map) makes a row that quantity.
[[nodiscard]] MadeProfile profile_from_form(const Form& form, const FromEds& what);

/// Commands and state of `sibling` (what.base), a whole profile; where it has an object of a row's name, the row says
/// where it is. What the table does not have falls.
[[nodiscard]] MadeProfile profile_like(const Form& form, const nlohmann::json& sibling, const FromEds& what);

/// The same objects as an EDS would tell them: of a table of CANopen objects.
[[nodiscard]] Eds eds_of(const Form& form);

}  // namespace axisgate::profile
