// SPDX-License-Identifier: Apache-2.0
// Keya's frames in the notation of the manual, exchanges, and stages with a Keya wire on them.
#pragma once

#include "adapters/keya/keya_can_exchange.hpp"
#include "adapters/keya/keya_can_wire.hpp"
#include "adapters/keya/keya_fields.hpp"
#include "adapters/keya/keya_serial_exchange.hpp"
#include "adapters/keya/keya_serial_wire.hpp"
#include "adapters/keya/keya_text.hpp"
#include "tests/unit/bus/scripted_links.hpp"

namespace axisgate::keya {

inline void PrintTo(const SerialFrame& frame, std::ostream* out) {
  *out << "node " << int{frame.node} << " start " << std::hex << int{frame.start} << std::dec << " "
       << describe_answer(KeyaLine::rs485, frame);
}

}  // namespace axisgate::keya

namespace axisgate::test {

using keya::KeyaLine;

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
inline bus::ExchangeResult pair_value(std::uint16_t index, std::uint8_t sub, std::uint32_t a, std::uint32_t b) {
  bus::ExchangeResult result = value_of(index, 2, a, sub);
  result.fields.push_back({{index, sub, 2}, 2, b});
  return result;
}

// Answers of a serial drive, as the manual prints them.
inline constexpr std::string_view kSpeed232 = "ED 02 01 F5 FE 0E 00 00 00 00 00 00";
inline constexpr std::string_view kBeat232 = "EE 01 F4 08 01 22 31 02 58 00 00 99";
inline constexpr std::string_view kSpeed485 = "ED 01 02 01 F5 FE 0E 00 00 00 00 F2";
inline constexpr std::string_view kVoltage485 = "ED 01 05 31 00 00 00 00 00 00 00 24";
inline constexpr std::string_view kFaults485 = "ED 01 07 08 01 00 01 00 00 00 00 FF";

inline bus::Exchange speeds_of(std::uint8_t node = 1) { return pair_of(0x2102, 0, 2, node); }
inline const bus::ExchangeResult kSpeeds = pair_value(0x2102, 0, 501, 0xFE0E);

inline can::CanFrame extended(std::uint32_t id, std::string_view hex) {
  return keya::extended_frame(id, from_hex(hex));
}

class KeyaStage : public WireStage {
 protected:
  /// Each is sent; none goes out, and its refusal is told in the next turn.
  void expect_refusals(const std::vector<std::pair<bus::Exchange, std::uint32_t>>& cases) {
    for (const auto& [exchange, code] : cases) {
      replies.clear();
      wire->send(exchange);
      EXPECT_THAT(replies, testing::IsEmpty()) << "never from inside send()";
      runtime.run_due();
      EXPECT_THAT(replies, testing::ElementsAre(refusal_of(code)));
    }
  }
};

/// On a bus whose drives are the test.
class KeyaCanStage : public KeyaStage {
 protected:
  static constexpr std::uint32_t kReply1 = 0x05800001;

  KeyaCanStage() {
    auto made = std::make_unique<ScriptedCanLink>();
    link = made.get();
    wire = keya::make_keya_can_wire({.name = "can1", .nodes = {1, 2}}, std::move(made), runtime, log);
    wire->start(*this);
    link->events->on_link_up();
    forget();
  }
  void bring(std::uint32_t id, std::string_view hex) { bring(extended(id, hex)); }
  void bring(const can::CanFrame& frame) { link->events->on_frame(frame, runtime.now()); }

  ScriptedCanLink* link = nullptr;
};

/// On a line whose far end is the test.
class KeyaSerialStage : public KeyaStage {
 protected:
  KeyaSerialStage() { begin(KeyaLine::rs485); }
  /// A new wire, its link up.
  void begin(KeyaLine line, std::uint32_t baud = 115200) {
    wire.reset();
    auto made = std::make_unique<ScriptedLink>();
    link = made.get();
    wire = keya::make_keya_serial_wire({.name = "belt", .line = line, .baud = baud}, std::move(made), runtime, log);
    wire->start(*this);
    link->events->on_link_up();
    forget();
  }
  void bring(std::string_view hex) { link->bring(hex); }

  ScriptedLink* link = nullptr;
};

}  // namespace axisgate::test
