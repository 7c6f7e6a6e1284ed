// SPDX-License-Identifier: Apache-2.0
#include "adapters/canopen/process_data.hpp"

#include <array>
#include <numeric>

namespace axisgate::canopen {

std::size_t size_of(const bus::ProcessMap& map) {
  return std::accumulate(map.begin(), map.end(), std::size_t{0},
                         [](std::size_t sum, const bus::Neighbour& mapped) { return sum + mapped.size; });
}

std::optional<bus::ReplyFields> decode_process_data(const bus::ProcessMap& map, Bytes bytes) {
  if (bytes.size() < size_of(map)) return std::nullopt;
  bus::ReplyFields fields;
  std::size_t at = 0;
  for (const bus::Neighbour& mapped : map) {
    fields.push_back({mapped.object, mapped.size, load_le(bytes, at, mapped.size)});
    at += mapped.size;
  }
  return fields;
}

can::CanFrame encode_process_data(std::uint32_t id, const bus::ReplyFields& values) {
  std::array<Byte, can::kMaxFrameBytes> bytes{};
  std::size_t size = 0;
  for (const bus::ReplyField& value : values) {
    store_le(bytes, size, value.size, value.raw);
    size += value.size;
  }
  return can::data_frame(id, Bytes(bytes).first(size));
}

}  // namespace axisgate::canopen
