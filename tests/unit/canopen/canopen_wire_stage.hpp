// SPDX-License-Identifier: Apache-2.0
// A CANopen wire on a bus whose other nodes are the test.
#pragma once

#include "adapters/canopen/canopen_wire.hpp"
#include "tests/unit/bus/scripted_links.hpp"
#include "tests/unit/canopen/canopen_frames.hpp"

namespace axisgate::test {

class CanopenWireStage : public WireStage {
 protected:
  CanopenWireStage() { begin({.name = "can0", .nodes = {{.node = 1}, {.node = 2}}}); }

  /// Not yet up.
  void make(canopen::CanopenSettings settings) {
    wire.reset();
    auto made = std::make_unique<ScriptedCanLink>();
    link = made.get();
    wire = canopen::make_canopen_wire(std::move(settings), std::move(made), runtime, log);
    wire->start(*this);
  }
  /// Link up; what went out for that is forgotten.
  void begin(canopen::CanopenSettings settings) {
    make(std::move(settings));
    link->events->on_link_up();
    runtime.run_due();
    clear();
  }
  void clear() {
    link->sent.clear();
    forget();
  }
  void bring(std::uint32_t id, std::string_view hex) { bring(frame_of(id, hex)); }
  void bring(const CanFrame& frame) { link->events->on_frame(frame, runtime.now()); }
  /// The same frame, so many times, with a pause behind each.
  void flood(std::uint32_t id, std::string_view hex, int frames, Duration pause = {}) {
    for (int i = 0; i < frames; ++i, runtime.advance_by(pause)) bring(id, hex);
  }
  [[nodiscard]] auto count(bus::UnsolicitedEvent::Kind kind) const { return std::ranges::count(kinds(), kind); }

  ScriptedCanLink* link = nullptr;
};

}  // namespace axisgate::test
