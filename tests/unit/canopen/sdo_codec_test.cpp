// SDO frames forth and back, byte by byte as CiA 301 prints them.
#include "adapters/canopen/sdo_codec.hpp"

#include <string>

#include "tests/unit/canopen/canopen_frames.hpp"

namespace axisgate::canopen {
namespace {

using test::from_hex;
using Kind = SdoReply::Kind;

constexpr bus::ObjectAddress kObject{0x1234, 0x05};

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
}

TEST(SdoCodec, block_requests_are_what_the_standard_prints) {
  EXPECT_EQ(hex_text(block_upload_frame(kObject, 16, 21)), "A4 34 12 05 10 15 00 00");
  EXPECT_EQ(hex_text(block_upload_start_frame()), "A3 00 00 00 00 00 00 00");
  EXPECT_EQ(hex_text(block_upload_ack_frame(9, 16)), "A2 09 10 00 00 00 00 00");
  EXPECT_EQ(hex_text(block_upload_end_frame()), "A1 00 00 00 00 00 00 00");
  EXPECT_EQ(hex_text(block_download_frame(kObject, 0x1000)), "C6 34 12 05 00 10 00 00");
  EXPECT_EQ(hex_text(block_segment_frame(3, from_hex("01 02"), true)), "83 01 02 00 00 00 00 00");
  EXPECT_EQ(hex_text(block_download_end_frame(5, 0xBEEF)), "D5 EF BE 00 00 00 00 00");
}

TEST(SdoCodec, an_expedited_value_has_the_bytes_its_command_says) {
  const std::pair<const char*, std::size_t> kCases[] = {{"4F 34 12 05 11 22 33 44", 1}, {"4B 34 12 05 11 22 33 44", 2},
                                                        {"47 34 12 05 11 22 33 44", 3}, {"43 34 12 05 11 22 33 44", 4},
                                                        {"42 34 12 05 11 22 33 44", 4}, {"4E 34 12 05 11 22 33 44", 4}};
  for (const auto& [hex, size] : kCases) {
    const auto reply = decode_reply(from_hex(hex));
    ASSERT_TRUE(reply) << hex;
    EXPECT_EQ(reply->kind, Kind::value) << hex;
    EXPECT_EQ(reply->object, kObject) << hex;
    EXPECT_EQ(hex_text(reply->data), hex_text(Bytes(from_hex("11 22 33 44")).first(size))) << hex;
  }
}

TEST(SdoCodec, short_frames_are_taken_as_far_as_they_carry_what_they_say) {
  EXPECT_EQ(decode_reply(from_hex("4B 41 60 00 37 02"))->data.size(), 2u);
  EXPECT_EQ(decode_reply(from_hex("60 40 60 00 0F 00"))->kind, Kind::downloaded);
  EXPECT_EQ(decode_reply(from_hex("60 40 60 00"))->kind, Kind::downloaded);
  EXPECT_EQ(decode_reply(from_hex("0D AA"))->data.size(), 1u);
  for (const char* hex :
       {"", "43 41 60 00 37 02", "4B 41 60 00 37", "60 40 60", "80 41 60 00 00 00 02", "00 01 02", "41 08 10 00 05",
        "A4 00 20 00", "A2 10", "C6 00 20 00 09", "C1 00", "E0 00 00 00 00 00 00 00", "A3 00 00 00 00 00 00 00"}) {
    EXPECT_FALSE(decode_reply(from_hex(hex))) << hex;
  }
}

TEST(SdoCodec, replies_of_long_transfers_say_what_the_standard_says) {
  const auto begins = decode_reply(from_hex("41 34 12 05 1A 00 00 00"));
  EXPECT_EQ(begins->kind, Kind::upload_begins);
  EXPECT_EQ(begins->size, 0x1Au);
  EXPECT_FALSE(decode_reply(from_hex("40 34 12 05 1A 00 00 00"))->size);
  const auto segment = decode_reply(from_hex("1B 01 02 03 00 00 00 00"));
  EXPECT_EQ(segment->kind, Kind::segment);
  EXPECT_TRUE(segment->toggle);
  EXPECT_TRUE(segment->last);
  EXPECT_EQ(hex_text(segment->data), "01 02");
  EXPECT_FALSE(decode_reply(from_hex("20 00 00 00 00 00 00 00"))->toggle);
  EXPECT_TRUE(decode_reply(from_hex("30 00 00 00 00 00 00 00"))->toggle);
}

TEST(SdoCodec, replies_of_block_transfers_say_what_the_standard_says) {
  const auto download = decode_reply(from_hex("A4 34 12 05 7F 00 00 00"));
  EXPECT_EQ(download->kind, Kind::block_download_begins);
  EXPECT_TRUE(download->crc);
  EXPECT_EQ(download->segments, 127);
  EXPECT_FALSE(decode_reply(from_hex("A0 34 12 05 7F 00 00 00"))->crc);
  const auto received = decode_reply(from_hex("A2 0A 10 00 00 00 00 00"));
  EXPECT_EQ(received->sequence, 10);
  EXPECT_EQ(received->segments, 16);
  EXPECT_EQ(decode_reply(from_hex("A1 00 00 00 00 00 00 00"))->kind, Kind::block_downloaded);
  const auto upload = decode_reply(from_hex("C6 34 12 05 00 10 00 00"));
  EXPECT_EQ(upload->kind, Kind::block_upload_begins);
  EXPECT_EQ(upload->size, 4096u);
  EXPECT_FALSE(decode_reply(from_hex("C4 34 12 05 00 10 00 00"))->size);
  const auto ends = decode_reply(from_hex("D5 EF BE 00 00 00 00 00"));
  EXPECT_EQ(ends->kind, Kind::block_upload_ends);
  EXPECT_EQ(ends->unused, 5);
  EXPECT_EQ(ends->checksum, 0xBEEF);
  const auto segment = decode_block_segment(from_hex("90 01 02 03 04 05 06 07"));
  EXPECT_EQ(segment->sequence, 16);
  EXPECT_TRUE(segment->last);
  EXPECT_FALSE(decode_block_segment(from_hex("80 34 12 05 00 00 04 05")));
  EXPECT_FALSE(decode_block_segment(from_hex("01 02 03")));
}

TEST(SdoCodec, the_crc_is_the_one_of_the_standard) {
  const std::string digits = "123456789";
  EXPECT_EQ(sdo_crc(test::ByteRow(digits.begin(), digits.end())), 0x31C3) << "CiA 301 names this check value";
  EXPECT_EQ(sdo_crc({}), 0);
}

TEST(SdoCodec, only_what_may_pass_is_for_now) {
  for (const std::uint32_t code :
       {0x08000020U, 0x08000021U, 0x08000022U, 0x08000024U, 0x05040000U, 0x05040005U, 0x05030000U}) {
    EXPECT_TRUE(is_for_now(code)) << std::hex << code;
  }
  for (const std::uint32_t code : {0x06020000U, 0x06090011U, 0x05040001U, 0x06070010U, 0x06060010U, 0x06090030U,
                                   0x08000000U, 0x08000023U, 0x06010002U}) {
    EXPECT_FALSE(is_for_now(code)) << std::hex << code;
  }
}

}  // namespace
}  // namespace axisgate::canopen
