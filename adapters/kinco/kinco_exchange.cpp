// SPDX-License-Identifier: Apache-2.0
#include "adapters/kinco/kinco_exchange.hpp"

#include <cassert>

namespace axisgate::kinco {

namespace {

Command write_command(std::uint8_t size) {
  assert(size == 1 || size == 2 || size == 4);
  return size == 1 ? Command::write_1 : size == 2 ? Command::write_2 : Command::write_4;
}

/// The low `size` bytes.
std::uint32_t cut(std::uint32_t data, std::uint8_t size) {
  return size == 4 ? data : data & ((std::uint32_t{1} << (8 * size)) - 1);
}

}  // namespace

Frame request_of(const bus::Exchange& exchange) {
  assert(exchange.node >= kFirstStation && exchange.node <= kLastStation);
  if (exchange.access == bus::Access::read) {
    return {.node = exchange.node, .command = Command::read, .object = exchange.object};
  }
  return {.node = exchange.node,
          .command = write_command(exchange.size),
          .object = exchange.object,
          .data = cut(exchange.raw, exchange.size)};
}

bool answers(const Frame& frame, const bus::Exchange& exchange) {
  if (frame.node != exchange.node || frame.object != exchange.object) return false;
  if (frame.command == Command::error) return true;
  return exchange.access == bus::Access::read ? value_size(frame.command) != 0 : frame.command == Command::written;
}

bus::ExchangeResult result_of(const Frame& frame) {
  bus::ExchangeResult result;
  if (frame.command == Command::error) {
    result.code = Errc::refused_by_drive;
    result.detail = frame.data;
    result.for_now = bus::abort_may_pass(frame.data);
  } else if (const std::uint8_t size = value_size(frame.command); size != 0) {
    result.fields.push_back({frame.object, size, cut(frame.data, size)});
  }
  return result;
}

Duration wire_time(std::uint32_t baud, bool cascade, int bits_per_byte) {
  assert(baud > 0);
  const std::int64_t frames = cascade ? 3 : 2;
  const std::int64_t bits = frames * static_cast<std::int64_t>(kFrameSize) * bits_per_byte;
  return Duration(std::chrono::seconds(1)) * bits / static_cast<std::int64_t>(baud);
}

}  // namespace axisgate::kinco
