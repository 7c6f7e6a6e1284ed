// Frames in words, as an engineer reads them in the decode log.
#include "adapters/keya/keya_text.hpp"

#include "tests/unit/keya/keya_can_stage.hpp"

namespace axisgate::keya {
namespace {

using test::from_hex;

std::string can_text(std::uint32_t id, std::string_view hex) { return describe(test::extended(id, hex)); }

TEST(KeyaText, names_commands_and_motors_on_can) {
  EXPECT_EQ(can_text(0x06000001, "23 0D 20 01 00 00 00 00"), "enable of motor A");
  EXPECT_EQ(can_text(0x06000001, "23 0C 20 02 00 00 00 00"), "disable of motor B");
  EXPECT_EQ(can_text(0x06000001, "23 01 20 02 FF FF E0 C0"), "torque of motor B = -8000");
  EXPECT_EQ(can_text(0x06000001, "23 02 20 01 00 00 07 D0"), "position of motor A = 2000");
  EXPECT_EQ(can_text(0x06000001, "23 07 20 03 00 00 00 01"), "command 2007 of motor 3 = 1");
  EXPECT_EQ(can_text(0x05800001, "60 02 20 01 00 00 00 00"), "acknowledged: position of motor A");
  EXPECT_EQ(can_text(0x05800001, "60 0D 20 00 00 00 00 00"), "acknowledged: enable");
}

TEST(KeyaText, names_queries_and_values_on_can) {
  EXPECT_EQ(can_text(0x06000001, "40 12 21 01 00 00 00 00"), "query faults");
  EXPECT_EQ(can_text(0x06000001, "40 04 21 02 00 00 00 00"), "query encoder A");
  EXPECT_EQ(can_text(0x05800001, "60 12 21 01 08 11 00 11"), "faults: A 0x0811, B 0x0011");
  EXPECT_EQ(can_text(0x05800001, "60 00 21 01 00 03 00 04"), "current: A 3, B 4");
  EXPECT_EQ(can_text(0x05800001, "60 0D 21 02 00 00 00 31"), "voltage: 49");
  EXPECT_EQ(can_text(0x05800001, "60 0F 21 01 00 22 19 1A"), "temperature: drive 34, A 25, B 26");
  EXPECT_EQ(can_text(0x05800001, "60 04 21 03 FF FE 79 60"), "encoder B: -100000");
  EXPECT_EQ(can_text(0x05800001, "60 11 11 01 01 34 89 99"), "1111.01: 0x01348999");
}

TEST(KeyaText, has_words_for_what_is_no_frame) {
  EXPECT_EQ(can_text(0x05800001, "43 12 21 01 08 11 00 11"), "no frame of this protocol");
  EXPECT_EQ(can_text(0x05800001, ""), "no frame of this protocol");
  EXPECT_EQ(can_text(0x07000001, "00"), "no heartbeat");
}

TEST(KeyaText, names_what_goes_to_a_serial_drive) {
  EXPECT_EQ(describe_request({.start = kControl, .code = 1, .data = {0xFF, 0xFF, 0xFC, 0x18, 0, 0, 0, 7}}),
            "control: A on -1000, B off 7");
  EXPECT_EQ(describe_request({.start = kControl, .code = 2}), "control: A off 0, B on 0");
  EXPECT_EQ(describe_request({.code = 4}), "query mechanical angle");
}

TEST(KeyaText, names_what_a_serial_drive_says) {
  const auto answer = [](KeyaLine line, std::uint8_t code, std::string_view hex) {
    SerialFrame frame{.code = code};
    std::ranges::copy(from_hex(hex), frame.data.begin());
    return describe_answer(line, frame);
  };
  EXPECT_EQ(answer(KeyaLine::rs232, 0, "11 10"), "control state: 11 10 00 00 00 00 00 00 00 00");
  EXPECT_EQ(answer(KeyaLine::rs485, 2, "01 F5 FE 0E"), "speed: A 501, B -498");
  EXPECT_EQ(answer(KeyaLine::rs485, 5, "31"), "voltage: 49");
  EXPECT_EQ(answer(KeyaLine::rs232, 6, "00 22 19 FF"), "temperature: drive 34, A 25, B -1");
  EXPECT_EQ(answer(KeyaLine::rs485, 6, "00 22 FF E4 FF E5"), "temperature: drive 34, A -28, B -27");
  EXPECT_EQ(answer(KeyaLine::rs485, 8, "00 00 27 10 FF FE 79 60"), "encoder: A 10000, B -100000");
  EXPECT_EQ(answer(KeyaLine::rs485, 9, "01 34 89 99"), "version: 20220313");
  SerialFrame beat{.start = kHeartbeat, .sum_as_believed = false};
  std::ranges::copy(from_hex("01 F4 08 01 22 31 02 58"), beat.data.begin());
  EXPECT_EQ(describe_answer(KeyaLine::rs232, beat),
            "heartbeat: angle A 500, B 600, faults A 0x0801, drive 34 degC, 49 V  (odd sum)");
}

}  // namespace
}  // namespace axisgate::keya
