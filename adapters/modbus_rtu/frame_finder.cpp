// SPDX-License-Identifier: Apache-2.0
#include "adapters/modbus_rtu/frame_finder.hpp"

#include <algorithm>
#include <cassert>

#include "gateway/core/rtu_crc.hpp"

namespace axisgate::modbus_rtu {

namespace {

constexpr std::size_t kLongest = kMaxFrame + kCrcSize;
constexpr std::size_t kUnknownYet = 0;

/// Length of the frame that begins so, CRC included, by its function byte, as libmodbus 3.1.6 reads confirmations. A
/// function that it does not know, errors among them, has one byte of data.
std::size_t frame_size(Bytes head) {
  if (head.size() < 2) return kUnknownYet;
  switch (head[1]) {
    case 0x00:
    case 0x01:  // coils and inputs, registers of both kinds, report of what a slave is, write and read: counted
    case 0x02:
    case 0x03:
    case 0x04:
    case 0x11:
    case 0x17:
      return head.size() < 3 ? kUnknownYet : std::size_t{5} + head[2];
    case 0x05:  // writes of one or several coils or registers
    case 0x06:
    case 0x0F:
    case 0x10:
      return 8;
    case 0x16:  // mask write
      return 10;
    default:
      return 5;
  }
}

}  // namespace

void FrameFinder::sent(Bytes request) {
  assert(request.size() <= request_.capacity());
  request_.assign(request.begin(), request.end());
  glitch_.renew();
}

void FrameFinder::take(Bytes bytes) {
  held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(taken_));
  taken_ = 0;
  assert(bytes.size() <= room());
  held_.insert(held_.end(), bytes.begin(), bytes.end());
}

FrameFinder::Found FrameFinder::next(bool patience_over) {
  const Bytes bytes = held();
  if (bytes.empty()) return {};
  const Bytes request(request_.data(), request_.size());
  const std::size_t common = std::min(bytes.size(), request.size());
  if (common > 0 && std::ranges::equal(bytes.first(common), request.first(common))) {
    if (common == request.size()) return give(Found::Kind::copy, common);
    if (!patience_over) return {};
  }
  std::size_t glitch = 0;
  while (glitch < bytes.size() && glitch_.skips(bytes[glitch])) ++glitch;
  if (glitch > 0) return give(Found::Kind::glitch, glitch);
  const std::size_t size = frame_size(bytes);
  if (size > kLongest) return give(Found::Kind::noise, bytes.size());
  if (size != kUnknownYet && bytes.size() >= size) return give(Found::Kind::frame, size);
  return patience_over ? give(Found::Kind::noise, bytes.size()) : Found{};
}

FrameFinder::Found FrameFinder::give(Found::Kind kind, std::size_t bytes) {
  const Found found{kind, held().first(bytes)};
  taken_ += bytes;
  if (kind == Found::Kind::frame || kind == Found::Kind::copy) glitch_.renew();
  return found;
}

std::size_t FrameFinder::drop() {
  const std::size_t dropped = held().size();
  held_.clear();
  taken_ = 0;
  return dropped;
}

}  // namespace axisgate::modbus_rtu
