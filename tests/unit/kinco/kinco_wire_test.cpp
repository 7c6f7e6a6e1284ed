// SPDX-License-Identifier: Apache-2.0
// Kinco's wire: what it says in its own way. What it shares with other wires is in tests/unit/bus/wire_rules_test.cpp.
#include "adapters/kinco/kinco_wire.hpp"

#include "tests/unit/bus/scripted_links.hpp"
#include "tests/unit/kinco/kinco_frames.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class KincoWireTest : public WireStage {
 protected:
  KincoWireTest() {
    auto made = std::make_unique<ScriptedLink>();
    link = made.get();
    wire = std::make_unique<kinco::KincoWire>("lift", std::move(made), runtime, log);
    wire->start(*this);
    link->events->on_link_up();
  }
  ScriptedLink* link = nullptr;
};

TEST_F(KincoWireTest, reports_an_answer_as_it_came_also_byte_by_byte_behind_its_echo_and_of_another_width) {
  wire->send(read_of(0x6041, 0, 4));
  EXPECT_THAT(link->sent, ElementsAre(kReadStatus));
  for (const Byte byte : from_hex(kReadStatus) + from_hex(kStatusReply)) link->bring(ByteRow{byte});
  EXPECT_THAT(replies, ElementsAre(value_of(0x6041, 2, 0xC037))) << "the profile's type decides what that means";
}

TEST_F(KincoWireTest, decodes_every_frame_into_the_log_when_asked) {
  wire->send(read_of(0x6041));
  link->bring(kStatusReply);
  EXPECT_THAT(log_lines, IsEmpty());
  wire->set_decode(true);
  wire->send(write_of(0x6040, 0x0F, 2));
  link->bring(from_hex(kWriteControl) + from_hex(kStatusReply) + from_hex("FF FF 01 60 40 60 00 0F 00 00 00 F0"));
  EXPECT_THAT(log_lines, ElementsAre("bus lift: -> 01 2B 40 60 00 0F 00 00 00 25  write 6040.00 = 0x000F",
                                     "bus lift: <- 01 2B 40 60 00 0F 00 00 00 25  write 6040.00 = 0x000F  (echo)",
                                     "bus lift: <- 01 4B 41 60 00 37 C0 00 00 1C  value 6041.00 = 0xC037  (late)",
                                     "bus lift: <- 01 60 40 60 00 0F 00 00 00 F0  written 6040.00",
                                     "bus lift: <- skipped 2 bytes"));
}

}  // namespace
}  // namespace axisgate::test
