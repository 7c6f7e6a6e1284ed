// A Keya CAN wire on a bus whose drives are the test.
#pragma once

#include "adapters/keya/keya_can_wire.hpp"
#include "tests/unit/keya/keya_frames.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {

class ScriptedCanLink final : public can::CanLink {
 public:
  void start(can::CanLinkEvents& to, std::vector<can::CanFilter> only) override {
    events = &to;
    filters = std::move(only);
  }
  void send(const can::CanFrame& frame, bool /*urgent*/) override { sent.push_back(frame); }
  [[nodiscard]] const can::CanTrouble& trouble() const override { return troubles; }

  can::CanLinkEvents* events = nullptr;
  std::vector<can::CanFilter> filters;
  std::vector<can::CanFrame> sent;
  can::CanTrouble troubles;
};

inline can::CanFrame extended(std::uint32_t id, std::string_view hex) {
  return keya::extended_frame(id, from_hex(hex));
}

class KeyaCanStage : public testing::Test {
 protected:
  KeyaCanStage() {
    auto made = std::make_unique<ScriptedCanLink>();
    link = made.get();
    wire = keya::make_keya_can_wire({.name = "can1", .nodes = {1, 2}}, std::move(made), runtime, log);
    wire->start(bus);
    link->events->on_link_up();
    bus.told.clear();
  }
  void bring(std::uint32_t id, std::string_view hex) { bring(extended(id, hex)); }
  void bring(const can::CanFrame& frame) { link->events->on_frame(frame, runtime.now()); }

  Listener bus;
  std::vector<std::string> log_lines;
  Log log{[this](LogLevel, std::string_view source, std::string_view message) {
    log_lines.push_back(std::string(source) + ": " + std::string(message));
  }};
  ManualRuntime runtime;
  ScriptedCanLink* link = nullptr;
  std::unique_ptr<bus::Wire> wire;
};

}  // namespace axisgate::test
