// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/write/row_writes.hpp"

#include "gateway/image/float_rows.hpp"
#include "gateway/upstream/modbus_tcp/read/reads.hpp"

namespace axisgate::modbus_tcp {
namespace {

constexpr std::uint16_t kFirstWritable = 40;  // of an axis block; unlisted offsets from here to kLastWritable
constexpr std::uint16_t kLastWritable = 89;   // are ignored in a longer write

/// FC 22: the masks on what the register shows at this moment (V1.1b3 6.16).
std::uint32_t masked(const Request& request, std::uint16_t shown) {
  return static_cast<std::uint32_t>((shown & request.and_mask) | (request.or_mask & ~request.and_mask)) & 0xFFFFU;
}

std::uint32_t written_bits(const Request& request, std::size_t i, int registers, bool low_word_first) {
  const std::uint32_t first = request.written_register(i);
  if (registers == 1) return first;
  const std::uint32_t second = request.written_register(i + 1);
  return low_word_first ? (second << 16) | first : (first << 16) | second;
}

/// In a block, 0 in these rows means "leave as it is" (mode: CiA 402-2, 6060h, "no mode change"); alone it is refused.
bool leaves_as_it_is(const RegisterRow& row, std::int64_t value) { return value == 0 && row.zero_leaves; }

/// A number other than 0 that is 0 in register units would be taken for the 0 that leaves a row as it is.
std::int64_t number_of_float(const RegisterRow& row, std::uint32_t bits, const AxisImage& axis) {
  constexpr std::uint32_t kSign = 1U << 31;
  const std::int64_t value = float_value(row, bits, axis.units_per_rev);
  return leaves_as_it_is(row, value) && (bits & ~kSign) != 0 ? kNoNumber : value;
}

RowWrite row_write(const RegisterRow& row, std::uint32_t bits, const AxisImage* axis,
                   const ListenerSettings& settings) {
  if (!settings.float_numbers || axis == nullptr || !is_float_row(row)) return {&row, axis, number_of(bits, row.type)};
  return {&row, axis, number_of_float(row, bits, *axis), bits};
}

/// A block never reaches into the next one: the last offsets of a block take no write, so `outside` is set before.
RowWrites gather(const Request& request, const UnitView& view, const Onlooker& onlooker) {
  RowWrites found;
  const std::size_t count = request.write_count;
  const auto reject = [&found](std::uint16_t at) {
    if (!found.outside) found.outside_at = at;
    found.outside = true;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const auto place = view.place_register(static_cast<std::uint32_t>(request.write_address + i), onlooker.image);
    const RegisterRow* row = place ? register_table(place->block).covering(place->offset) : nullptr;
    if (place && place->block == Block::axis) found.axis = onlooker.image.find(place->number);
    if (row == nullptr) {
      const bool ignored = count > 1 && place && place->block == Block::axis && place->offset >= kFirstWritable &&
                           place->offset <= kLastWritable;
      if (!ignored) reject(place ? place->offset : std::uint16_t{0});
      continue;
    }
    const auto registers = static_cast<std::size_t>(row->registers());
    if (!row->writable || place->offset != row->offset || i + registers > count) {
      reject(row->offset);
      continue;
    }
    const std::uint32_t bits = request.function == Function::mask_write_register
                                   ? masked(request, read_one(request.write_address, view, onlooker).value_or(0))
                                   : written_bits(request, i, row->registers(), onlooker.settings.low_word_first);
    found.rows.push_back(row_write(*row, bits, found.axis, onlooker.settings));
    i += registers - 1;
  }
  return found;
}

/// A row that this drive does not have, written in a block with what it reads as or with 0: one function block serves
/// all axes, and a scanner may write back the block that it has read.
bool is_ignored(const RowWrite& write, const AxisImage& axis, const Onlooker& onlooker) {
  const RegisterRow& row = *write.row;
  if (leaves_as_it_is(row, write.value)) return true;
  return !takes(axis, row) && (write.value == 0 || number_of(axis_value(row, axis, onlooker), row.type) == write.value);
}

/// "In a block write a row whose value the drive already holds is skipped without asking the role."
bool holds(const RegisterRow& row, std::int64_t value, const AxisImage& axis, const Onlooker& onlooker) {
  if (row.source == Source::set_position_value) return onlooker.commands.set_position_value(axis.number) == value;
  if (row.source == Source::jog_velocity) return axis.jog_velocity == value;
  return row.source == Source::quantity && row.quantity != Quantity::controlword &&
         onlooker.commands.holds(axis.number, row.quantity, value);
}

bool is_cached(const RowWrite& write, const AxisImage& axis, const Onlooker& onlooker) {
  const RegisterRow& row = *write.row;
  if (holds(row, write.value, axis, onlooker)) return true;
  if (!write.as_float) return false;
  // What a float is too coarse for: it reads as what was written.
  const std::int64_t shown = number_of(axis_value(row, axis, onlooker), row.type);
  return float_bits(row, shown, axis.units_per_rev) == *write.as_float && holds(row, shown, axis, onlooker);
}

/// "What asks for nothing is answered normally": so is what this client has not changed since it was allowed to.
bool is_held(const RowWrite& write, const AxisImage& axis, const Onlooker& onlooker) {
  const ClientAxis* const own = onlooker.client.find(axis.number);
  return own != nullptr && is_remembered(*write.row) && own->rows.holds(write.row->offset, write.value);
}

bool is_all_zero(const Request& request, const UnitView& view, const Onlooker& onlooker) {
  constexpr std::uint16_t kFirst = 40, kLast = 54;
  const auto place = view.place_register(request.write_address, onlooker.image);
  if (!place || place->offset > kFirst || place->offset + request.write_count <= kLast) return false;
  for (std::size_t i = 0; i < request.write_count; ++i)
    if (request.written_register(i) != 0) return false;
  return true;
}

Role needed_role(const RowWrite& write) {
  if (write.row->source == Source::command && write.value == static_cast<int>(Command::save_parameters)) {
    return Role::engineer;
  }
  if (write.row->source == Source::object_request && write.value == 2) return Role::engineer;
  return write.row->may_write;
}

WrongRow check_role(const RowWrites& found, Role role) {
  const bool viewer = role < Role::operator_;
  for (const RowWrite& each : found.rows) {
    if (viewer && found.outside && found.outside_at < each.row->offset) break;
    if (role < needed_role(each) && (viewer ? !each.skipped() || found.zeros : !each.skipped() && !each.held))
      return {Errc::role_forbidden, each.row->offset};
  }
  if (viewer && found.outside) return {Errc::role_forbidden, found.outside_at};
  return {};
}

bool is_not_there(const RowWrite& write, const AxisImage* axis) {
  if (axis == nullptr) return false;
  if (!takes(*axis, *write.row)) return true;
  const bool known_command = write.row->source == Source::command && write.value >= 1 && write.value <= kLastCommand;
  return known_command && !axis->supports(Command{static_cast<std::uint8_t>(write.value)});
}

WrongRow check_addresses(const RowWrites& found) {
  for (const RowWrite& each : found.rows) {
    if (found.outside && found.outside_at < each.row->offset) break;
    if (!each.skipped() && is_not_there(each, found.axis)) return {Errc::not_supported, each.row->offset};
  }
  if (found.outside) return {Errc::not_supported, found.outside_at};
  return {};
}

/// What the table alone knows: unknown commands and requests, and the number that means "no value".
bool is_no_value(const RowWrite& write, const RowWrites& found) {
  const RegisterRow& row = *write.row;
  if (!found.block && leaves_as_it_is(row, write.value)) return true;
  if (row.source == Source::command && write.value > kLastCommand) return true;
  if (row.source == Source::object_request && write.value > 2) return true;
  if (row.kind != Kind::code && !range_of(row.type).holds(write.value)) return true;
  // Masking a value that was never received would make a number out of none.
  const bool unknown = row.source == Source::quantity && !(*found.axis)[row.quantity].received;
  return found.masks && unknown && found.axis->reachable();
}

WrongRow check_values(const RowWrites& found) {
  for (const RowWrite& each : found.rows)
    if (!each.skipped() && is_no_value(each, found)) return {Errc::bad_value, each.row->offset};
  return {};
}

/// Registers that belong to more than one row, or to none.
bool touches_several(const Request& request, const UnitView& view, const ProcessImage& image) {
  if (request.write_count == 1) return false;
  const auto row_at = [&](std::uint32_t address) -> const RegisterRow* {
    const auto place = view.place_register(address, image);
    return place ? register_table(place->block).covering(place->offset) : nullptr;
  };
  const RegisterRow* const first = row_at(request.write_address);
  return request.write_count > 2 || first == nullptr || first != row_at(request.write_address + 1U);
}

}  // namespace

bool is_remembered(const RegisterRow& row) {
  return row.source == Source::jog_velocity || row.source == Source::set_position_value ||
         (row.source == Source::quantity && row.quantity != Quantity::controlword);
}

const RowWrite* RowWrites::of(Source source) const {
  for (const RowWrite& each : rows)
    if (each.row->source == source) return &each;
  return nullptr;
}

RowWrites resolve_rows(const Request& request, const UnitView& view, const Onlooker& onlooker) {
  RowWrites writes = gather(request, view, onlooker);
  writes.masks = request.function == Function::mask_write_register && request.and_mask != 0;
  // A single write is FC 5, 6, 22, or FC 15 or 16 with exactly one row.
  writes.block = writes.rows.size() > 1 || request.function == Function::read_write_registers;
  writes.several = writes.block || (writes.outside && touches_several(request, view, onlooker.image));
  if (writes.axis != nullptr && writes.block) {
    writes.zeros = !writes.outside && is_all_zero(request, view, onlooker);
    for (RowWrite& each : writes.rows) {
      each.ignored = writes.zeros || is_ignored(each, *writes.axis, onlooker);
      each.cached = !each.ignored && is_cached(each, *writes.axis, onlooker);
      each.held = is_held(each, *writes.axis, onlooker);
    }
  }
  return writes;
}

WrongRow check_role_and_addresses(const RowWrites& writes, Role role) {
  if (const WrongRow wrong = check_role(writes, role); wrong.code != Errc::ok) return wrong;
  return check_addresses(writes);
}

WrongRow check_rows(const RowWrites& writes, Role role) {
  if (const WrongRow wrong = check_role_and_addresses(writes, role); wrong.code != Errc::ok) return wrong;
  return check_values(writes);
}

WrongRow first_refused(const RowWrites& writes, const WrongRow& wrong) {
  if (wrong.code != Errc::bad_value || writes.axis == nullptr) return wrong;
  for (const RowWrite& each : writes.rows) {
    if (each.row->offset >= wrong.row) break;
    const bool asks = !each.skipped() && !each.held && is_remembered(*each.row);
    if (asks && each.row->source == Source::quantity && !writes.axis->limit(each.row->quantity).holds(each.value))
      return {wrong.code, each.row->offset};
  }
  return wrong;
}

}  // namespace axisgate::modbus_tcp
