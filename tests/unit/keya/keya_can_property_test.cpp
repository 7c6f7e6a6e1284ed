// SPDX-License-Identifier: Apache-2.0
// Property: whatever frames come, a reply is told once, and only for a frame that says all that was asked for.
#include "gateway/core/random.hpp"
#include "tests/unit/keya/keya_frames.hpp"

namespace axisgate::test {
namespace {

class KeyaCanProperty : public KeyaCanStage {
 protected:
  std::uint8_t one_of(std::initializer_list<std::uint8_t> values) {
    return random.chance(1, 6) ? static_cast<std::uint8_t>(random.below(256))
                               : *(values.begin() + random.below(values.size()));
  }
  can::CanFrame any_frame() {
    static constexpr std::array<std::uint32_t, 4> kIds{keya::kReplyId, keya::kReplyId, keya::kHeartbeatId,
                                                       keya::kCommandId};
    can::CanFrame frame =
        keya::extended_frame(kIds.at(random.below(4)) + one_of({1, 1, 2, 3}), ByteRow(random.chance(1, 8) ? 5 : 8));
    frame.extended = !random.chance(1, 20);
    if (!frame.extended) frame.id &= can::kMaxStandardId;
    frame.remote = random.chance(1, 20);
    if (frame.remote) return frame;
    const std::array<Byte, 4> head{one_of({0x60, 0x60, 0x60, 0x40, 0x23}), one_of({0x00, 0x03, 0x0D}),
                                   one_of({0x20, 0x21}), one_of({0, 1, 2})};
    std::ranges::copy(head, frame.data.begin());
    for (std::size_t i = 4; i < frame.size; ++i) frame.data.at(i) = static_cast<Byte>(random.below(256));
    return frame;
  }
  bus::Exchange any_exchange() {
    const auto sub = static_cast<std::uint8_t>(1 + random.below(2));
    const auto node = static_cast<std::uint8_t>(1 + random.below(2));
    return random.chance(1, 2) ? write_of(random.chance(1, 2) ? 0x2000 : 0x200D, sub, 7, node)
                               : read_of(random.chance(1, 2) ? 0x2100 : 0x2103, sub, 0, 0, node);
  }
  static bool answers(const can::CanFrame& frame, const bus::Exchange& asked) {
    const bool write = asked.access == bus::Access::write;
    const bool sub_fits = frame.data[3] == asked.object.sub || (write && frame.data[3] == 0);
    return frame.extended && !frame.remote && frame.size == 8 && frame.id == 0x05800000u + asked.node &&
           frame.data[0] == 0x60 && frame.data[1] == (asked.object.index & 0xFF) &&
           frame.data[2] == asked.object.index >> 8 && sub_fits;
  }

  Random random{5};
};

TEST_F(KeyaCanProperty, a_reply_is_told_for_each_frame_that_answers_what_is_outstanding_and_for_no_other) {
  std::optional<bus::Exchange> asked;
  std::size_t answered = 0;
  for (int i = 0; i < 200'000; ++i) {
    if (!asked) {
      asked = any_exchange();
      wire->send(*asked);
      link->sent.clear();
    } else if (random.chance(1, 50)) {
      wire->abandon();
      asked.reset();
    }
    const can::CanFrame frame = any_frame();
    const bool expected = asked && answers(frame, *asked);
    bring(frame);
    ASSERT_EQ(replies.size(), expected ? 1u : 0u) << i << ": " << keya::describe(frame);
    if (expected) {
      ++answered;
      ASSERT_EQ(replies[0].fields.size(), asked->access == bus::Access::read ? 1u : 0u);
      asked.reset();
    }
    forget();
    runtime.advance_by(1ms);
  }
  EXPECT_GT(answered, 400u);
}

}  // namespace
}  // namespace axisgate::test
