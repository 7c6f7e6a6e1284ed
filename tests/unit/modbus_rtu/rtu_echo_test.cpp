// SPDX-License-Identifier: Apache-2.0
// Modbus RTU on an adapter that hears itself: no echo acknowledges a write, and a drive's answer does.
#include "adapters/modbus_rtu/rtu_wire.hpp"
#include "tests/unit/bus/scripted_links.hpp"
#include "tests/unit/modbus_rtu/rtu_frames.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

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

TEST_F(RtuEcho, reads_are_answered_from_the_first_on_and_their_copies_counted) {
  for (int i = 0; i < 5; ++i) read(true);
  EXPECT_THAT(replies, SizeIs(5));
  EXPECT_EQ(echoes(), 5u);
  EXPECT_EQ(wire->statistics().bad_frames + wire->statistics().late_replies, 0u);
}

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

TEST_F(RtuEcho, while_it_is_not_known_the_copy_of_a_write_acknowledges_nothing_and_the_next_read_decides) {
  stop();
  link->bring(kStopped);
  EXPECT_THAT(replies, IsEmpty());
  EXPECT_EQ(echoes(), 0u);
  wire->abandon();
  runtime.advance_by(10s);
  read(false);
  forget();
  stop();
  link->bring(kStopped);
  EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{})) << "the line has no echo";
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

TEST_F(RtuEcho, of_a_long_write_is_no_answer_whatever_is_known) {
  read(false);
  forget();
  wire->send(write_of(0x6F00, 0x00085555, 4));
  link->bring(link->sent.back());
  EXPECT_THAT(replies, IsEmpty());
  link->bring("01 10 6F 00 00 02");
  EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{}));
}

TEST_F(RtuEcho, a_glitch_is_counted_in_bytes_and_is_no_bad_frame) {
  link->events->on_glitch(3);
  EXPECT_EQ(wire->statistics().dropped_bytes, 3u);
  EXPECT_EQ(wire->statistics().bad_frames, 0u);
}

TEST_F(RtuEcho, a_whole_frame_that_does_not_fit_is_told_with_what_was_asked_and_what_came_once_a_minute) {
  wire->send(read_of(0x3200));
  for (int i = 0; i < 10; ++i) link->bring("01 03 04 00 01 00 02");
  EXPECT_THAT(log_lines,
              ElementsAre("bus lift: a valid frame that does not fit: asked was \"unit 1: read 1 register at 12800 "
                          "(0x3200)\", what came is \"unit 1: 2 registers = 0x0001 0x0002\" (another length)"));
}

}  // namespace
}  // namespace axisgate::test
