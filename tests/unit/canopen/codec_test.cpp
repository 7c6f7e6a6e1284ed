// SPDX-License-Identifier: Apache-2.0
// SDO frames forth and back, byte by byte as CiA 301 prints them; process data, ids and filters; frames in words.
#include "adapters/canopen/canopen_text.hpp"
#include "adapters/canopen/cob_id.hpp"
#include "adapters/canopen/process_data.hpp"
#include "adapters/canopen/sdo/sdo_codec.hpp"
#include "gateway/core/random.hpp"
#include "tests/unit/canopen/canopen_frames.hpp"

namespace axisgate::canopen {
namespace {

using test::from_hex;
using Kind = SdoReply::Kind;

constexpr ObjectAddress kObject{0x1234, 0x05};

TEST(SdoCodec, requests_are_what_the_standard_prints) {
  EXPECT_EQ(hex_text(upload_frame(kObject)), "40 34 12 05 00 00 00 00");
  EXPECT_EQ(hex_text(upload_segment_frame(false)), "60 00 00 00 00 00 00 00");
  EXPECT_EQ(hex_text(upload_segment_frame(true)), "70 00 00 00 00 00 00 00");
  EXPECT_EQ(hex_text(expedited_download_frame(kObject, from_hex("11"))), "2F 34 12 05 11 00 00 00");
  EXPECT_EQ(hex_text(expedited_download_frame(kObject, from_hex("11 22"))), "2B 34 12 05 11 22 00 00");
  EXPECT_EQ(hex_text(expedited_download_frame(kObject, from_hex("11 22 33"))), "27 34 12 05 11 22 33 00");
  EXPECT_EQ(hex_text(expedited_download_frame(kObject, from_hex("11 22 33 44"))), "23 34 12 05 11 22 33 44");
  EXPECT_EQ(hex_text(download_frame(kObject, 0x1A)), "21 34 12 05 1A 00 00 00");
  EXPECT_EQ(hex_text(download_segment_frame(false, from_hex("01 02 03 04 05 06 07"), false)),
            "00 01 02 03 04 05 06 07");
  EXPECT_EQ(hex_text(download_segment_frame(true, from_hex("01 02 03"), true)), "19 01 02 03 00 00 00 00");
  EXPECT_EQ(hex_text(abort_frame(kObject, 0x05040000)), "80 34 12 05 00 00 04 05");
  EXPECT_EQ(hex_text(block_upload_frame(kObject, 16, 21)), "A4 34 12 05 10 15 00 00");
  EXPECT_EQ(hex_text(block_upload_start_frame()), "A3 00 00 00 00 00 00 00");
  EXPECT_EQ(hex_text(block_upload_ack_frame(9, 16)), "A2 09 10 00 00 00 00 00");
  EXPECT_EQ(hex_text(block_upload_end_frame()), "A1 00 00 00 00 00 00 00");
  EXPECT_EQ(hex_text(block_download_frame(kObject, 0x1000)), "C6 34 12 05 00 10 00 00");
  EXPECT_EQ(hex_text(block_segment_frame(3, from_hex("01 02"), true)), "83 01 02 00 00 00 00 00");
  EXPECT_EQ(hex_text(block_download_end_frame(5, 0xBEEF)), "D5 EF BE 00 00 00 00 00");
}

SdoReply::Kind kind_of(const char* hex) { return decode_reply(from_hex(hex)).value().kind; }

TEST(SdoCodec, replies_say_what_the_standard_says) {
  const SdoReply kUnsized{.kind = Kind::value, .object = kObject, .unsized = true, .data = {0x11, 0x22, 0x33, 0x44}};
  const std::pair<const char*, SdoReply> kReplies[] = {
      {"60 34 12 05 00 00 00 00", {.kind = Kind::downloaded, .object = kObject}},
      {"80 34 12 05 00 00 04 05", {.kind = Kind::aborted, .object = kObject, .code = 0x05040000}},
      {"4F 34 12 05 11 22 33 44", {.kind = Kind::value, .object = kObject, .data = {0x11}}},
      {"4B 34 12 05 11 22 33 44", {.kind = Kind::value, .object = kObject, .data = {0x11, 0x22}}},
      {"47 34 12 05 11 22 33 44", {.kind = Kind::value, .object = kObject, .data = {0x11, 0x22, 0x33}}},
      {"43 34 12 05 11 22 33 44", {.kind = Kind::value, .object = kObject, .data = {0x11, 0x22, 0x33, 0x44}}},
      {"42 34 12 05 11 22 33 44", kUnsized},
      {"4E 34 12 05 11 22 33 44", kUnsized},
      {"41 34 12 05 1A 00 00 00", {.kind = Kind::upload_begins, .object = kObject, .size = 0x1A}},
      {"40 34 12 05 1A 00 00 00", {.kind = Kind::upload_begins, .object = kObject}},
      {"1B 01 02 03 00 00 00 00", {.kind = Kind::segment, .toggle = true, .last = true, .data = {1, 2}}},
      {"20 00 00 00 00 00 00 00", {.kind = Kind::segment_downloaded}},
      {"30 00 00 00 00 00 00 00", {.kind = Kind::segment_downloaded, .toggle = true}},
      {"A4 34 12 05 7F 00 00 00",
       {.kind = Kind::block_download_begins, .object = kObject, .crc = true, .segments = 127}},
      {"A0 34 12 05 7F 00 00 00", {.kind = Kind::block_download_begins, .object = kObject, .segments = 127}},
      {"A2 0A 10 00 00 00 00 00", {.kind = Kind::block_received, .segments = 16, .sequence = 10}},
      {"A1 00 00 00 00 00 00 00", {.kind = Kind::block_downloaded}},
      {"C6 34 12 05 00 10 00 00", {.kind = Kind::block_upload_begins, .object = kObject, .crc = true, .size = 4096}},
      {"C4 34 12 05 00 10 00 00", {.kind = Kind::block_upload_begins, .object = kObject, .crc = true}},
      {"D5 EF BE 00 00 00 00 00", {.kind = Kind::block_upload_ends, .unused = 5, .checksum = 0xBEEF}},
  };
  for (const auto& [hex, expected] : kReplies) EXPECT_TRUE(decode_reply(from_hex(hex)) == expected) << hex;
}

TEST(SdoCodec, short_frames_are_taken_as_far_as_they_carry_what_they_say) {
  EXPECT_EQ(decode_reply(from_hex("4B 41 60 00 37 02"))->data.size(), 2u);
  EXPECT_EQ(decode_reply(from_hex("42 41 60 00 37 02"))->data.size(), 2u);
  EXPECT_EQ(kind_of("60 40 60 00 0F 00"), Kind::downloaded);
  EXPECT_EQ(kind_of("60 40 60 00"), Kind::downloaded);
  EXPECT_EQ(decode_reply(from_hex("0D AA"))->data.size(), 1u);
  for (const char* hex : {"", "42 41 60 00", "43 41 60 00 37 02", "4B 41 60 00 37", "60 40 60", "80 41 60 00 00 00 02",
                          "00 01 02", "41 08 10 00 05", "A4 00 20 00", "A2 10", "C6 00 20 00 09", "C1 00",
                          "E0 00 00 00 00 00 00 00", "A3 00 00 00 00 00 00 00"}) {
    EXPECT_FALSE(decode_reply(from_hex(hex))) << hex;
  }
}

TEST(SdoCodec, block_segments_have_a_sequence_and_seven_bytes) {
  const BlockSegment last{.sequence = 16, .last = true, .data = {1, 2, 3, 4, 5, 6, 7}};
  EXPECT_TRUE(decode_block_segment(from_hex("90 01 02 03 04 05 06 07")) == last);
  EXPECT_FALSE(decode_block_segment(from_hex("80 34 12 05 00 00 04 05")));
  EXPECT_FALSE(decode_block_segment(from_hex("01 02 03")));
}

TEST(SdoCodec, the_crc_is_the_one_of_the_standard) {
  const std::string digits = "123456789";
  EXPECT_EQ(sdo_crc(test::ByteRow(digits.begin(), digits.end())), 0x31C3) << "CiA 301 names this check value";
  EXPECT_EQ(sdo_crc({}), 0);
}

TEST(SdoCodec, all_but_what_says_what_the_drive_has_may_pass) {
  for (const std::uint32_t code :
       {0x08000000U, 0x08000020U, 0x08000021U, 0x08000022U, 0x08000023U, 0x08000024U, 0x06060000U, 0x06040043U,
        0x06090030U, 0x06070010U, 0x06010002U, 0x05040000U, 0x05040005U, 0x05030000U, 0x00000000U}) {
    EXPECT_TRUE(bus::abort_may_pass(code)) << std::hex << code;
  }
  for (const std::uint32_t code : {0x06020000U, 0x06020001U, 0x06090011U, 0x05040001U}) {
    EXPECT_FALSE(bus::abort_may_pass(code)) << std::hex << code;
  }
}

// --- Process data, ids -----------------------------------------------------------------------------------------------

const bus::ProcessMap kMap{{{0x6041, 0}, 2}, {{0x6064, 0}, 4}, {{0x6061, 0}, 1}};

TEST(ProcessData, is_cut_in_the_order_of_its_map) {
  const bus::ReplyFields expected{{{0x6041, 0}, 2, 0x0637}, {{0x6064, 0}, 4, 0xFFFFB1E0}, {{0x6061, 0}, 1, 0x08}};
  EXPECT_EQ(decode_process_data(kMap, from_hex("37 06 E0 B1 FF FF 08")), expected);
  EXPECT_EQ(decode_process_data(kMap, from_hex("37 06 E0 B1 FF FF 08 99")), expected) << "the surplus is not looked at";
}

TEST(ProcessData, shorter_than_its_map_gives_no_value_at_all) {
  for (const char* hex : {"", "37", "37 06", "37 06 E0 B1 FF FF"}) {
    EXPECT_FALSE(decode_process_data(kMap, from_hex(hex))) << hex;
  }
}

TEST(ProcessData, of_any_map_that_fits_a_frame_comes_back_as_it_was_sent) {
  Random random(3);
  static constexpr std::array<std::uint8_t, 3> kSizes{1, 2, 4};
  for (int run = 0; run < 2000; ++run) {
    bus::ProcessMap map;
    bus::ReplyFields values;
    for (;;) {
      const std::uint8_t size = kSizes.at(random.below(3));
      if (size_of(map) + size > can::kMaxFrameBytes) break;
      const auto index = static_cast<std::uint16_t>(random.next());
      map.push_back({{index, 0}, size});
      values.push_back({{index, 0}, size, static_cast<std::uint32_t>(random.below(1ULL << (8 * size)))});
    }
    const can::CanFrame frame = encode_process_data(tpdo_id(1, 1), values);
    ASSERT_EQ(decode_process_data(map, frame.bytes()), values);
  }
}

TEST(CobIds, of_the_set_are_told_apart_and_no_other_is_taken) {
  EXPECT_EQ(cob_id(0x000), (CobId{Service::nmt, 0, 0}));
  EXPECT_EQ(cob_id(0x080), (CobId{Service::sync, 0, 0}));
  EXPECT_EQ(cob_id(0x081), (CobId{Service::emergency, 1, 0}));
  EXPECT_EQ(cob_id(0x4FF), (CobId{Service::tpdo, 127, 4}));
  EXPECT_EQ(cob_id(0x57F), (CobId{Service::rpdo, 127, 4}));
  EXPECT_EQ(cob_id(0x601), (CobId{Service::sdo_request, 1, 0}));
  EXPECT_EQ(cob_id(0x701), (CobId{Service::error_control, 1, 0}));
  for (const std::uint32_t id :
       {0x001U, 0x07FU, 0x100U, 0x101U, 0x180U, 0x580U, 0x681U, 0x6FFU, 0x700U, 0x780U, 0x7E4U, 0x7FFU, 0x800U}) {
    EXPECT_FALSE(cob_id(id)) << std::hex << id;
  }
  for (std::uint8_t number = 1; number <= kTpdos; ++number) {
    for (const std::uint8_t node : std::initializer_list<std::uint8_t>{1, 64, 127}) {
      EXPECT_EQ(cob_id(tpdo_id(number, node)), (CobId{Service::tpdo, node, number}));
      EXPECT_EQ(cob_id(rpdo_id(number, node)), (CobId{Service::rpdo, node, number}));
    }
  }
}

TEST(Filters, let_through_what_the_nodes_send_and_of_others_that_they_live_or_have_an_error) {
  const auto filters = filters_for({1, 5});
  const auto passes = [&](std::uint32_t id) {
    return std::ranges::any_of(filters, [&](const can::CanFilter& f) { return f.passes(can::data_frame(id, {})); });
  };
  std::vector<std::uint32_t> passing;
  for (std::uint32_t id = 0; id <= can::kMaxStandardId; ++id) {
    const bool of_any_node = (id > 0x080 && id <= 0x0FF) || (id & ~0x7FU) == 0x700;
    EXPECT_TRUE(passes(id) || !of_any_node) << id;
    if (passes(id) && !of_any_node) passing.push_back(id);
  }
  EXPECT_THAT(passing, testing::ElementsAre(0x181, 0x185, 0x281, 0x285, 0x381, 0x385, 0x481, 0x485, 0x581, 0x585));
}

// --- Frames in words -------------------------------------------------------------------------------------------------

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
