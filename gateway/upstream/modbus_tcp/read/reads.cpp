// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/read/reads.hpp"

#include <algorithm>
#include <span>

#include "gateway/image/float_rows.hpp"
#include "gateway/image/shown.hpp"

namespace axisgate::modbus_tcp {
namespace {

constexpr ModbusException kOutside = ModbusException::illegal_data_address;
constexpr ModbusException kNoAnswer = ModbusException::gateway_target_failed;

/// One block of the map, found: the rows and where their values come from.
struct FoundBlock {
  const RegisterTable& table;
  RegisterPlace place;
  const AxisImage* axis = nullptr;  ///< of axis and overview blocks; nullptr: a gap in the overview, which reads 0

  [[nodiscard]] std::uint32_t value(const RegisterRow& row, const Onlooker& onlooker) const {
    switch (place.block) {
      case Block::gateway:
        return gateway_value(row, onlooker);
      case Block::bus:
        return bus_value(row, onlooker.image.buses[place.number]);
      case Block::axis:
      case Block::overview:
        return axis == nullptr ? 0 : axis_value(row, *axis, onlooker);
    }
    return 0;
  }
  /// The bits that this listener's clients read.
  [[nodiscard]] std::uint32_t shown(const RegisterRow& row, const Onlooker& onlooker) const {
    const std::uint32_t bits = value(row, onlooker);
    if (!onlooker.settings.float_numbers || axis == nullptr || !is_float_row(row)) return bits;
    return float_bits(row, number_of(bits, row.type), axis->units_per_rev);
  }
};

FoundBlock found_block(const RegisterPlace& place, const ProcessImage& image) {
  const bool has_axis = place.block == Block::axis || place.block == Block::overview;
  return {register_table(place.block), place, has_axis ? image.find(place.number) : nullptr};
}

[[nodiscard]] bool must_refuse(const AxisImage* axis, const ListenerSettings& settings) {
  return settings.offline_reads_fail && axis != nullptr && !axis->reachable();
}

/// One register of a row: which half of a 32-bit value it is depends on the listener's word order.
std::uint16_t part_of(const RegisterRow& row, std::uint32_t value, std::uint16_t offset, bool low_word_first) {
  if (row.registers() == 1) return static_cast<std::uint16_t>(value & 0xFFFF);
  const bool first = offset == row.offset;
  return static_cast<std::uint16_t>(first == low_word_first ? value & 0xFFFF : value >> 16);
}

/// Fills in from `place.offset` to the block's end or the last register asked for; how many registers that were. Where
/// nothing is to be filled in, that alone.
std::size_t read_block(const FoundBlock& block, std::size_t wanted, const Onlooker& onlooker, std::span<Byte> to) {
  const std::size_t span = block.place.block == Block::overview ? kOverviewBlock : kAxisBlock;
  const std::size_t count = std::min(wanted, span - block.place.offset);
  if (to.empty()) return count;
  for (std::size_t i = 0; i < count;) {
    const auto offset = static_cast<std::uint16_t>(block.place.offset + i);
    const RegisterRow* row = block.table.covering(offset);
    if (row == nullptr) {
      ++i;  // already 0
      continue;
    }
    const std::uint32_t value = block.shown(*row, onlooker);
    for (std::uint16_t at = offset; i < count && at < row->offset + row->registers(); ++at, ++i) {
      store_be16(to, 2 * i, part_of(*row, value, at, onlooker.settings.low_word_first));
    }
  }
  return count;
}

/// Gateway and bus rows are gathered only when somebody looks.
void refresh_for(std::uint32_t from, std::uint32_t count, const UnitView& view, const Onlooker& onlooker) {
  for (const std::uint32_t edge : {from, from + count - 1}) {
    const auto place = view.place_register(edge, onlooker.image);
    if (place && (place->block == Block::gateway || place->block == Block::bus)) return onlooker.image.refresh();
  }
}

ModbusException read_registers(const Request& request, const UnitView& view, const Onlooker& onlooker,
                               std::span<Byte> to) {
  refresh_for(request.read_address, request.read_count, view, onlooker);
  for (std::size_t done = 0; done < request.read_count;) {
    const auto address = static_cast<std::uint32_t>(request.read_address + done);
    const auto place = view.place_register(address, onlooker.image);
    if (!place) return kOutside;
    const FoundBlock block = found_block(*place, onlooker.image);
    if (must_refuse(block.axis, onlooker.settings)) return kNoAnswer;
    done += read_block(block, request.read_count - done, onlooker, to.empty() ? to : to.subspan(2 * done));
  }
  return ModbusException::none;
}

/// Coils and inputs end below this offset of an axis's block; the rest of it reads 0.
constexpr std::size_t kBitsPerAxis = 16;

/// owned_by_me is each client's own; the gateway knows it whatever the link.
unsigned inputs_seen_by(const AxisImage& axis, ClientId client) {
  const unsigned own = axis.lease.owned_by(client) ? bit(AxisInput::owned_by_me) : 0U;
  return shown_inputs(axis) | own;
}

ModbusException read_bits(const Request& request, const UnitView& view, const Onlooker& onlooker, std::span<Byte> to) {
  const bool coils = request.function == Function::read_coils;
  for (std::size_t done = 0; done < request.read_count;) {
    const auto place = view.place_bit(static_cast<std::uint32_t>(request.read_address + done), onlooker.image);
    if (!place) return kOutside;
    if (must_refuse(place->axis, onlooker.settings)) return kNoAnswer;
    const unsigned bits = coils ? shown_level_coils(*place->axis) : inputs_seen_by(*place->axis, onlooker.client.id);
    const std::size_t in_block = std::min<std::size_t>(request.read_count - done, kAxisBlock - place->offset);
    for (std::size_t i = 0; i < in_block && place->offset + i < kBitsPerAxis; ++i) {
      const unsigned value = (bits >> (place->offset + i)) & 1U;
      to[(done + i) / 8] = static_cast<Byte>(to[(done + i) / 8] | (value << ((done + i) % 8)));
    }
    done += in_block;
  }
  return ModbusException::none;
}

}  // namespace

Pdu answer_read(const Request& request, const UnitView& view, const Onlooker& onlooker) {
  const bool bits = request.function == Function::read_coils || request.function == Function::read_discrete_inputs;
  const std::size_t bytes = bits ? (request.read_count + 7U) / 8U : 2U * request.read_count;
  Pdu pdu = read_reply(request.function, bytes);
  const std::span<Byte> data = std::span(pdu.data(), pdu.size()).subspan(kReadReplyHead);
  const ModbusException wrong = onlooker.role < Role::viewer ? ModbusException::illegal_function
                                : bits                       ? read_bits(request, view, onlooker, data)
                                                             : read_registers(request, view, onlooker, data);
  return wrong == ModbusException::none ? pdu : exception_pdu(static_cast<Byte>(request.function), wrong);
}

ModbusException judge_registers_read(const Request& request, const UnitView& view, const Onlooker& onlooker) {
  return read_registers(request, view, onlooker, {});
}

std::optional<std::uint16_t> read_one(std::uint16_t address, const UnitView& view, const Onlooker& onlooker) {
  const auto place = view.place_register(address, onlooker.image);
  if (!place) return std::nullopt;
  const FoundBlock block = found_block(*place, onlooker.image);
  const RegisterRow* row = block.table.covering(place->offset);
  if (row == nullptr || row->registers() != 1) return std::nullopt;
  return static_cast<std::uint16_t>(block.value(*row, onlooker) & 0xFFFF);
}

}  // namespace axisgate::modbus_tcp
