// SPDX-License-Identifier: Apache-2.0
// What goes over the bus by itself, as far as an EDS has it: TPDOs, heartbeats, guarding, and the reads after a
// timeout. Promises that a TPDO is mapped only where the EDS has its parameters, each entry can be mapped, and its rate
// has a bound. Never adds a supervision that the drive does not have.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "gateway/profile/eds/eds.hpp"

namespace axisgate::profile {

void fit_traffic(const Eds& eds, nlohmann::json& wanted, std::vector<std::string>& notes);

}  // namespace axisgate::profile
