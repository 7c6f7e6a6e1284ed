// SPDX-License-Identifier: Apache-2.0
#include "adapters/canopen/sdo/sdo_codec.hpp"

#include <algorithm>
#include <boost/crc.hpp>
#include <cassert>

namespace axisgate::canopen {

namespace {

using Kind = SdoReply::Kind;

/// Bit fields of the command byte.
constexpr Byte kToggle = 0x10;

SdoFrame with_object(Byte command, ObjectAddress object) {
  SdoFrame frame{};
  frame[0] = command;
  store_le16(frame, 1, object.index);
  frame[3] = object.sub;
  return frame;
}

SdoFrame with_size(Byte command, ObjectAddress object, std::uint32_t size) {
  SdoFrame frame = with_object(command, object);
  store_le(frame, 4, 4, size);
  return frame;
}

Byte command_of(unsigned bits) { return static_cast<Byte>(bits); }

void copy_data(Bytes data, SdoFrame& frame, std::size_t at) {
  assert(!data.empty() && at + data.size() <= frame.size());
  std::copy(data.begin(), data.end(), frame.begin() + static_cast<std::ptrdiff_t>(at));
}

ObjectAddress object_of(Bytes bytes) { return {load_le16(bytes, 1), bytes[3]}; }

std::optional<SdoReply> take_data(SdoReply reply, Bytes bytes, std::size_t at, std::size_t count) {
  if (bytes.size() < at + count) return std::nullopt;
  reply.data.assign(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    bytes.begin() + static_cast<std::ptrdiff_t>(at + count));
  return reply;
}

std::optional<SdoReply> decode_segment(Bytes bytes) {
  SdoReply reply{.kind = Kind::segment};
  reply.toggle = (bytes[0] & kToggle) != 0;
  reply.last = (bytes[0] & 0x01) != 0;
  return take_data(reply, bytes, 1, kSegmentBytes - ((bytes[0] >> 1) & 0x07U));
}

std::optional<SdoReply> decode_upload(Bytes bytes) {
  const bool expedited = (bytes[0] & 0x02) != 0;
  const bool size_given = (bytes[0] & 0x01) != 0;
  SdoReply reply{.kind = expedited ? Kind::value : Kind::upload_begins, .object = object_of(bytes)};
  if (expedited) {
    reply.unsized = !size_given;
    const std::size_t there = std::min(bytes.size() - 4, kExpeditedBytes);
    const std::size_t count = size_given ? kExpeditedBytes - ((bytes[0] >> 2) & 0x03U) : there;
    if (count == 0) return std::nullopt;
    return take_data(reply, bytes, 4, count);
  }
  if (!size_given) return reply;
  if (bytes.size() < kSdoFrameBytes) return std::nullopt;
  reply.size = load_le(bytes, 4, 4);
  return reply;
}

std::optional<SdoReply> decode_block_download(Bytes bytes) {
  SdoReply reply;
  switch (bytes[0] & 0x03) {
    case 0:
      if (bytes.size() < 5) return std::nullopt;
      reply.kind = Kind::block_download_begins;
      reply.object = object_of(bytes);
      reply.crc = (bytes[0] & 0x04) != 0;
      reply.segments = bytes[4];
      return reply;
    case 1:
      reply.kind = Kind::block_downloaded;
      return reply;
    case 2:
      if (bytes.size() < 3) return std::nullopt;
      reply.kind = Kind::block_received;
      reply.sequence = bytes[1];
      reply.segments = bytes[2];
      return reply;
    default:
      return std::nullopt;
  }
}

std::optional<SdoReply> decode_block_upload(Bytes bytes) {
  SdoReply reply;
  if ((bytes[0] & 0x01) != 0) {
    if (bytes.size() < 3) return std::nullopt;
    reply.kind = Kind::block_upload_ends;
    reply.unused = (bytes[0] >> 2) & 0x07;
    reply.checksum = load_le16(bytes, 1);
    return reply;
  }
  if (bytes.size() < kSdoFrameBytes) return std::nullopt;
  reply.kind = Kind::block_upload_begins;
  reply.object = object_of(bytes);
  reply.crc = (bytes[0] & 0x04) != 0;
  if ((bytes[0] & 0x02) != 0) reply.size = load_le(bytes, 4, 4);
  return reply;
}

}  // namespace

SdoFrame abort_frame(ObjectAddress object, std::uint32_t code) { return with_size(0x80, object, code); }

SdoFrame upload_frame(ObjectAddress object) { return with_object(0x40, object); }

SdoFrame upload_segment_frame(bool toggle) { return {command_of(0x60U | (toggle ? kToggle : 0U))}; }

SdoFrame block_upload_frame(ObjectAddress object, std::uint8_t segments, std::uint8_t threshold) {
  SdoFrame frame = with_object(0xA4, object);
  frame[4] = segments;
  frame[5] = threshold;
  return frame;
}

SdoFrame block_upload_start_frame() { return {0xA3}; }

SdoFrame block_upload_ack_frame(std::uint8_t sequence, std::uint8_t segments) { return {0xA2, sequence, segments}; }

SdoFrame block_upload_end_frame() { return {0xA1}; }

SdoFrame expedited_download_frame(ObjectAddress object, Bytes data) {
  const std::size_t unused = kExpeditedBytes - data.size();
  SdoFrame frame = with_object(command_of(0x23U | static_cast<unsigned>(unused << 2)), object);
  copy_data(data, frame, 4);
  return frame;
}

SdoFrame download_frame(ObjectAddress object, std::uint32_t size) { return with_size(0x21, object, size); }

SdoFrame download_segment_frame(bool toggle, Bytes data, bool last) {
  const auto unused = static_cast<unsigned>(kSegmentBytes - data.size());
  SdoFrame frame{command_of((toggle ? kToggle : 0U) | (unused << 1) | (last ? 1U : 0U))};
  copy_data(data, frame, 1);
  return frame;
}

SdoFrame block_download_frame(ObjectAddress object, std::uint32_t size) { return with_size(0xC6, object, size); }

SdoFrame block_segment_frame(std::uint8_t sequence, Bytes data, bool last) {
  SdoFrame frame{command_of(sequence | (last ? 0x80U : 0U))};
  copy_data(data, frame, 1);
  return frame;
}

SdoFrame block_download_end_frame(std::uint8_t unused, std::uint16_t crc) {
  SdoFrame frame{command_of(0xC1U | (static_cast<unsigned>(unused) << 2))};
  store_le16(frame, 1, crc);
  return frame;
}

bool names_object(Kind kind) {
  switch (kind) {
    case Kind::downloaded:
    case Kind::value:
    case Kind::upload_begins:
    case Kind::aborted:
    case Kind::block_download_begins:
    case Kind::block_upload_begins:
      return true;
    default:
      return false;
  }
}

std::optional<SdoReply> decode_reply(Bytes bytes) {
  if (bytes.empty()) return std::nullopt;
  switch (bytes[0] >> 5) {
    case 0:
      return decode_segment(bytes);
    case 1:
      return SdoReply{.kind = Kind::segment_downloaded, .toggle = (bytes[0] & kToggle) != 0};
    case 2:
      return bytes.size() < 4 ? std::nullopt : decode_upload(bytes);
    case 3:
      if (bytes.size() < 4) return std::nullopt;
      return SdoReply{.kind = Kind::downloaded, .object = object_of(bytes)};
    case 4:
      if (bytes.size() < kSdoFrameBytes) return std::nullopt;
      return SdoReply{.kind = Kind::aborted, .object = object_of(bytes), .code = load_le(bytes, 4, 4)};
    case 5:
      return decode_block_download(bytes);
    case 6:
      return decode_block_upload(bytes);
    default:
      return std::nullopt;
  }
}

std::optional<BlockSegment> decode_block_segment(Bytes bytes) {
  if (bytes.size() < kSdoFrameBytes || (bytes[0] & 0x7F) == 0) return std::nullopt;
  BlockSegment segment;
  segment.sequence = bytes[0] & 0x7F;
  segment.last = (bytes[0] & 0x80) != 0;
  std::copy_n(bytes.begin() + 1, kSegmentBytes, segment.data.begin());
  return segment;
}

std::uint16_t sdo_crc(Bytes bytes) {
  boost::crc_optimal<16, 0x1021, 0, 0, false, false> crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

}  // namespace axisgate::canopen
