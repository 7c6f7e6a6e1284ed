// SPDX-License-Identifier: Apache-2.0
#include "adapters/canopen/sdo/sdo_upload.hpp"

#include <algorithm>
#include <cassert>
#include <memory>

namespace axisgate::canopen {

namespace {

using Kind = SdoReply::Kind;

/// What the last segment of a block upload may carry beyond the object.
constexpr std::size_t kMaxPadding = kSegmentBytes - 1;

}  // namespace

SdoFrames SdoUpload::begin() {
  const bool ask_for_blocks = block_ && !whole_;
  awaited_ = ask_for_blocks ? Awaited::block_initiate : Awaited::initiate;
  return {ask_for_blocks ? block_upload_frame(object_, kMaxBlockSegments, kBlockThreshold) : upload_frame(object_)};
}

SdoFrames SdoUpload::next() {
  assert(awaited_ == Awaited::nothing);
  if (!in_blocks_) {
    awaited_ = Awaited::segment;
    return {upload_segment_frame(toggle_)};
  }
  awaited_ = Awaited::block_segment;
  const SdoFrame frame = started_ ? block_upload_ack_frame(sequence_, kMaxBlockSegments) : block_upload_start_frame();
  started_ = true;
  sequence_ = 0;
  return {frame};
}

std::optional<SdoStep> SdoUpload::take(Bytes bytes) {
  if (awaited_ == Awaited::nothing) return std::nullopt;
  if (awaited_ == Awaited::block_segment) return on_block_segment(bytes);
  const auto reply = decode_reply(bytes);
  if (!reply || (names_object(reply->kind) && reply->object != object_)) return std::nullopt;
  if (reply->kind == Kind::aborted) {
    // A segment of a block that comes again looks like one but for the command's other bits.
    if (in_blocks_ && bytes[0] != 0x80) return std::nullopt;
    return on_abort(reply->code);
  }
  switch (awaited_) {
    case Awaited::initiate:
    case Awaited::block_initiate:
      return on_initiate(*reply);
    case Awaited::segment:
      if (reply->kind != Kind::segment || reply->toggle != toggle_) return std::nullopt;
      return on_segment(*reply);
    case Awaited::block_end:
      if (reply->kind != Kind::block_upload_ends) return std::nullopt;
      return on_block_end(*reply);
    default:
      return std::nullopt;
  }
}

/// A server asked for blocks may answer a short object without them.
std::optional<SdoStep> SdoUpload::on_initiate(const SdoReply& reply) {
  switch (reply.kind) {
    case Kind::value:
      return on_value(reply);
    case Kind::upload_begins:
      return on_begun(reply, false);
    case Kind::block_upload_begins:
      if (awaited_ != Awaited::block_initiate) return std::nullopt;
      return on_begun(reply, true);
    default:
      return std::nullopt;
  }
}

/// What stands above the object in an answer without a size is nobody's.
std::optional<SdoStep> SdoUpload::on_value(const SdoReply& reply) {
  const std::size_t size = reply.unsized ? unsaid_ : reply.data.size();
  if (reply.data.size() < size) return std::nullopt;
  awaited_ = Awaited::nothing;
  data_.assign(reply.data.begin(), reply.data.begin() + static_cast<std::ptrdiff_t>(size));
  return content();
}

SdoStep SdoUpload::on_begun(const SdoReply& reply, bool in_blocks) {
  awaited_ = Awaited::nothing;
  if (whole_ && reply.size.value_or(0) > kExpeditedBytes) return no_field();
  if (reply.size.value_or(0) > kMaxObjectBytes) return too_long();
  in_blocks_ = in_blocks;
  crc_ = reply.crc;
  size_ = reply.size;
  data_.reserve(size_.value_or(0));
  return whole_ ? ask_for_segment() : paused();
}

/// Within the same exchange.
SdoStep SdoUpload::ask_for_segment() {
  SdoStep step;
  step.frames = next();
  return step;
}

SdoStep SdoUpload::no_field() const { return aborting(object_, kAbortDeviceState, refused(kAbortLength)); }

SdoStep SdoUpload::on_segment(const SdoReply& reply) {
  awaited_ = Awaited::nothing;
  toggle_ = !toggle_;
  data_.insert(data_.end(), reply.data.begin(), reply.data.end());
  if (data_.size() > kMaxObjectBytes) return too_long();
  if (whole_ && (!reply.last || data_.size() > kExpeditedBytes)) return no_field();
  const bool fits = !size_ || (reply.last ? data_.size() == *size_ : data_.size() <= *size_);
  if (!fits) return broken(object_, kAbortLength);
  return reply.last ? content() : paused();
}

std::optional<SdoStep> SdoUpload::on_block_segment(Bytes bytes) {
  const auto reply = decode_reply(bytes);
  // 0x80 exactly: as a segment it would be number 0, which there is not.
  if (reply && reply->kind == Kind::aborted && bytes[0] == 0x80) {
    if (reply->object != object_) return std::nullopt;
    return on_abort(reply->code);
  }
  const auto segment = decode_block_segment(bytes);
  if (!segment || segment->sequence > kMaxBlockSegments) return std::nullopt;
  // One that comes after a gap, or again, is not taken: the acknowledgement makes the server repeat from there.
  const bool in_turn = segment->sequence == sequence_ + 1;
  if (in_turn) {
    ++sequence_;
    data_.insert(data_.end(), segment->data.begin(), segment->data.end());
    if (data_.size() > kMaxObjectBytes + kMaxPadding) return too_long();
  }
  if (segment->last || segment->sequence == kMaxBlockSegments) return on_block(in_turn && segment->last);
  return SdoStep{};
}

SdoStep SdoUpload::on_block(bool complete) {
  if (complete) {
    awaited_ = Awaited::block_end;
    SdoStep step;
    step.frames.push_back(block_upload_ack_frame(sequence_, kMaxBlockSegments));
    return step;
  }
  awaited_ = Awaited::nothing;
  barren_blocks_ = sequence_ == 0 ? barren_blocks_ + 1 : 0;
  return barren_blocks_ == kMaxBarrenBlocks ? broken(object_, kAbortSequence) : paused();
}

SdoStep SdoUpload::on_block_end(const SdoReply& reply) {
  awaited_ = Awaited::nothing;
  const auto unused = std::min<std::ptrdiff_t>(reply.unused, std::ssize(data_));
  data_.erase(data_.end() - unused, data_.end());
  if (data_.size() > kMaxObjectBytes) return too_long();
  if (size_ && data_.size() != *size_) return broken(object_, kAbortLength);
  if (crc_ && sdo_crc(data_) != reply.checksum) return broken(object_, kAbortCrc);
  SdoStep step = content();
  step.frames.push_back(block_upload_end_frame());
  return step;
}

SdoStep SdoUpload::on_abort(std::uint32_t code) {
  if (awaited_ == Awaited::block_initiate && code == kAbortUnknownCommand) {
    awaited_ = Awaited::initiate;
    SdoStep step;
    step.frames.push_back(upload_frame(object_));
    return step;
  }
  awaited_ = Awaited::nothing;
  return over(refused(code));
}

/// It will be as long the next time: not refused for now alone, though the code says "out of memory".
SdoStep SdoUpload::too_long() const {
  bus::ExchangeResult result = refused(kAbortOutOfMemory);
  result.for_now = false;
  return aborting(object_, kAbortOutOfMemory, std::move(result));
}

SdoStep SdoUpload::content() const {
  bus::ExchangeResult result;
  const std::size_t size = data_.size();
  if (size == 1 || size == 2 || size == 4) {
    result.fields.push_back({object_, static_cast<std::uint8_t>(size), load_le(data_, 0, size)});
  } else if (whole_) {
    return over(refused(kAbortLength));
  } else {
    result.bytes = std::make_shared<const std::vector<Byte>>(data_);
  }
  return over(std::move(result));
}

}  // namespace axisgate::canopen
