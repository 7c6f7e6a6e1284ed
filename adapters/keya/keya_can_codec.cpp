// SPDX-License-Identifier: Apache-2.0
#include "adapters/keya/keya_can_codec.hpp"

#include <algorithm>
#include <cassert>

#include "adapters/keya/keya_fields.hpp"

namespace axisgate::keya {

namespace {

constexpr std::uint32_t kNodeMask = 0xFF;

}  // namespace

std::optional<CanOrigin> origin_of(const can::CanFrame& frame) {
  const auto node = static_cast<std::uint8_t>(frame.id & kNodeMask);
  if (!frame.extended || node == 0) return std::nullopt;
  switch (frame.id & ~kNodeMask) {
    case kReplyId:
      return CanOrigin{CanOrigin::Kind::reply, node};
    case kHeartbeatId:
      return CanOrigin{CanOrigin::Kind::heartbeat, node};
    default:
      return std::nullopt;
  }
}

std::vector<can::CanFilter> filters_for(const std::vector<std::uint8_t>& nodes) {
  std::vector<can::CanFilter> filters;
  for (const std::uint8_t node : nodes) {
    for (const std::uint32_t base : {kReplyId, kHeartbeatId})
      filters.push_back({.id = base + node, .mask = can::kMaxExtendedId, .extended = true});
  }
  assert(filters.size() <= can::kMaxFilters);
  return filters;
}

std::array<Byte, 8> encode(const CanMessage& message) {
  std::array<Byte, 8> bytes{};
  bytes[0] = static_cast<Byte>(message.command);
  store_le16(bytes, 1, message.index);
  bytes[3] = message.sub;
  std::ranges::copy(message.data, bytes.begin() + 4);
  return bytes;
}

std::optional<CanMessage> decode(Bytes bytes) {
  if (bytes.size() != 8) return std::nullopt;
  const auto command = static_cast<CanMessage::Command>(bytes[0]);
  switch (command) {
    case CanMessage::Command::write:
    case CanMessage::Command::read:
    case CanMessage::Command::reply:
      break;
    default:
      return std::nullopt;
  }
  CanMessage message{.command = command, .index = load_le16(bytes, 1), .sub = bytes[3]};
  std::ranges::copy(bytes.subspan(4), message.data.begin());
  return message;
}

can::CanFrame extended_frame(std::uint32_t id, Bytes bytes) {
  assert(id <= can::kMaxExtendedId && bytes.size() <= can::kMaxFrameBytes);
  can::CanFrame frame;
  frame.id = id;
  frame.extended = true;
  frame.size = static_cast<std::uint8_t>(bytes.size());
  std::ranges::copy(bytes, frame.data.begin());
  return frame;
}

can::CanFrame request_frame(std::uint8_t node, const CanMessage& message) {
  return extended_frame(kCommandId + node, encode(message));
}

bus::ReplyFields heartbeat_fields(Bytes bytes) {
  assert(bytes.size() == kHeartbeatBytes);
  static constexpr std::array<std::pair<std::uint8_t, std::uint8_t>, 5> kPlaces{
      {{0, 2}, {2, 2}, {4, 2}, {6, 1}, {7, 1}}};
  bus::ReplyFields fields;
  for (const auto& [at, size] : kPlaces) fields.push_back({{kHeartbeatIndex, 0, at}, size, load_be(bytes, at, size)});
  return fields;
}

}  // namespace axisgate::keya
