// SPDX-License-Identifier: Apache-2.0
// Property: whatever frames come, nothing crashes, and no request ends that the frame did not answer. A second opinion
// on which frame answers what is kept here, from the standard's tables, apart from the codec's.
#include "gateway/core/random.hpp"
#include "tests/unit/canopen/canopen_wire_stage.hpp"

namespace axisgate::test {
namespace {

class CanopenProperty : public CanopenWireStage, public testing::WithParamInterface<std::uint64_t> {
 protected:
  static constexpr int kSteps = 20'000;

  CanopenProperty() : random(GetParam()) {
    begin({.name = "can0",
           .own_heartbeat = 100ms,
           .nodes = {{.node = 1, .heartbeat = 200ms, .sdo_block = true}, {.node = 2, .guard_time = 100ms}}});
    wire->map_process_data(1, 1, {{{0x6041, 0}, 2}});
  }

  std::uint8_t any_node() { return static_cast<std::uint8_t>(1 + random.below(2)); }
  std::uint16_t any_index() { return static_cast<std::uint16_t>(0x2000 + random.below(3)); }
  bus::Exchange any_exchange() {
    switch (random.below(5)) {
      case 0:
        return read_of(any_index(), 0, 0, any_node());
      case 1:
        return write_of(any_index(), 1, 2, any_node());
      case 2:
        return long_read_of(any_index(), 0, any_node());
      case 3:
        return long_write_of(any_index(), content_of(1 + random.below(60)), any_node());
      default:
        return nmt_of(0x80, any_node());
    }
  }
  /// Frames that are nearly what is waited for.
  CanFrame any_frame() {
    static constexpr std::array<std::uint32_t, 8> kIds{0x081, 0x181, 0x481, 0x581, 0x581, 0x582, 0x582, 0x701};
    static constexpr std::array<Byte, 18> kCommands{0x43, 0x4B, 0x4F, 0x41, 0x60, 0x20, 0x30, 0x00, 0x10,
                                                    0x01, 0x80, 0xA4, 0xA2, 0xA1, 0xC6, 0xC1, 0x8F, 0xFF};
    ByteRow bytes(random.chance(4, 5) ? 8 : random.below(9));
    for (Byte& byte : bytes) byte = static_cast<Byte>(random.next());
    if (!bytes.empty() && random.chance(3, 4)) bytes[0] = kCommands.at(random.below(kCommands.size()));
    if (bytes.size() > 3 && random.chance(3, 4)) {
      store_le16(bytes, 1, any_index());
      bytes[3] = 0;
    }
    return can::data_frame(kIds.at(random.below(kIds.size())), bytes);
  }
  /// By the standard: may this frame be the last one of that exchange?
  /// `begun`: a short object was said to come in a segment.
  static bool may_end(const CanFrame& frame, const bus::Exchange& exchange, bool begun) {
    if (frame.id != 0x580U + exchange.node || frame.size == 0) return false;
    const Byte command = frame.data[0];
    const unsigned specifier = command >> 5;
    const bool names_object =
        frame.size >= 4 && load_le16(frame.data, 1) == exchange.object.index && frame.data[3] == exchange.object.sub;
    if (specifier == 4 && names_object && frame.size == 8) return true;
    const bool write = exchange.access == bus::Access::write;
    if (exchange.part == bus::Part::next) {
      // A segment, the end of a block, or what ends blocks: none of them names the object.
      return write ? specifier == 1 || specifier == 5 : specifier == 0 || specifier == 4 || specifier == 6;
    }
    if (begun && specifier == 0) return true;
    if (!names_object) return false;
    return write ? specifier == 3 || specifier == 5 : specifier == 2 || specifier == 6;
  }

  /// In answer to that exchange it says that segments follow.
  static bool begins_segments(const CanFrame& frame, const bus::Exchange& exchange) {
    return frame.id == 0x580U + exchange.node && frame.size >= 4 && (frame.data[0] & 0xE2) == 0x40 &&
           load_le16(frame.data, 1) == exchange.object.index && exchange.access == bus::Access::read &&
           exchange.part == bus::Part::whole;
  }

  Random random;
};

TEST_P(CanopenProperty, random_frames_end_no_request_that_they_do_not_answer) {
  std::optional<bus::Exchange> outstanding;
  bool begun = false;
  int ended = 0;
  for (int step = 0; step < kSteps; ++step) {
    const std::size_t before = replies.size();
    if (!outstanding) {
      outstanding = any_exchange();
      begun = false;
      wire->send(*outstanding);
      ASSERT_EQ(replies.size(), before) << "nothing ends inside send()";
    }
    const CanFrame frame = any_frame();
    bring(frame);
    ASSERT_LE(replies.size(), before + 1);
    if (replies.size() > before) {
      ASSERT_NE(outstanding->access, bus::Access::command);
      ASSERT_TRUE(may_end(frame, *outstanding, begun)) << testing::PrintToString(frame);
      const bool goes_on = replies.back().more;
      outstanding = goes_on && random.chance(3, 4) ? std::optional(next_of(*outstanding)) : std::nullopt;
      if (outstanding) wire->send(*outstanding);
      ++ended;
    } else if (begins_segments(frame, *outstanding)) {
      begun = true;
    } else if (frame.id == 0x701 && frame.size > 0 && frame.data[0] == 0 && outstanding->node == 1) {
      wire->abandon();  // as the bus does for a node that has started anew
      outstanding.reset();
    }
    if (random.chance(1, 20)) {
      // What nobody answers ends now: commands, and the next part of a chain that a restart has ended.
      const std::size_t before_time = replies.size();
      runtime.advance_by(std::chrono::milliseconds(random.below(50)));
      if (replies.size() > before_time) outstanding.reset();
    }
    if (outstanding && random.chance(1, 30)) {
      wire->abandon();
      outstanding.reset();
    }
  }
  EXPECT_GT(ended, 100) << "the frames are too strange to prove anything";
  EXPECT_LT(unsolicited_events.size(), static_cast<std::size_t>(kSteps));
}

INSTANTIATE_TEST_SUITE_P(Seeds, CanopenProperty, testing::Range<std::uint64_t>(1, 9));

}  // namespace
}  // namespace axisgate::test
