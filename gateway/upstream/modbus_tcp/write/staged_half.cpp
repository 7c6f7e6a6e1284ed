// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/write/staged_half.hpp"

#include <utility>

#include "gateway/image/register_map.hpp"

namespace axisgate::modbus_tcp {

std::optional<HalfWrite> half_write(const Request& request, const UnitView& view, const ProcessImage& image) {
  if (request.function != Function::write_single_register) return std::nullopt;
  const auto place = view.place_register(request.write_address, image);
  if (!place || place->block != Block::axis) return std::nullopt;
  const RegisterRow* const row = register_table(Block::axis).covering(place->offset);
  if (row == nullptr || !row->writable || row->registers() != 2) return std::nullopt;
  const bool second = place->offset != row->offset;
  return HalfWrite{place->number, row->offset, static_cast<std::uint16_t>(request.write_address - (second ? 1 : 0)),
                   second, request.written_register(0)};
}

Request whole_write(const HalfWrite& half, std::uint16_t other) {
  Request request;
  request.function = Function::write_single_register;
  request.write_address = half.address;
  request.write_count = 2;
  request.data.resize(4);
  store_be16(request.data, 0, half.second ? other : half.word);
  store_be16(request.data, 2, half.second ? half.word : other);
  return request;
}

void StagedHalf::keep(const HalfWrite& half, Instant now) {
  waiting_ = half;
  until_ = now + kHalfKept;
}

std::optional<HalfWrite> StagedHalf::take_other(const HalfWrite& half) {
  const bool other =
      waiting_ && waiting_->axis == half.axis && waiting_->row == half.row && waiting_->second != half.second;
  return other ? take() : std::nullopt;
}

std::optional<HalfWrite> StagedHalf::take() { return std::exchange(waiting_, std::nullopt); }

}  // namespace axisgate::modbus_tcp
