// SPDX-License-Identifier: Apache-2.0
// What the tests of all wires share: bytes in the notation of the manuals, results, printers that make a failure
// readable, and a stage with a wire on it that hears the wire as the bus does.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/bus/wire.hpp"
#include "gateway/core/log.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::bus {

inline void PrintTo(const ExchangeResult& result, std::ostream* out) {
  *out << text(result.code) << std::hex << " detail 0x" << result.detail;
  for (const ReplyField& field : result.fields) {
    *out << " " << field.object.index << ":" << int{field.object.sub} << "+" << int{field.object.byte} << "=0x"
         << field.raw << "/" << int{field.size};
  }
  if (result.bytes) *out << std::dec << " " << result.bytes->size() << " bytes";
  *out << std::dec << (result.more ? " more" : "") << (result.for_now ? " for now" : "");
}

inline void PrintTo(const UnsolicitedEvent& unsolicited, std::ostream* out) {
  static constexpr std::array kKinds{"started", "present", "gone", "values", "emergency", "duplicate_node", "babbling"};
  *out << kKinds.at(static_cast<std::size_t>(unsolicited.kind)) << " node " << int{unsolicited.node} << " state "
       << static_cast<int>(unsolicited.state) << std::hex << " code 0x" << unsolicited.code << std::dec << " repeats "
       << unsolicited.repeats << " fields " << unsolicited.fields.size();
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
inline bus::ExchangeResult value_of(std::uint16_t index, std::uint8_t size, std::uint32_t raw, std::uint8_t sub = 0) {
  bus::ExchangeResult result;
  result.fields.push_back({{index, sub}, size, raw});
  return result;
}
inline bus::ExchangeResult refusal_of(std::uint32_t code, bool for_now = false) {
  bus::ExchangeResult result;
  result.code = Errc::refused_by_drive;
  result.detail = code;
  result.for_now = for_now;
  return result;
}

class WireStage : public testing::Test, protected bus::WireEvents {
 protected:
  void on_wire_up() override { told.emplace_back("up"); }
  void on_wire_down(std::string_view why) override { told.push_back("down: " + std::string(why)); }
  void on_reply(const bus::ExchangeResult& result) override {
    told.emplace_back("reply");
    replies.push_back(result);
    if (next) wire->send(*std::exchange(next, std::nullopt));
  }
  void on_unsolicited(const bus::UnsolicitedEvent& unsolicited) override {
    told.emplace_back("unsolicited");
    unsolicited_events.push_back(unsolicited);
  }
  void forget() {
    told.clear();
    replies.clear();
    unsolicited_events.clear();
  }
  [[nodiscard]] std::vector<bus::UnsolicitedEvent::Kind> kinds() const {
    std::vector<bus::UnsolicitedEvent::Kind> all;
    for (const bus::UnsolicitedEvent& unsolicited : unsolicited_events) all.push_back(unsolicited.kind);
    return all;
  }

  std::vector<std::string> told;
  std::vector<bus::ExchangeResult> replies;
  std::vector<bus::UnsolicitedEvent> unsolicited_events;
  std::optional<bus::Exchange> next;  ///< sent from inside the next reply, as the bus does
  std::vector<std::string> log_lines;
  Log log{[this](LogLevel, std::string_view source, std::string_view message) {
    log_lines.push_back(std::string(source) + ": " + std::string(message));
  }};
  ManualRuntime runtime;
  std::unique_ptr<bus::Wire> wire;
};

}  // namespace axisgate::test
