// Frames in words.
#include "adapters/modbus_rtu/rtu_text.hpp"

#include "tests/unit/modbus_rtu/rtu_frames.hpp"

namespace axisgate::modbus_rtu {
namespace {

using test::from_hex;

TEST(RtuText, says_what_is_asked) {
  EXPECT_EQ(describe_request(from_hex("01 03 01 30 00 02")), "unit 1: read 2 registers at 304 (0x0130)");
  EXPECT_EQ(describe_request(from_hex("01 03 01 2E 00 01")), "unit 1: read 1 register at 302 (0x012E)");
  EXPECT_EQ(describe_request(from_hex("01 06 01 2C 00 01")), "unit 1: write 300 (0x012C) = 0x0001");
  EXPECT_EQ(describe_request(from_hex("01 10 01 38 00 02 04 27 10 00 00")),
            "unit 1: write 312 (0x0138) = 0x2710 0x0000");
  EXPECT_EQ(describe_request(from_hex("01 2B 0E 01 00 00 00")), "unit 1: function 0x2B, 7 bytes");
}

TEST(RtuText, says_what_is_answered) {
  EXPECT_EQ(describe_reply(from_hex("01 03 04 27 10 00 00")), "unit 1: 2 registers = 0x2710 0x0000");
  EXPECT_EQ(describe_reply(from_hex("01 06 01 2C 00 01")), "unit 1: written 300 (0x012C) = 0x0001");
  EXPECT_EQ(describe_reply(from_hex("01 10 01 38 00 02")), "unit 1: written 2 registers at 312 (0x0138)");
  EXPECT_EQ(describe_reply(from_hex("01 83 02")), "unit 1: error 0x83: illegal data address (0x02)");
  EXPECT_EQ(describe_reply(from_hex("01 81 FF")), "unit 1: error 0x81: unknown code (0xFF)");
}

TEST(RtuText, has_a_line_for_any_bytes) {
  for (std::size_t size = 0; size <= kMaxFrame; ++size) {
    for (const int function : {0x03, 0x06, 0x10, 0x83, 0x00, 0xFF}) {
      test::ByteRow frame(size, 0x11);
      if (size > 1) frame[1] = static_cast<Byte>(function);
      for (const std::string& line : {describe_request(frame), describe_reply(frame)}) {
        EXPECT_FALSE(line.empty());
        EXPECT_EQ(line.find('\n'), std::string::npos);
      }
    }
  }
}

}  // namespace
}  // namespace axisgate::modbus_rtu
