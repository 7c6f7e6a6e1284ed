// SPDX-License-Identifier: Apache-2.0
// What falls in a profile with an object that the drive does not have. One rule for all of it: whatever names the
// object goes, and with it what makes no sense without it.
// Promises that nothing in the document names the object afterwards. Never puts anything in its place.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace axisgate::profile {

/// From /objects and everywhere else. A list loses the entry, but steps and products go as a whole (a wait that is
/// optional alone goes by itself); an entry of a section goes as a whole.
void take_out_object(nlohmann::json& document, const std::string& object);

/// From everything but /objects: the drive has it, and it cannot be used so.
void take_out_uses(nlohmann::json& document, const std::string& object);

/// Of the rules of constants ("first"): what would be a product of it is unknown.
void hide_values(nlohmann::json& document, const std::string& object);
/// The same: what stands behind a rule that always holds, for the drive has its object, says nothing. Rules of which
/// none is left that says anything go.
void drop_hidden_rules(nlohmann::json& document);

/// Modes whose set-point quantity is not there any more, and what hangs on them: homing on its mode.
void take_out_modes(nlohmann::json& document);
/// This mode, and what hangs on it.
void take_out_mode(nlohmann::json& document, const std::string& mode);

}  // namespace axisgate::profile
