// SPDX-License-Identifier: Apache-2.0
#include "adapters/canopen/sdo/sdo_download.hpp"

#include <algorithm>
#include <cassert>

namespace axisgate::canopen {

namespace {
using Kind = SdoReply::Kind;
}  // namespace

SdoDownload::SdoDownload(ObjectAddress object, Bytes data, bool block)
    : object_(object), data_(data.begin(), data.end()), block_(block) {
  assert(!data.empty() && data.size() <= kMaxObjectBytes);
}

SdoFrames SdoDownload::begin() {
  if (expedited()) {
    awaited_ = Awaited::initiate;
    return {expedited_download_frame(object_, data_)};
  }
  if (block_ && data_.size() > kBlockThreshold) {
    awaited_ = Awaited::block_initiate;
    return {block_download_frame(object_, static_cast<std::uint32_t>(data_.size()))};
  }
  return {begin_segmented()};
}

SdoFrame SdoDownload::begin_segmented() {
  awaited_ = Awaited::initiate;
  in_blocks_ = false;
  acknowledged_ = 0;
  return download_frame(object_, static_cast<std::uint32_t>(data_.size()));
}

SdoFrames SdoDownload::next() {
  assert(awaited_ == Awaited::nothing && !complete());
  if (in_blocks_) return next_block();
  awaited_ = Awaited::segment;
  on_wire_bytes_ = std::min(kSegmentBytes, data_.size() - acknowledged_);
  const bool last = acknowledged_ + on_wire_bytes_ == data_.size();
  return {download_segment_frame(toggle_, Bytes(data_).subspan(acknowledged_, on_wire_bytes_), last)};
}

SdoFrames SdoDownload::next_block() {
  awaited_ = Awaited::block;
  SdoFrames frames;
  std::size_t at = acknowledged_;
  for (sent_ = 0; sent_ < segments_ && at < data_.size();) {
    const std::size_t count = std::min(kSegmentBytes, data_.size() - at);
    ++sent_;
    frames.push_back(block_segment_frame(sent_, Bytes(data_).subspan(at, count), at + count == data_.size()));
    at += count;
  }
  return frames;
}

std::optional<SdoStep> SdoDownload::take(Bytes bytes) {
  if (awaited_ == Awaited::nothing) return std::nullopt;
  const auto reply = decode_reply(bytes);
  if (!reply || (names_object(reply->kind) && reply->object != object_)) return std::nullopt;
  if (reply->kind == Kind::aborted) {
    if (awaited_ == Awaited::block_initiate && reply->code == kAbortUnknownCommand) return leave_blocks(false);
    awaited_ = Awaited::nothing;
    return over(refused(reply->code));
  }
  switch (awaited_) {
    case Awaited::initiate:
      if (reply->kind != Kind::downloaded) return std::nullopt;
      return on_begun();
    case Awaited::block_initiate:
      if (reply->kind != Kind::block_download_begins) return std::nullopt;
      return on_block_begun(*reply);
    case Awaited::segment:
      if (reply->kind != Kind::segment_downloaded || reply->toggle != toggle_) return std::nullopt;
      return on_segment();
    case Awaited::block:
      if (reply->kind != Kind::block_received || reply->sequence > sent_) return std::nullopt;
      return on_block(*reply);
    case Awaited::block_end:
      if (reply->kind != Kind::block_downloaded) return std::nullopt;
      awaited_ = Awaited::nothing;
      return over({});
    case Awaited::nothing:
      break;
  }
  return std::nullopt;
}

/// Nothing is in the object before the transfer's end: it may be begun anew.
SdoStep SdoDownload::leave_blocks(bool tell_server) {
  SdoStep step;
  if (tell_server) step.frames.push_back(abort_frame(object_, kAbortBlockSize));
  step.frames.push_back(begin_segmented());
  return step;
}

SdoStep SdoDownload::on_begun() {
  awaited_ = Awaited::nothing;
  return expedited() ? over({}) : paused();
}

SdoStep SdoDownload::on_block_begun(const SdoReply& reply) {
  if (reply.segments == 0 || reply.segments > kMaxBlockSegments) return leave_blocks(true);
  awaited_ = Awaited::nothing;
  in_blocks_ = true;
  crc_ = reply.crc;
  segments_ = reply.segments;
  return paused();
}

SdoStep SdoDownload::on_segment() {
  awaited_ = Awaited::nothing;
  toggle_ = !toggle_;
  acknowledged_ += on_wire_bytes_;
  return complete() ? over({}) : paused();
}

/// Segments after the last one that the server has are sent again with the next block.
std::optional<SdoStep> SdoDownload::on_block(const SdoReply& reply) {
  acknowledged_ = std::min(data_.size(), acknowledged_ + reply.sequence * kSegmentBytes);
  if (complete()) {
    awaited_ = Awaited::block_end;
    const auto unused = static_cast<std::uint8_t>((kSegmentBytes - data_.size() % kSegmentBytes) % kSegmentBytes);
    SdoStep step;
    step.frames.push_back(block_download_end_frame(unused, crc_ ? sdo_crc(data_) : std::uint16_t{0}));
    return step;
  }
  if (reply.segments == 0 || reply.segments > kMaxBlockSegments) return leave_blocks(true);
  awaited_ = Awaited::nothing;
  segments_ = reply.segments;
  barren_blocks_ = reply.sequence == 0 ? barren_blocks_ + 1 : 0;
  return barren_blocks_ == kMaxBarrenBlocks ? broken(object_, kAbortSequence) : paused();
}

}  // namespace axisgate::canopen
