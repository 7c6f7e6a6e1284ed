// SPDX-License-Identifier: Apache-2.0
// The objects of a profile brought to what an EDS says of them: there or not, type, access, range.
// Promises that what the EDS does not have, or not so that it can be used, is gone with all that needs it.
// Never adds an object.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/profile/eds/eds.hpp"

namespace axisgate::profile {

void fit_objects(const Eds& eds, nlohmann::json& wanted, std::vector<std::string>& notes);

/// Where an object of a profile is on canopen; none: nowhere.
[[nodiscard]] std::optional<ObjectAddress> canopen_address(const nlohmann::json& object);
/// "has no DataType": of an object that a profile cannot stand on.
[[nodiscard]] std::string why_not_usable(const EdsObject& object);
/// Of an object that is not taken.
[[nodiscard]] std::string why_missing(const Eds& eds, ObjectAddress address);
/// "6041h", "6099h:01"
[[nodiscard]] std::string address_text(ObjectAddress address);
/// Which bit of 6502h a key of "modes" is, from 1; none: of no such.
[[nodiscard]] std::optional<int> eds_mode(std::string_view key);
[[nodiscard]] bool eds_reads(const EdsObject& object);
[[nodiscard]] bool eds_writes(const EdsObject& object);

}  // namespace axisgate::profile
