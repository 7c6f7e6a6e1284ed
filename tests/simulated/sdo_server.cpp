// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/sdo_server.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::uint8_t size_indicated = 0x01;
constexpr std::uint8_t expedited = 0x02;
constexpr std::uint8_t toggle_bit = 0x10;
constexpr std::uint8_t last_segment = 0x01;
constexpr std::uint8_t abort_command = 0x80;

enum class Service : std::uint8_t {
  download_segment = 0,
  initiate_download = 1,
  initiate_upload = 2,
  upload_segment = 3,
  abort = 4,
  block_upload = 5,
  block_download = 6,
};

CanBytes with_object(std::uint8_t command, ObjectKey key, CanView data, std::size_t size = longest_can_frame) {
  CanBytes reply{command, static_cast<std::uint8_t>(key.index), static_cast<std::uint8_t>(key.index >> 8), key.sub};
  reply.insert(reply.end(), data.begin(), data.end());
  reply.resize(size);
  return reply;
}

}  // namespace

CanBytes SdoServer::plain(std::uint8_t command) const {
  CanBytes reply(longest_can_frame);
  reply[0] = command;
  return reply;
}

void SdoServer::begin(CanView request, Stage stage) {
  stage_ = stage;
  key_ = key_in(request);
  data_.clear();
  at_ = 0;
  announced_.reset();
  toggle_ = with_crc_ = last_seen_ = false;
  sequence_ = 0;
}

SdoServer::Replies SdoServer::abort(std::uint32_t code) {
  reset();
  return {with_object(abort_command, key_, little_endian(code, 4))};
}

CanBytes SdoServer::refusal(CanView request, std::uint32_t code) const {
  return with_object(abort_command, idle() ? key_in(request) : key_, little_endian(code, 4));
}

SdoServer::Replies SdoServer::answer(CanView request, ObjectAccess& objects, std::uint64_t tag, Time now) {
  if (request.size() < (facts_.takes_short_frames ? 4 : longest_can_frame)) return {};
  CanBytes whole(request.begin(), request.end());
  whole.resize(longest_can_frame);
  if (whole[0] == abort_command) {
    reset();
    return {};
  }
  if (stage_ == Stage::block_download) return block_segment(whole);
  switch (static_cast<Service>(whole[0] >> 5)) {
    case Service::initiate_download:
      return initiate_download(whole, objects, tag, now);
    case Service::initiate_upload:
      return initiate_upload(whole, objects, now);
    case Service::download_segment:
      return download_segment(whole, objects, tag, now);
    case Service::upload_segment:
      return upload_segment(whole);
    case Service::block_upload:
      if (facts_.block) return block_upload(whole, objects, now);
      break;
    case Service::block_download:
      if (facts_.block) return block_download(whole, objects, tag, now);
      break;
    case Service::abort:
      break;
  }
  key_ = key_in(whole);
  return abort(sdo_abort::command);
}

SdoServer::Replies SdoServer::initiate_download(CanView request, ObjectAccess& objects, std::uint64_t tag, Time now) {
  begin(request, Stage::download);
  const std::uint8_t command = request[0];
  if ((command & expedited) == 0) {
    if (!facts_.segmented) return abort(sdo_abort::command);
    if ((command & size_indicated) != 0) announced_ = little_endian(request.subspan(4));
    if (announced_.value_or(0) > facts_.longest_object) return abort(sdo_abort::out_of_memory);
    return {with_object(0x60, key_, {})};
  }
  std::size_t size = 4U - ((command >> 2) & 0x03U);
  if ((command & size_indicated) == 0) size = std::clamp<std::size_t>(objects.read(key_, now).bytes.size(), 1, 4);
  const CanView data = request.subspan(4, size);
  const std::uint32_t refused = objects.write(key_, data, tag, now);
  if (refused != 0) return abort(refused);
  reset();
  const bool cut = facts_.short_frames && size <= 2;
  return {with_object(0x60, key_, facts_.echoes_written ? data : CanView{}, cut ? 6 : longest_can_frame)};
}

SdoServer::Replies SdoServer::download_segment(CanView request, ObjectAccess& objects, std::uint64_t tag, Time now) {
  if (stage_ != Stage::download) return abort(sdo_abort::command);
  const std::uint8_t command = request[0];
  if (((command & toggle_bit) != 0) != toggle_) return abort(sdo_abort::toggle);
  const std::size_t size = segment_bytes - ((command >> 1) & 0x07U);
  if (data_.size() + size > facts_.longest_object) return abort(sdo_abort::out_of_memory);
  data_.insert(data_.end(), request.begin() + 1, request.begin() + 1 + static_cast<std::ptrdiff_t>(size));
  const CanBytes reply = plain(static_cast<std::uint8_t>(0x20 | (toggle_ ? toggle_bit : 0)));
  toggle_ = !toggle_;
  if ((command & last_segment) == 0) return {reply};
  if (announced_ && *announced_ != data_.size()) return abort(abort_of(Refusal::wrong_width));
  const std::uint32_t refused = objects.write(key_, data_, tag, now);
  if (refused != 0) return abort(refused);
  reset();
  return {reply};
}

SdoServer::Replies SdoServer::initiate_upload(CanView request, ObjectAccess& objects, Time now) {
  begin(request, Stage::upload);
  ObjectReply found = objects.read(key_, now);
  if (found.abort != 0) return abort(found.abort);
  const std::size_t size = found.bytes.size();
  if (size >= 1 && size <= 4) {
    reset();
    const auto command = static_cast<std::uint8_t>(0x43 | (4 - size) << 2);
    return {with_object(command, key_, found.bytes, facts_.short_frames && size <= 2 ? 6 : longest_can_frame)};
  }
  if (!facts_.segmented) return abort(sdo_abort::unsupported_access);
  data_ = std::move(found.bytes);
  return {with_object(0x41, key_, little_endian(static_cast<std::uint32_t>(size), 4))};
}

SdoServer::Replies SdoServer::upload_segment(CanView request) {
  if (stage_ != Stage::upload) return abort(sdo_abort::command);
  if (((request[0] & toggle_bit) != 0) != toggle_) return abort(sdo_abort::toggle);
  const std::size_t size = std::min(segment_bytes, data_.size() - at_);
  CanBytes reply = plain(static_cast<std::uint8_t>((toggle_ ? toggle_bit : 0) | (segment_bytes - size) << 1));
  std::copy_n(data_.begin() + static_cast<std::ptrdiff_t>(at_), size, reply.begin() + 1);
  at_ += size;
  toggle_ = !toggle_;
  if (at_ == data_.size()) {
    reply[0] |= last_segment;
    reset();
  }
  return {reply};
}

}  // namespace axisgate::simulated
