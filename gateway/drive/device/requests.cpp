// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/requests.hpp"

#include "gateway/drive/device/poll_plan.hpp"
#include "gateway/drive/device/resync.hpp"

namespace axisgate::drive {

bus::Exchange read_of(const model::DriveModel& model, model::ObjectId object) {
  const model::ObjectDef& def = model.object(model.whole(object));
  bus::Exchange exchange{model.node, bus::Access::read, def.address, def.any_width ? std::uint8_t{0} : def.size, 0};
  exchange.unsaid = def.any_width ? def.size : std::uint8_t{0};
  return exchange;
}

bus::Exchange read_of(const model::DriveModel& model, const model::ResyncRead& read) {
  bus::Exchange exchange = read_of(model, read.object);
  if (read.registers == 0 || read.registers == registers_of(exchange)) return exchange;
  exchange.size = 2;
  for (std::uint16_t i = 1; i < read.registers; ++i)
    exchange.more.push_back({{static_cast<std::uint16_t>(exchange.object.index + i), exchange.object.sub}, 2});
  return exchange;
}

bus::Exchange plain_read(const model::DriveModel& model) {
  return read_of(model, model.axes.front().state_sources.front());
}

// Without a checksum or an address, an answer that is all zeros is the query's own echo as well (Keya's faults of two
// enabled motors): a drive that is looked for is asked what is never 0.
bus::Exchange probe_read(const model::DriveModel& model) {
  const bool packed = !model.composed.empty() && !model.resync.candidates.empty();
  return packed ? read_of(model, model.resync.candidates.front()) : plain_read(model);
}

bus::Exchange other_probe_read(const model::DriveModel& model) {
  const bus::Exchange first = probe_read(model);
  const auto other = [&](model::ObjectId id) {
    return model.object(id).readable && model.object(id).address != first.object;
  };
  for (const model::ResyncRead& read : model.resync.candidates)
    if (other(read.object)) return read_of(model, read.object);
  for (const PollItem& item : poll_items(model))
    if (other(item.object)) return read_of(model, item.object);
  return first;
}

}  // namespace axisgate::drive
