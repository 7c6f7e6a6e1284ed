// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/write/write_plan.hpp"

#include "gateway/image/shown.hpp"

namespace axisgate::modbus_tcp {
namespace {

bool stops_through(const RegisterRow& row, const Request& request) {
  const bool is_controlword = row.source == Source::quantity && row.quantity == Quantity::controlword;
  const bool masks = request.function == Function::mask_write_register;
  if (masks && row.source == Source::command && request.and_mask == 0)
    return request.or_mask <= kLastCommand && is_stop(Command{static_cast<Byte>(request.or_mask)});
  if (masks) {
    // Both masks force at least one of the bits to 0.
    return is_controlword && (~request.and_mask & ~request.or_mask & kStoppingBits) != 0;
  }
  const std::uint16_t value = request.written_register(0);
  if (row.source == Source::command) return value <= kLastCommand && is_stop(Command{static_cast<Byte>(value)});
  return is_controlword && is_stop_controlword(value);
}

LastWords last_words(const Onlooker& onlooker, AxisNumber axis) {
  const auto found = onlooker.words->axes.find(axis);
  return found == onlooker.words->axes.end() ? LastWords{} : found->second;
}

}  // namespace

WriteMemory memory_of(const Onlooker& onlooker, AxisNumber axis) {
  const Client& client = onlooker.client;
  WriteMemory memory;
  memory.connection = onlooker.words;
  memory.words = last_words(onlooker, axis);
  if (const ClientAxis* const own = client.find(axis)) {
    memory.edges = own->edges;
    memory.rows = own->rows;
  }
  if (const auto ids = client.host->ids.find(axis); ids != client.host->ids.end()) memory.ids = ids->second;
  return memory;
}

void restore(const WriteMemory& memory, Client& client, AxisNumber axis) {
  ClientAxis& own = client.at(axis);
  own.edges = memory.edges;
  own.rows = memory.rows;
  memory.connection->axes[axis] = memory.words;
  if (memory.ids)
    client.host->ids[axis] = *memory.ids;
  else
    client.host->ids.erase(axis);
}

Writing writing_to(const AxisImage& axis, const Onlooker& onlooker, WriteForm form) {
  constexpr std::uint16_t kEnabled = 1U << 0, kRunsVelocity = 1U << 7;
  Writing writing;
  writing.form = form;
  writing.now = onlooker.now;
  writing.request = onlooker.client.writes;
  writing.rearm = onlooker.settings.rearm;
  writing.client = onlooker.client.id;
  writing.own = last_words(onlooker, axis.number);
  writing.connected_at = onlooker.words->connected_at;
  writing.record = &axis.record;
  writing.enabled = (shown_level_coils(axis) & kEnabled) != 0 && !axis.has(AxisInput::stop_latched);
  writing.runs_velocity = (shown_level_coils(axis) & kRunsVelocity) != 0;
  writing.owns = axis.lease.owned_by(onlooker.client.id);
  writing.needs_zero = axis.has(AxisInput::stop_latched) || axis.has(AxisInput::fault);
  return writing;
}

Planned plan_write(const Request& request, const UnitView& view, const Onlooker& onlooker, Client& client) {
  ++client.writes;
  Planned planned = request.writes_coils() ? plan_coil_write(request, view, onlooker, client)
                                           : plan_register_write(request, view, onlooker, client);
  if (auto* const plan = std::get_if<WritePlan>(&planned)) plan->request = client.writes;
  if (const auto* const refused = std::get_if<Refused>(&planned))
    for (const AxisStop& stop : refused->stops) restore(stop.after, client, stop.axis);
  return planned;
}

bool asks_for_a_stop(const Request& request, const UnitView& view, const Onlooker& onlooker) {
  if (!request.writes()) return false;
  if (request.write_count != 1 || request.function == Function::read_write_registers) {
    return !(request.writes_coils() ? stops_in_coils(request, view, onlooker)
                                    : stops_in_registers(request, view, onlooker))
                .empty();
  }
  const ProcessImage& image = onlooker.image;
  if (request.writes_coils()) {
    const auto place = view.place_bit(request.write_address, image);
    if (!place || place->offset >= kCoils) return false;
    const CoilRow& coil = coil_rows()[place->offset];
    return asks_to_stop(request.written_coil(0) ? coil.on : coil.off);
  }
  const auto place = view.place_register(request.write_address, image);
  if (!place || place->block != Block::axis) return false;
  const RegisterRow* row = register_table(Block::axis).covering(place->offset);
  return row != nullptr && stops_through(*row, request);
}

AxisNumber axis_of_write(const Request& request, const UnitView& view, const ProcessImage& image) {
  const auto place = view.place_register(request.write_address, image);
  return place && place->block == Block::axis ? place->number : AxisNumber{0};
}

}  // namespace axisgate::modbus_tcp
