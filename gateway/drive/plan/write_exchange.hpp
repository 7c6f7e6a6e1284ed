// SPDX-License-Identifier: Apache-2.0
// The exchange that writes an object of the model. Promises the object's own width, that of a whole only the bits of
// the part change that is written, and of a directed object the magnitude alone: its direction is written before. Never
// sends.
#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdlib>

#include "adapters/bus/exchange.hpp"
#include "gateway/drive/plan/action.hpp"

namespace axisgate::drive {

/// `number`: as the drive counts.
[[nodiscard]] inline bus::Exchange write_of(const model::DriveModel& model, model::ObjectId object,
                                            std::int64_t number) {
  const model::ObjectDef& def = model.object(object);
  const model::ObjectDef& whole = model.object(model.whole(object));
  const std::int64_t raw = def.is_directed() ? std::abs(number) : number;
  bus::Exchange out{model.node, bus::Access::write, whole.address, whole.size, def.raw(raw)};
  out.mask = def.mask();
  return out;
}

/// The object that an exchange writes: of a whole that part; kNoObject: it writes none of the model.
[[nodiscard]] inline model::ObjectId written_by(const model::DriveModel& model, const bus::Exchange& exchange) {
  return exchange.access == bus::Access::write ? model.find(exchange.object, exchange.mask) : model::kNoObject;
}

/// One object that an exchange writes, and the number that it gets.
struct Written {
  model::ObjectId object = model::kNoObject;
  std::int64_t number = 0;
};
using AllWritten = boost::container::static_vector<Written, bus::kMaxReplyFields>;
/// What an exchange writes, in the order in which it does: one object, or those that are joined in one request. Of a
/// control frame the field that it is sent for: the others say what they said before.
[[nodiscard]] inline AllWritten all_written(const model::DriveModel& model, const bus::Exchange& exchange) {
  AllWritten out;
  const model::ObjectId first = written_by(model, exchange);
  if (first == model::kNoObject) return out;
  out.push_back({first, model.object(first).number(exchange.raw)});
  if (!model.composed.empty()) return out;
  for (const bus::Neighbour& each : exchange.more)
    if (const model::ObjectId id = model.find(each.object); id != model::kNoObject)
      out.push_back({id, model.object(id).number(each.raw)});
  return out;
}

}  // namespace axisgate::drive
