// SPDX-License-Identifier: Apache-2.0
// All types of EdsDrive.
#include <algorithm>

#include "tests/simulated/eds_types.hpp"

namespace axisgate::simulated {
namespace {

constexpr const EdsDriveType* types[] = {
    &elmo_gold_type, &elmo_simpliq_type, &epos4_type,    &faulhaber_type,
    &nanotec_type,   &technosoft_type,   &trinamic_type, &zeroerr_type,
};

}  // namespace

std::span<const EdsDriveType* const> eds_drive_types() { return types; }

const EdsDriveType* eds_drive_type(std::string_view name) {
  const auto* found = std::ranges::find(types, name, [](const EdsDriveType* it) { return it->name; });
  return found == std::end(types) ? nullptr : *found;
}

}  // namespace axisgate::simulated
