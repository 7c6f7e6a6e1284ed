// SPDX-License-Identifier: Apache-2.0
// The exchange that writes an object of the model. Promises the object's own width, and that of a whole only the bits
// of the part change that is written. Never sends.
#pragma once

#include "adapters/bus/exchange.hpp"
#include "gateway/drive/plan/action.hpp"

namespace axisgate::drive {

/// `number`: as the drive counts.
[[nodiscard]] inline bus::Exchange write_of(const model::DriveModel& model, model::ObjectId object,
                                            std::int64_t number) {
  const model::ObjectDef& def = model.object(object);
  const model::ObjectDef& whole = model.object(model.whole(object));
  bus::Exchange out{model.node, bus::Access::write, whole.address, whole.size, wire_bits(number, def.size)};
  out.mask = def.mask();
  return out;
}

/// The object that an exchange writes: of a whole that part; kNoObject: it writes none of the model.
[[nodiscard]] inline model::ObjectId written_by(const model::DriveModel& model, const bus::Exchange& exchange) {
  return exchange.access == bus::Access::write ? model.find(exchange.object, exchange.mask) : model::kNoObject;
}

}  // namespace axisgate::drive
