// SPDX-License-Identifier: Apache-2.0
// Block transfers of SdoServer (CiA 301 7.2.4.3.9 to 7.2.4.3.16).
#include "tests/simulated/sdo_server.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::uint8_t last_in_transfer = 0x80;
constexpr std::uint8_t longest_block = 127;

}  // namespace

std::uint16_t sdo_crc(CanView bytes) {
  std::uint32_t crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc ^= std::uint32_t{byte} << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000U) != 0 ? (crc << 1) ^ 0x1021U : crc << 1;
  }
  return static_cast<std::uint16_t>(crc);
}

SdoServer::Replies SdoServer::block_download(CanView request, ObjectAccess& objects, std::uint64_t tag, Time now) {
  const std::uint8_t command = request[0];
  if ((command & 0x01) == 0) {
    begin(request, Stage::block_download);
    with_crc_ = (command & 0x04) != 0;
    if ((command & 0x02) != 0) announced_ = little_endian(request.subspan(4));
    if (announced_.value_or(0) > facts_.longest_object) return abort(sdo_abort::out_of_memory);
    CanBytes reply(request.begin(), request.begin() + 4);
    reply[0] = 0xA4;
    reply.push_back(facts_.block_size);
    reply.resize(longest_can_frame);
    return {reply};
  }
  if (stage_ != Stage::block_end) return abort(sdo_abort::command);
  const std::size_t unused = (command >> 2) & 0x07U;
  if (unused > data_.size()) return abort(abort_of(Refusal::wrong_width));
  data_.resize(data_.size() - unused);
  if (announced_ && *announced_ != data_.size()) return abort(abort_of(Refusal::wrong_width));
  if (with_crc_ && little_endian(request.subspan(1, 2)) != sdo_crc(data_)) return abort(sdo_abort::crc);
  const std::uint32_t refused = objects.write(key_, data_, tag, now);
  if (refused != 0) return abort(refused);
  reset();
  return {plain(0xA1)};
}

SdoServer::Replies SdoServer::block_segment(CanView request) {
  const auto number = static_cast<std::uint8_t>(request[0] & ~last_in_transfer);
  if (number == sequence_ + 1) {  // one out of turn is left out: the acknowledgement tells where to begin again
    sequence_ = number;
    if (data_.size() + segment_bytes > facts_.longest_object + segment_bytes) return abort(sdo_abort::out_of_memory);
    data_.insert(data_.end(), request.begin() + 1, request.end());
    last_seen_ = (request[0] & last_in_transfer) != 0;
  }
  if (!last_seen_ && number < facts_.block_size && (request[0] & last_in_transfer) == 0) return {};
  CanBytes reply = plain(0xA2);
  reply[1] = sequence_;
  reply[2] = facts_.block_size;
  sequence_ = 0;
  if (last_seen_) stage_ = Stage::block_end;
  return {reply};
}

SdoServer::Replies SdoServer::block_upload(CanView request, ObjectAccess& objects, Time now) {
  const std::uint8_t step = request[0] & 0x03;
  if (step == 0) {
    begin(request, Stage::block_upload);
    with_crc_ = (request[0] & 0x04) != 0;
    host_block_ = request[4];
    if (host_block_ == 0 || host_block_ > longest_block) return abort(sdo_abort::block_size);
    ObjectReply found = objects.read(key_, now);
    if (found.abort != 0) return abort(found.abort);
    data_ = std::move(found.bytes);
    CanBytes reply(request.begin(), request.begin() + 4);
    reply[0] = 0xC6;
    const CanBytes size = little_endian(static_cast<std::uint32_t>(data_.size()), 4);
    reply.insert(reply.end(), size.begin(), size.end());
    return {reply};
  }
  if (step == 3 && stage_ == Stage::block_upload && sequence_ == 0) return send_block();
  if (step == 2 && stage_ == Stage::block_upload && sequence_ != 0) {
    const std::uint8_t taken = std::min(request[1], sequence_);
    at_ = std::min(at_ + taken * segment_bytes, data_.size());
    host_block_ = request[2];
    if (host_block_ == 0 || host_block_ > longest_block) return abort(sdo_abort::block_size);
    if (at_ < data_.size()) return send_block();
    stage_ = Stage::block_closing;
    const std::size_t unused = (segment_bytes - data_.size() % segment_bytes) % segment_bytes;
    CanBytes reply = plain(static_cast<std::uint8_t>(0xC1 | unused << 2));
    const std::uint16_t crc = with_crc_ ? sdo_crc(data_) : std::uint16_t{0};
    reply[1] = static_cast<std::uint8_t>(crc);
    reply[2] = static_cast<std::uint8_t>(crc >> 8);
    return {reply};
  }
  if (step == 1 && stage_ == Stage::block_closing) {
    reset();
    return {};
  }
  if (stage_ == Stage::idle) key_ = key_in(request);
  return abort(sdo_abort::command);
}

SdoServer::Replies SdoServer::send_block() {
  Replies frames;
  sequence_ = 0;
  for (std::size_t at = at_; at < data_.size() && sequence_ < host_block_; at += segment_bytes) {
    const std::size_t size = std::min(segment_bytes, data_.size() - at);
    CanBytes frame = plain(++sequence_);
    std::copy_n(data_.begin() + static_cast<std::ptrdiff_t>(at), size, frame.begin() + 1);
    if (at + size == data_.size()) frame[0] |= last_in_transfer;
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace axisgate::simulated
