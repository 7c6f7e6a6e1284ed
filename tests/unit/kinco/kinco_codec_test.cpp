#include "gateway/core/random.hpp"
#include "tests/unit/kinco/kinco_frames.hpp"

namespace axisgate::kinco {
namespace {

using test::from_hex;

TEST(KincoCodec, says_need_more_for_every_beginning_of_a_frame) {
  const auto bytes = from_hex(test::kStatusReply);
  for (std::size_t size = 0; size < kFrameSize; ++size) {
    EXPECT_EQ(decode(Bytes(bytes).first(size)), Decoded(NeedMore{})) << size << " bytes";
  }
}

TEST(KincoCodec, takes_ten_bytes_and_leaves_the_rest) {
  const auto bytes = from_hex(test::kStatusReply);
  const Frame frame{.node = 1, .command = Command::value_2, .object = {0x6041, 0}, .data = 0xC037};
  EXPECT_EQ(decode(bytes), Decoded(frame));
  EXPECT_EQ(decode(test::operator+(bytes, {0xFF, 0xFF})), Decoded(frame));
}

TEST(KincoCodec, skips_one_byte_where_the_sum_is_wrong) {
  auto bytes = from_hex(test::kStatusReply);
  for (std::size_t at = 0; at < kFrameSize; ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      bytes[at] = static_cast<Byte>(bytes[at] ^ (1 << bit));
      EXPECT_EQ(decode(bytes), Decoded(Bad{Bad::Reason::sum, 1}));
      bytes[at] = static_cast<Byte>(bytes[at] ^ (1 << bit));
    }
  }
}

TEST(KincoCodec, knows_exactly_nine_commands) {
  int known = 0;
  for (int command = 0; command < 256; ++command) {
    const Frame frame{.node = 1, .command = static_cast<Command>(command), .object = {0x6041, 0}, .data = 0};
    const Decoded decoded = decode(encode(frame));
    if (std::holds_alternative<Frame>(decoded)) {
      ++known;
    } else {
      EXPECT_EQ(decoded, Decoded(Bad{Bad::Reason::command, 1}));
    }
  }
  EXPECT_EQ(known, 9);
}

TEST(KincoCodec, ten_zero_bytes_sum_to_zero_and_are_no_frame) {
  EXPECT_EQ(decode(FrameBytes{}), Decoded(Bad{Bad::Reason::command, 1}));
}

TEST(KincoCodec, decodes_what_it_encodes) {
  static constexpr std::array kCommands{Command::write_4, Command::write_2, Command::write_1,
                                        Command::read,    Command::written, Command::value_4,
                                        Command::value_2, Command::value_1, Command::error};
  Random random(1);
  for (int i = 0; i < 20'000; ++i) {
    const Frame frame{
        .node = static_cast<std::uint8_t>(random.below(256)),
        .command = kCommands.at(random.below(kCommands.size())),
        .object = {static_cast<std::uint16_t>(random.below(0x10000)), static_cast<std::uint8_t>(random.below(256))},
        .data = static_cast<std::uint32_t>(random.next())};
    ASSERT_EQ(decode(encode(frame)), Decoded(frame));
  }
}

TEST(KincoCodec, no_ten_bytes_are_taken_whose_sum_is_not_zero) {
  Random random(2);
  for (int i = 0; i < 50'000; ++i) {
    FrameBytes bytes{};
    std::uint32_t sum = 0;
    for (Byte& byte : bytes) sum += byte = static_cast<Byte>(random.below(256));
    ASSERT_TRUE(sum % 256 == 0 || std::holds_alternative<Bad>(decode(bytes)));
  }
}

}  // namespace
}  // namespace axisgate::kinco
