// SPDX-License-Identifier: Apache-2.0
// Process data (CiA 301 section 7.2.2): eight bytes, cut into objects by a map that both sides know.
// Promises values only of a frame that carries the whole map; what it carries beyond is not looked at.
// Never knows who sent it.
#pragma once

#include <optional>

#include "adapters/bus/exchange.hpp"
#include "adapters/can/can_frame.hpp"

namespace axisgate::canopen {

/// Bytes that the map takes.
[[nodiscard]] std::size_t size_of(const bus::ProcessMap& map);

/// No value: the frame is shorter than its map.
[[nodiscard]] std::optional<bus::ReplyFields> decode_process_data(const bus::ProcessMap& map, Bytes bytes);

/// `values`: one for each object of the map, in its order; the map takes can::kMaxFrameBytes at most.
[[nodiscard]] can::CanFrame encode_process_data(std::uint32_t id, const bus::ReplyFields& values);

}  // namespace axisgate::canopen
