// A CANopen wire on a bus whose other nodes are the test.
#pragma once

#include "adapters/canopen/canopen_wire.hpp"
#include "tests/unit/canopen/canopen_frames.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {

class ScriptedCanLink final : public can::CanLink {
 public:
  void start(can::CanLinkEvents& to, std::vector<can::CanFilter> only) override {
    events = &to;
    filters = std::move(only);
  }
  void send(const CanFrame& frame, bool urgent) override {
    sent.push_back(frame);
    if (urgent) urgent_sent.push_back(frame);
  }
  [[nodiscard]] const can::CanTrouble& trouble() const override { return troubles; }

  can::CanLinkEvents* events = nullptr;
  std::vector<can::CanFilter> filters;
  std::vector<CanFrame> sent;
  std::vector<CanFrame> urgent_sent;
  can::CanTrouble troubles;
};

class CanopenWireStage : public testing::Test, protected bus::WireEvents {
 protected:
  CanopenWireStage() { begin({.name = "can0", .nodes = {{.node = 1}, {.node = 2}}}); }

  /// Link up; what went out for that is forgotten.
  void begin(canopen::CanopenSettings settings) {
    wire.reset();
    auto made = std::make_unique<ScriptedCanLink>();
    link = made.get();
    wire = canopen::make_canopen_wire(std::move(settings), std::move(made), runtime, log);
    wire->start(*this);
    link->events->on_link_up();
    runtime.run_due();
    clear();
  }
  void clear() {
    link->sent.clear();
    told.clear();
    notices.clear();
    replies.clear();
  }
  void bring(std::uint32_t id, std::string_view hex) { bring(frame_of(id, hex)); }
  void bring(const CanFrame& frame) { link->events->on_frame(frame, runtime.now()); }

  void on_wire_up() override { told.emplace_back("up"); }
  void on_wire_down(std::string_view why) override { told.push_back("down: " + std::string(why)); }
  void on_reply(const bus::ExchangeResult& result) override {
    told.emplace_back("reply");
    replies.push_back(result);
    if (next) wire->send(*std::exchange(next, std::nullopt));
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
  std::optional<bus::Exchange> next;  ///< sent from inside the next reply, as the bus does
  std::vector<std::string> log_lines;
  Log log{[this](LogLevel, std::string_view source, std::string_view message) {
    log_lines.push_back(std::string(source) + ": " + std::string(message));
  }};
  ManualRuntime runtime;
  ScriptedCanLink* link = nullptr;
  std::unique_ptr<bus::Wire> wire;
};

}  // namespace axisgate::test
