// SPDX-License-Identifier: Apache-2.0
// What is reported of a constant that the drive does not tell (profile: a constant's "first").
// Promises its name, the object that is the cause, and what to write into the configuration. Never judges what may
// move.
#pragma once

#include <string>

#include "gateway/drive/state/object_store.hpp"

namespace axisgate::drive {

/// Empty: it is known.
[[nodiscard]] std::string unknown_text(const model::DriveModel& model, const model::DriveConstant& constant,
                                       const model::Evaluated& found, const ObjectStore& store);

}  // namespace axisgate::drive
