// SPDX-License-Identifier: Apache-2.0
// SDO frames (CiA 301 section 7.2.4.3), bytes to fields and back: expedited, segmented and block transfer, aborts.
// Promises that every request is eight bytes, unused ones 00, and that a reply is taken where it is long enough for
// what it says, though a drive may send fewer than eight (JD K36).
// Never remembers anything: what a frame answers is the transfer's question.
#pragma once

#include <array>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>

#include "adapters/bus/exchange.hpp"

namespace axisgate::canopen {

inline constexpr std::size_t kSdoFrameBytes = 8;
/// Data bytes of a segment.
inline constexpr std::size_t kSegmentBytes = 7;
/// Data bytes of an expedited transfer.
inline constexpr std::size_t kExpeditedBytes = 4;
/// Segments of one block, both ways: more would keep other nodes waiting too long (design 7, point 6).
inline constexpr std::uint8_t kMaxBlockSegments = 16;

/// CiA 301 table 22, as far as we send or judge them.
inline constexpr std::uint32_t kAbortTimedOut = 0x05040000;
inline constexpr std::uint32_t kAbortUnknownCommand = 0x05040001;
inline constexpr std::uint32_t kAbortBlockSize = 0x05040002;
inline constexpr std::uint32_t kAbortSequence = 0x05040003;
inline constexpr std::uint32_t kAbortCrc = 0x05040004;
inline constexpr std::uint32_t kAbortOutOfMemory = 0x05040005;
inline constexpr std::uint32_t kAbortLength = 0x06070010;
inline constexpr std::uint32_t kAbortDeviceState = 0x08000022;

using SdoFrame = std::array<Byte, kSdoFrameBytes>;

[[nodiscard]] SdoFrame abort_frame(ObjectAddress object, std::uint32_t code);

[[nodiscard]] SdoFrame upload_frame(ObjectAddress object);
[[nodiscard]] SdoFrame upload_segment_frame(bool toggle);
/// `threshold`: the server may answer an object of so many bytes or fewer without blocks.
[[nodiscard]] SdoFrame block_upload_frame(ObjectAddress object, std::uint8_t segments, std::uint8_t threshold);
[[nodiscard]] SdoFrame block_upload_start_frame();
[[nodiscard]] SdoFrame block_upload_ack_frame(std::uint8_t sequence, std::uint8_t segments);
[[nodiscard]] SdoFrame block_upload_end_frame();

/// `data`: 1 to kExpeditedBytes.
[[nodiscard]] SdoFrame expedited_download_frame(ObjectAddress object, Bytes data);
[[nodiscard]] SdoFrame download_frame(ObjectAddress object, std::uint32_t size);
/// `data`: 1 to kSegmentBytes.
[[nodiscard]] SdoFrame download_segment_frame(bool toggle, Bytes data, bool last);
[[nodiscard]] SdoFrame block_download_frame(ObjectAddress object, std::uint32_t size);
/// `data`: 1 to kSegmentBytes.
[[nodiscard]] SdoFrame block_segment_frame(std::uint8_t sequence, Bytes data, bool last);
/// `unused`: bytes of the last segment that carry nothing.
[[nodiscard]] SdoFrame block_download_end_frame(std::uint8_t unused, std::uint16_t crc);

struct SdoReply {
  enum class Kind : std::uint8_t {
    downloaded,             ///< written, or a segmented download may begin
    segment_downloaded,     //
    value,                  ///< expedited
    upload_begins,          ///< segmented
    segment,                //
    aborted,                //
    block_download_begins,  //
    block_received,         //
    block_downloaded,       //
    block_upload_begins,    //
    block_upload_ends,
  };
  Kind kind = Kind::downloaded;
  ObjectAddress object{};               ///< where names_object()
  bool toggle = false;                  ///< segments
  bool last = false;                    ///< segment
  bool crc = false;                     ///< the server of a block transfer can do CRC
  std::uint8_t segments = 0;            ///< of the next block it will take
  std::uint8_t sequence = 0;            ///< last segment of the block that it has received
  std::uint8_t unused = 0;              ///< bytes of the last block segment that carry nothing
  std::uint16_t checksum = 0;           ///< block_upload_ends
  std::uint32_t code = 0;               ///< aborted
  std::optional<std::uint32_t> size{};  ///< of the whole object, where the server says it
  bool unsized = false;                 ///< value: the server does not say how many bytes of `data` are the object's
  boost::container::static_vector<Byte, kSegmentBytes> data{};
  friend bool operator==(const SdoReply&, const SdoReply&) = default;
};

/// Segments and what ends a block transfer carry no object.
[[nodiscard]] bool names_object(SdoReply::Kind kind);

/// No value: no reply, or shorter than it says. What follows a block upload's start must go to decode_block_segment().
[[nodiscard]] std::optional<SdoReply> decode_reply(Bytes bytes);

struct BlockSegment {
  std::uint8_t sequence = 0;
  bool last = false;
  std::array<Byte, kSegmentBytes> data{};
  friend bool operator==(const BlockSegment&, const BlockSegment&) = default;
};
/// No value: not as long as a segment of a block is, or sequence 0.
[[nodiscard]] std::optional<BlockSegment> decode_block_segment(Bytes bytes);

/// CRC-16-CCITT of CiA 301 section 7.2.4.3.16: polynomial 0x1021, begun with 0.
[[nodiscard]] std::uint16_t sdo_crc(Bytes bytes);

}  // namespace axisgate::canopen
