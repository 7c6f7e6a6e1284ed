// SPDX-License-Identifier: Apache-2.0
// Frames in words, as an engineer reads them in the decode log.
#include "adapters/keya/keya_text.hpp"

#include "tests/unit/keya/keya_frames.hpp"

namespace axisgate::keya {
namespace {

using test::from_hex;

TEST(KeyaText, names_commands_motors_queries_and_values_on_can) {
  struct Line {
    std::uint32_t id;
    const char* hex;
    const char* words;
  };
  static constexpr Line kLines[] = {
      {0x06000001, "23 0D 20 01 00 00 00 00", "enable of motor A"},
      {0x06000001, "23 0C 20 02 00 00 00 00", "disable of motor B"},
      {0x06000001, "23 01 20 02 FF FF E0 C0", "torque of motor B = -8000"},
      {0x06000001, "23 02 20 01 00 00 07 D0", "position of motor A = 2000"},
      {0x06000001, "23 07 20 03 00 00 00 01", "command 2007 of motor 3 = 1"},
      {0x05800001, "60 02 20 01 00 00 00 00", "acknowledged: position of motor A"},
      {0x05800001, "60 0D 20 00 00 00 00 00", "acknowledged: enable"},
      {0x06000001, "40 12 21 01 00 00 00 00", "query faults"},
      {0x06000001, "40 04 21 02 00 00 00 00", "query encoder A"},
      {0x05800001, "60 12 21 01 08 11 00 11", "faults: A 0x0811, B 0x0011"},
      {0x05800001, "60 00 21 01 00 03 00 04", "current: A 3, B 4"},
      {0x05800001, "60 0D 21 02 00 00 00 31", "voltage: 49"},
      {0x05800001, "60 0F 21 01 00 22 19 1A", "temperature: drive 34, A 25, B 26"},
      {0x05800001, "60 04 21 03 FF FE 79 60", "encoder B: -100000"},
      {0x05800001, "60 11 11 01 01 34 89 99", "1111.01: 0x01348999"},
      {0x05800001, "43 12 21 01 08 11 00 11", "no frame of this protocol"},
      {0x05800001, "", "no frame of this protocol"},
      {0x07000001, "00", "no heartbeat"},
  };
  for (const Line& line : kLines) EXPECT_EQ(describe(test::extended(line.id, line.hex)), line.words) << line.hex;
}

TEST(KeyaText, names_what_goes_to_a_serial_drive) {
  EXPECT_EQ(describe_request({.start = kControl, .code = 1, .data = {0xFF, 0xFF, 0xFC, 0x18, 0, 0, 0, 7}}),
            "control: A on -1000, B off 7");
  EXPECT_EQ(describe_request({.start = kControl, .code = 2}), "control: A off 0, B on 0");
  EXPECT_EQ(describe_request({.code = 4}), "query mechanical angle");
}

TEST(KeyaText, names_what_a_serial_drive_says) {
  const auto said = [](KeyaLine line, SerialFrame frame, std::string_view hex) {
    std::ranges::copy(from_hex(hex), frame.data.begin());
    return describe_answer(line, frame);
  };
  EXPECT_EQ(said(KeyaLine::rs232, {.code = 0}, "11 10"), "control state: 11 10 00 00 00 00 00 00 00 00");
  EXPECT_EQ(said(KeyaLine::rs485, {.code = 2}, "01 F5 FE 0E"), "speed: A 501, B -498");
  EXPECT_EQ(said(KeyaLine::rs485, {.code = 5}, "31"), "voltage: 49");
  EXPECT_EQ(said(KeyaLine::rs232, {.code = 6}, "00 22 19 FF"), "temperature: drive 34, A 25, B -1");
  EXPECT_EQ(said(KeyaLine::rs485, {.code = 6}, "00 22 FF E4 FF E5"), "temperature: drive 34, A -28, B -27");
  EXPECT_EQ(said(KeyaLine::rs485, {.code = 8}, "00 00 27 10 FF FE 79 60"), "encoder: A 10000, B -100000");
  EXPECT_EQ(said(KeyaLine::rs485, {.code = 9}, "01 34 89 99"), "version: 20220313");
  EXPECT_EQ(said(KeyaLine::rs232, {.start = kHeartbeat, .sum_as_believed = false}, "01 F4 08 01 22 31 02 58"),
            "heartbeat: angle A 500, B 600, faults A 0x0801, drive 34 degC, 49 V  (odd sum)");
}

}  // namespace
}  // namespace axisgate::keya
