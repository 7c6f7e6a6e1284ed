// Keya's frames in the notation of the manual, exchanges, and the printers that make a failure readable.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/bus/wire.hpp"
#include "adapters/keya/keya_can_exchange.hpp"
#include "adapters/keya/keya_serial_exchange.hpp"
#include "adapters/keya/keya_text.hpp"

namespace axisgate::keya {

inline void PrintTo(const SerialFrame& frame, std::ostream* out) {
  *out << "node " << int{frame.node} << " start " << std::hex << int{frame.start} << std::dec << " "
       << describe_answer(KeyaLine::rs485, frame);
}

}  // namespace axisgate::keya

namespace axisgate::bus {

inline void PrintTo(const ExchangeResult& result, std::ostream* out) {
  *out << text(result.code) << std::hex << " detail 0x" << result.detail;
  for (const ReplyField& field : result.fields) {
    *out << " " << field.object.index << ":" << int{field.object.sub} << "+" << int{field.object.byte} << "=0x"
         << field.raw << "/" << int{field.size};
  }
  *out << std::dec;
}

inline void PrintTo(const Notice& notice, std::ostream* out) {
  *out << "notice " << static_cast<int>(notice.kind) << " node " << int{notice.node} << std::hex << " code 0x"
       << notice.code << std::dec;
}

}  // namespace axisgate::bus

namespace axisgate::test {

using namespace std::chrono_literals;
using ByteRow = std::vector<Byte>;

/// "01 2B 40" to bytes.
inline ByteRow from_hex(std::string_view hex) {
  ByteRow bytes;
  for (std::size_t at = 0; at + 1 < hex.size(); at += 3) {
    bytes.push_back(static_cast<Byte>(std::stoi(std::string(hex.substr(at, 2)), nullptr, 16)));
  }
  return bytes;
}

inline ByteRow operator+(ByteRow a, const ByteRow& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

template <std::size_t size>
ByteRow row(const std::array<Byte, size>& bytes) {
  return {bytes.begin(), bytes.end()};
}

inline bus::Exchange read_of(std::uint16_t index, std::uint8_t sub = 0, std::uint8_t byte = 0, std::uint8_t size = 0,
                             std::uint8_t node = 1) {
  bus::Exchange exchange;
  exchange.node = node;
  exchange.object = {index, sub, byte};
  exchange.size = size;
  return exchange;
}
/// Motor A at byte 0, motor B behind it, `size` bytes each.
inline bus::Exchange pair_of(std::uint16_t index, std::uint8_t sub = 0, std::uint8_t size = 2, std::uint8_t node = 1) {
  bus::Exchange exchange = read_of(index, sub, 0, size, node);
  exchange.more.push_back({{index, sub, size}, size});
  return exchange;
}
inline bus::Exchange write_of(std::uint16_t index, std::uint8_t sub, std::int32_t value, std::uint8_t node = 1) {
  bus::Exchange exchange = read_of(index, sub, 0, 4, node);
  exchange.access = bus::Access::write;
  exchange.raw = static_cast<std::uint32_t>(value);
  return exchange;
}
/// The whole control frame of the serial protocols.
inline bus::Exchange control_of(bool on_a, bool on_b, std::int32_t a, std::int32_t b, std::uint8_t node = 1) {
  bus::Exchange exchange = write_of(keya::kValueIndex, 2, b, node);
  exchange.more.push_back({{keya::kOnIndex, 1}, 1, on_a ? 1U : 0U});
  exchange.more.push_back({{keya::kValueIndex, 1}, 4, static_cast<std::uint32_t>(a)});
  exchange.more.push_back({{keya::kOnIndex, 2}, 1, on_b ? 1U : 0U});
  return exchange;
}

inline bus::ExchangeResult value_of(std::uint16_t index, std::uint8_t sub, std::uint8_t size, std::uint32_t raw) {
  bus::ExchangeResult result;
  result.fields.push_back({{index, sub}, size, raw});
  return result;
}
inline bus::ExchangeResult pair_value(std::uint16_t index, std::uint8_t sub, std::uint32_t a, std::uint32_t b,
                                      std::uint8_t size = 2) {
  bus::ExchangeResult result = value_of(index, sub, size, a);
  result.fields.push_back({{index, sub, size}, size, b});
  return result;
}
inline bus::ExchangeResult refusal_with(std::uint32_t code) {
  bus::ExchangeResult result;
  result.code = Errc::refused_by_drive;
  result.detail = code;
  return result;
}

/// What both wires tell the bus.
class Listener : public bus::WireEvents {
 public:
  void on_wire_up() override { told.emplace_back("up"); }
  void on_wire_down(std::string_view why) override { told.push_back("down: " + std::string(why)); }
  void on_reply(const bus::ExchangeResult& result) override {
    told.emplace_back("reply");
    replies.push_back(result);
    if (then_send) then_send();
  }
  void on_notice(const bus::Notice& notice) override {
    told.emplace_back("notice");
    notices.push_back(notice);
  }
  [[nodiscard]] std::vector<bus::Notice::Kind> kinds() const {
    std::vector<bus::Notice::Kind> all;
    for (const bus::Notice& notice : notices) all.push_back(notice.kind);
    return all;
  }

  std::vector<std::string> told;
  std::vector<bus::ExchangeResult> replies;
  std::vector<bus::Notice> notices;
  std::function<void()> then_send;  ///< from inside each reply, as the bus does
};

}  // namespace axisgate::test
