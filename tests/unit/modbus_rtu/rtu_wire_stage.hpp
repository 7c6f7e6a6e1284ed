// A Modbus RTU wire on a line whose far end is the test.
#pragma once

#include "adapters/modbus_rtu/rtu_wire.hpp"
#include "tests/unit/modbus_rtu/rtu_frames.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {

using namespace std::chrono_literals;

class ScriptedRtuLink final : public modbus_rtu::RtuLink {
 public:
  void start(modbus_rtu::RtuLinkEvents& to) override { events = &to; }
  void transmit(modbus_rtu::ExchangeNumber number, Bytes frame) override {
    newest = number;
    sent.push_back(hex_text(frame));
  }
  void withdraw(modbus_rtu::ExchangeNumber number) override { withdrawn.push_back(number); }
  void reopen(std::string_view why) override {
    reopened.emplace_back(why);
    events->on_link_down(why);
    if (opens_again) events->on_link_up();
  }
  /// Heard after the newest frame was sent.
  void bring(std::string_view frame) { bring(newest, frame); }
  void bring(modbus_rtu::ExchangeNumber number, std::string_view frame) { events->on_frame(number, from_hex(frame)); }

  modbus_rtu::RtuLinkEvents* events = nullptr;
  modbus_rtu::ExchangeNumber newest = 0;
  std::vector<std::string> sent;
  std::vector<modbus_rtu::ExchangeNumber> withdrawn;
  std::vector<std::string> reopened;
  bool opens_again = true;
};

class RtuWireStage : public testing::Test, protected bus::WireEvents {
 protected:
  RtuWireStage() {
    auto made = std::make_unique<ScriptedRtuLink>();
    link = made.get();
    wire = std::make_unique<modbus_rtu::RtuWire>(
        "lift", std::vector{kinco_node(1), stepper_node(2), modbus_rtu::RtuNode{.node = 3}},
        modbus_rtu::LineSpeed{.baud = 19200, .parity_bits = 0}, std::move(made), runtime, log);
    wire->start(*this);
    link->events->on_link_up();
    told.clear();
  }
  void on_wire_up() override { told.emplace_back("up"); }
  void on_wire_down(std::string_view why) override { told.push_back("down: " + std::string(why)); }
  void on_reply(const bus::ExchangeResult& result) override {
    told.emplace_back("reply");
    replies.push_back(result);
    if (next) wire->send(*std::exchange(next, std::nullopt));
  }

  std::vector<std::string> told;
  std::vector<bus::ExchangeResult> replies;
  std::optional<bus::Exchange> next;  ///< sent from inside the next reply, as the bus does
  std::vector<std::string> log_lines;
  Log log{[this](LogLevel, std::string_view source, std::string_view message) {
    log_lines.push_back(std::string(source) + ": " + std::string(message));
  }};
  ManualRuntime runtime;
  ScriptedRtuLink* link = nullptr;
  std::unique_ptr<modbus_rtu::RtuWire> wire;
};

}  // namespace axisgate::test
