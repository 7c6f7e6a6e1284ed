// SPDX-License-Identifier: Apache-2.0
// What an answer of another width than the profile's is worth. Pure.
// Promises that a wider answer counts only where its bytes above the object say nothing, and never for what a motor
// moves by: a drive that counts its speeds in another width counts them otherwise too.
// Never changes the width that is written: what a drive answers does not tell what it takes.
#pragma once

#include <optional>

#include "adapters/bus/exchange.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::drive {

/// A position, a velocity or an acceleration of a motor, by whichever of its names.
[[nodiscard]] bool moves_by(const model::DriveModel& model, model::ObjectId object);

/// The object's number, where `field` has more bytes than it and those above are zero or, of a signed one, its sign. On
/// CANopen alone: the other protocols' drives have no such servers.
[[nodiscard]] std::optional<std::int64_t> narrowed(const model::DriveModel& model, model::ObjectId object,
                                                   const bus::ReplyField& field);

}  // namespace axisgate::drive
