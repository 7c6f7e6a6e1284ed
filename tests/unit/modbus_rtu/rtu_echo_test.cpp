// SPDX-License-Identifier: Apache-2.0
// Modbus RTU on an adapter that hears itself: no echo acknowledges a write, and a drive's answer does.
#include "adapters/modbus_rtu/rtu_wire.hpp"
#include "tests/unit/bus/scripted_links.hpp"
#include "tests/unit/modbus_rtu/rtu_frames.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr const char* kRead = "01 03 32 00 00 01";
constexpr const char* kValue = "01 03 02 C0 37";
constexpr const char* kStopped = "01 06 31 00 00 0B";

class RtuEcho : public WireStage {
 protected:
  RtuEcho() {
    auto made = std::make_unique<ScriptedRtuLink>();
    link = made.get();
    wire = std::make_unique<modbus_rtu::RtuWire>("lift", std::vector{kinco_node(1)},
                                                 modbus_rtu::LineSpeed{.baud = 19200, .parity_bits = 0},
                                                 std::move(made), runtime, log);
    wire->start(*this);
    link->events->on_link_up();
    forget();
  }
  void read(bool comes_back, bool answered = true) {
    wire->send(read_of(0x3200));
    runtime.advance_by(5ms);
    if (comes_back) link->bring(kRead);
    runtime.advance_by(12ms);
    if (answered) {
      link->bring(kValue);
    } else {
      wire->abandon();
      runtime.advance_by(10s);
    }
  }
  void stop() { wire->send(write_of(0x3100, 0x0B, 2)); }
  [[nodiscard]] std::uint32_t echoes() const { return wire->statistics().echoes; }
  ScriptedRtuLink* link = nullptr;
};

TEST_F(RtuEcho, never_acknowledges_a_stop_and_the_drives_own_answer_does) {
  for (int i = 0; i < 3; ++i) read(true);
  forget();
  stop();
  link->bring(kStopped);
  EXPECT_THAT(replies, IsEmpty());
  runtime.advance_by(15ms);
  link->bring(kStopped);
  EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{}));
  EXPECT_EQ(echoes(), 4u);
}

TEST_F(RtuEcho, of_a_line_that_is_opened_anew_nothing_is_known) {
  read(false);
  link->events->on_link_down("pulled");
  link->events->on_link_up();
  forget();
  stop();
  link->bring(kStopped);
  EXPECT_THAT(replies, IsEmpty()) << "it may be another adapter";
}

}  // namespace
}  // namespace axisgate::test
