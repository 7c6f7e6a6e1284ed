// Frames in words, for the decode log.
#include "adapters/canopen/canopen_text.hpp"

#include "gateway/core/random.hpp"
#include "tests/unit/canopen/canopen_frames.hpp"

namespace axisgate::canopen {
namespace {

using test::frame_of;

struct Line {
  std::uint32_t id;
  const char* hex;
  const char* words;
};

const Line kLines[] = {
    {0x000, "01 00", "NMT start all nodes"},
    {0x000, "80 03", "NMT pre-operational node 3"},
    {0x000, "81", "NMT, no command"},
    {0x080, "", "SYNC"},
    {0x083, "30 81 10 01 02 03 04 05", "node 3: EMCY 0x8130, register 0x10, 01 02 03 04 05"},
    {0x183, "37 06", "node 3: TPDO 1"},
    {0x503, "37 06", "node 3: RPDO 4"},
    {0x603, "40 41 60 00 00 00 00 00", "node 3: SDO read 6041:00"},
    {0x603, "2B 40 60 00 0F 00 00 00", "node 3: SDO write 6040:00 = 0x000F"},
    {0x603, "2F 60 60 00 01 00 00 00", "node 3: SDO write 6060:00 = 0x01"},
    {0x603, "21 00 20 0A 1A 00 00 00", "node 3: SDO write 2000:0A, 26 bytes in segments"},
    {0x603, "80 41 60 00 00 00 04 05", "node 3: SDO abort 6041:00: 0x05040000"},
    {0x603, "A4 08 10 00 10 15 00 00", "node 3: SDO read 1008:00 in blocks"},
    {0x583, "4B 41 60 00 37 02 00 00", "node 3: SDO value 6041:00 = 0x0237"},
    {0x583, "43 64 60 00 E0 B1 FF FF", "node 3: SDO value 6064:00 = 0xFFFFB1E0"},
    {0x583, "60 40 60 00 00 00 00 00", "node 3: SDO written 6040:00"},
    {0x583, "80 41 60 00 00 00 02 06", "node 3: SDO abort 6041:00: 0x06020000"},
    {0x583, "41 08 10 00 09 00 00 00", "node 3: SDO segments of 1008:00 follow"},
    {0x583, "E0", "node 3: SDO, no reply"},
    {0x703, "00", "node 3: boot-up"},
    {0x703, "05", "node 3: operational"},
    {0x703, "FF", "node 3: pre-operational, toggled"},
    {0x703, "09", "node 3: error control, no state"},
    {0x7E4, "01", "not CANopen"},
};

TEST(CanopenText, says_what_a_frame_means) {
  for (const Line& line : kLines) EXPECT_EQ(describe(frame_of(line.id, line.hex)), line.words) << line.hex;
  EXPECT_EQ(describe(can::remote_frame(0x703, 1)), "node 3: guarding");
  EXPECT_EQ(describe(can::remote_frame(0x183, 2)), "node 3: remote frame");
}

TEST(CanopenText, of_any_frame_is_one_short_line) {
  Random random(11);
  for (int run = 0; run < 20'000; ++run) {
    can::CanFrame frame;
    frame.id = static_cast<std::uint32_t>(random.below(can::kMaxStandardId + 1));
    frame.remote = random.chance(1, 10);
    frame.size = static_cast<std::uint8_t>(random.below(9));
    for (std::size_t i = 0; i < frame.size && !frame.remote; ++i) frame.data.at(i) = static_cast<Byte>(random.next());
    const std::string words = describe(frame);
    ASSERT_FALSE(words.empty());
    ASSERT_LT(words.size(), 100u);
    ASSERT_EQ(words.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace axisgate::canopen
