// A Kinco wire on a line whose far end is the test.
#pragma once

#include "adapters/kinco/kinco_wire.hpp"
#include "tests/unit/kinco/kinco_frames.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {

using namespace std::chrono_literals;

class ScriptedLink final : public bus::ByteLink {
 public:
  void start(bus::ByteLinkEvents& to) override { events = &to; }
  void send(Bytes bytes) override { sent.push_back(hex_text(bytes)); }
  void reopen(std::string_view why) override {
    reopened.emplace_back(why);
    events->on_link_down(why);
    if (opens_again) events->on_link_up();
  }
  void bring(const ByteRow& bytes) { events->on_bytes(bytes); }

  bus::ByteLinkEvents* events = nullptr;
  std::vector<std::string> sent;
  std::vector<std::string> reopened;
  bool opens_again = true;
};

class KincoWireStage : public testing::Test, protected bus::WireEvents {
 protected:
  KincoWireStage() {
    auto made = std::make_unique<ScriptedLink>();
    link = made.get();
    wire = std::make_unique<kinco::KincoWire>("lift", std::move(made), runtime, log);
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
  ScriptedLink* link = nullptr;
  std::unique_ptr<kinco::KincoWire> wire;
};

}  // namespace axisgate::test
