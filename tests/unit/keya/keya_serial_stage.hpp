// A Keya serial wire on a line whose far end is the test.
#pragma once

#include "adapters/keya/keya_serial_wire.hpp"
#include "tests/unit/keya/keya_frames.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {

using keya::KeyaLine;

// Answers of the drive, as the manual prints them.
inline constexpr std::string_view kSpeed232 = "ED 02 01 F5 FE 0E 00 00 00 00 00 00";
inline constexpr std::string_view kVoltage232 = "ED 05 31 00 00 00 00 00 00 00 00 00";
inline constexpr std::string_view kBeat232 = "EE 01 F4 08 01 22 31 02 58 00 00 99";
inline constexpr std::string_view kSpeed485 = "ED 01 02 01 F5 FE 0E 00 00 00 00 F2";
inline constexpr std::string_view kVoltage485 = "ED 01 05 31 00 00 00 00 00 00 00 24";
inline constexpr std::string_view kFaults485 = "ED 01 07 08 01 00 01 00 00 00 00 FF";

inline bus::Exchange speeds_of(std::uint8_t node = 1) { return pair_of(0x2102, 0, 2, node); }
inline const bus::ExchangeResult kSpeeds = pair_value(0x2102, 0, 501, 0xFE0E);

class ScriptedLink final : public bus::ByteLink {
 public:
  void start(bus::ByteLinkEvents& to) override { events = &to; }
  void send(Bytes bytes) override { sent.push_back(hex_text(bytes)); }
  void reopen(std::string_view why) override {
    reopened.emplace_back(why);
    events->on_link_down(why);
    events->on_link_up();
  }
  void bring(Bytes bytes) { events->on_bytes(bytes); }

  bus::ByteLinkEvents* events = nullptr;
  std::vector<std::string> sent;
  std::vector<std::string> reopened;
};

class KeyaSerialStage : public testing::Test {
 protected:
  KeyaSerialStage() { begin(KeyaLine::rs485); }

  /// A new wire, its link up.
  void begin(KeyaLine line, std::uint32_t baud = 115200) {
    wire.reset();
    auto made = std::make_unique<ScriptedLink>();
    link = made.get();
    wire = keya::make_keya_serial_wire({.name = "belt", .line = line, .baud = baud}, std::move(made), runtime, log);
    wire->start(bus);
    link->events->on_link_up();
    bus.told.clear();
    bus.replies.clear();
    bus.notices.clear();
  }
  void bring(std::string_view hex) { link->bring(from_hex(hex)); }

  Listener bus;
  std::vector<std::string> log_lines;
  Log log{[this](LogLevel, std::string_view source, std::string_view message) {
    log_lines.push_back(std::string(source) + ": " + std::string(message));
  }};
  ManualRuntime runtime;
  ScriptedLink* link = nullptr;
  std::unique_ptr<bus::Wire> wire;
};

}  // namespace axisgate::test
