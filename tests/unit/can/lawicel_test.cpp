// SPDX-License-Identifier: Apache-2.0
#include "adapters/can/lawicel.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string_view>
#include <vector>

namespace axisgate::can {
namespace {

using Kind = LawicelLine::Kind;

LawicelLine line(Kind kind) {
  LawicelLine made;
  made.kind = kind;
  return made;
}

CanFrame with_id(CanFrame frame, std::uint32_t id, bool extended) {
  frame.id = id;
  frame.extended = extended;
  return frame;
}
CanFrame frame(std::uint32_t id, const std::vector<Byte>& bytes, bool extended = false) {
  return with_id(data_frame(0, bytes), id, extended);
}
CanFrame remote(std::uint32_t id, std::uint8_t size, bool extended = false) {
  return with_id(remote_frame(0, size), id, extended);
}

LawicelLine of(const CanFrame& content, std::optional<std::uint16_t> stamp = {}) {
  LawicelLine made = line(Kind::frame);
  made.frame = content;
  made.stamp_ms = stamp;
  return made;
}

LawicelLine words(Kind kind, std::string text) {
  LawicelLine made = line(kind);
  made.text = std::move(text);
  return made;
}

LawicelLine status(Byte flags) {
  LawicelLine made = line(Kind::status);
  made.flags = flags;
  return made;
}

struct Vector {
  std::string bytes;
  LawicelLine expected;
};

std::vector<Vector> vectors() {
  return {
      {"\r", line(Kind::done)},
      {"\a", line(Kind::refused)},
      {"z\r", line(Kind::sent)},
      {"Z\r", line(Kind::sent)},
      {"F00\r", status(0)},
      {"Fa5\r", status(0xA5)},
      {"V1013\r", words(Kind::version, "1013")},
      {"NA123\r", words(Kind::serial_number, "A123")},
      {"t10021133\r", of(frame(0x100, {0x11, 0x33}))},
      {"t7FF0\r", of(frame(0x7FF, {}))},
      {"t583884B4160000102030\r", of(frame(0x583, {0x84, 0xB4, 0x16, 0x00, 0x00, 0x10, 0x20, 0x30}))},
      {"t183481c2d3e4\r", of(frame(0x183, {0x81, 0xC2, 0xD3, 0xE4}))},
      {"t10021133EA5F\r", of(frame(0x100, {0x11, 0x33}), 0xEA5F)},
      {"t7010001C\r", of(frame(0x701, {}), 0x001C)},
      {"T000001002AABB\r", of(frame(0x100, {0xAA, 0xBB}, true))},
      {"T1FFFFFFF80102030405060708\r", of(frame(0x1FFFFFFF, {1, 2, 3, 4, 5, 6, 7, 8}, true))},
      {"T1FFFFFFF801020304050607081234\r", of(frame(0x1FFFFFFF, {1, 2, 3, 4, 5, 6, 7, 8}, true), 0x1234)},
      {"r7031\r", of(remote(0x703, 1))},
      {"r70310042\r", of(remote(0x703, 1), 0x42)},
      {"R000010008\r", of(remote(0x1000, 8, true))},
  };
}

std::vector<LawicelLine> decode(LawicelDecoder& decoder, std::string_view bytes) {
  std::vector<LawicelLine> lines;
  for (const char byte : bytes) {
    if (auto one = decoder.push(static_cast<Byte>(byte))) lines.push_back(*one);
  }
  return lines;
}

std::vector<LawicelLine> decode(std::string_view bytes) {
  LawicelDecoder decoder;
  return decode(decoder, bytes);
}

TEST(Lawicel, every_reply_is_understood_with_its_last_byte_and_behind_a_byte_of_noise_and_others) {
  for (const Vector& vector : vectors()) {
    SCOPED_TRACE(vector.bytes);
    LawicelDecoder decoder;
    EXPECT_THAT(decode(decoder, vector.bytes), testing::ElementsAre(vector.expected));
    EXPECT_EQ(decoder.bad_bytes(), 0);
    for (std::size_t size = 0; size < vector.bytes.size(); ++size) {
      EXPECT_TRUE(decode(vector.bytes.substr(0, size)).empty()) << "cut at " << size;
    }
    for (const Vector& second : vectors()) {
      EXPECT_THAT(decode(vector.bytes + second.bytes), testing::ElementsAre(vector.expected, second.expected));
    }
    for (const char noise : {'\0', '\x80', '\xFF', '\x1B'}) {
      LawicelDecoder noisy;
      EXPECT_THAT(decode(noisy, noise + vector.bytes), testing::ElementsAre(vector.expected));
      EXPECT_EQ(noisy.bad_bytes(), 1);
    }
  }
}

TEST(Lawicel, a_byte_of_noise_inside_a_frame_never_gives_a_frame) {
  for (const Vector& vector : vectors()) {
    if (vector.expected.kind != Kind::frame) continue;
    for (std::size_t at = 1; at < vector.bytes.size() - 1; ++at) {
      std::string broken = vector.bytes;
      broken.insert(at, 1, '\xFF');
      for (const LawicelLine& one : decode(broken)) EXPECT_NE(one.kind, Kind::frame) << broken;
    }
  }
}

TEST(Lawicel, what_is_no_line_is_counted_and_skipped) {
  for (const std::string bad : {"t1002113\r", "t100211334\r", "t8000\r",     "t10091122334455667788\r",
                                "t100A\r",    "t10G0\r",      "t1002113G\r", "T200000000\r",
                                "T1000\r",    "t10\r",        "r70312\r",    "F1\r",
                                "F123\r",     "FGG\r",        "V\r",         "N\r",
                                "z1\r",       "x\r",          "hello\r",     "t1002113312G4\r"}) {
    LawicelDecoder decoder;
    EXPECT_TRUE(decode(decoder, bad).empty()) << bad;
    EXPECT_EQ(decoder.bad_bytes(), bad.size()) << bad;
    EXPECT_EQ(decode(decoder, "t1230\r").size(), 1) << "after " << bad;
  }
}

TEST(Lawicel, a_bell_ends_half_a_line_line_feeds_mean_nothing_and_a_port_opened_anew_forgets_what_it_had) {
  LawicelDecoder decoder;
  EXPECT_THAT(decode(decoder, "t100\a"), testing::ElementsAre(line(Kind::refused)));
  EXPECT_EQ(decoder.bad_bytes(), 4);
  EXPECT_THAT(decode("V1013\r\n\nt1230\r\n"), testing::ElementsAre(words(Kind::version, "1013"), of(frame(0x123, {}))));
  EXPECT_TRUE(decode(decoder, "t12").empty());
  decoder.clear();
  EXPECT_THAT(decode(decoder, "t4560\r"), testing::ElementsAre(of(frame(0x456, {}))));
}

TEST(Lawicel, a_line_without_end_is_bounded_and_the_next_one_is_found) {
  LawicelDecoder decoder;
  EXPECT_TRUE(decode(decoder, "V" + std::string(10'000, 'x')).empty());
  EXPECT_EQ(decoder.bad_bytes(), 10'001);
  EXPECT_TRUE(decode(decoder, "\r").empty()) << "the end of something unknown is no answer";
  EXPECT_THAT(decode(decoder, "t1230\r"), testing::ElementsAre(of(frame(0x123, {}))));
}

TEST(Lawicel, the_longest_line_is_a_line) {
  EXPECT_THAT(decode("V" + std::string(kMaxLawicelLine - 1, 'x') + "\r"),
              testing::ElementsAre(words(Kind::version, std::string(kMaxLawicelLine - 1, 'x'))));
}

TEST(Lawicel, what_is_sent_is_what_an_adapter_reads) {
  EXPECT_EQ(lawicel_text(frame(0x603, {0x40, 0x41, 0x60, 0, 0, 0, 0, 0})), "t60384041600000000000\r");
  EXPECT_EQ(lawicel_text(frame(0, {1, 3})), "t00020103\r");
  EXPECT_EQ(lawicel_text(frame(0x1ABCDEF0, {0xFF}, true)), "T1ABCDEF01FF\r");
  EXPECT_EQ(lawicel_text(remote(0x703, 1)), "r7031\r");
  EXPECT_EQ(lawicel_text(remote(0x703, 1, true)), "R000007031\r");
}

TEST(Lawicel, any_frame_survives_the_way_there_and_back) {
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    CanFrame sent;
    sent.extended = random() % 2 == 0;
    sent.remote = random() % 4 == 0;
    sent.id = static_cast<std::uint32_t>(random()) & (sent.extended ? kMaxExtendedId : kMaxStandardId);
    sent.size = static_cast<std::uint8_t>(random() % 9);
    for (std::size_t b = 0; !sent.remote && b < sent.size; ++b) sent.data[b] = static_cast<Byte>(random());
    EXPECT_THAT(decode(lawicel_text(sent)), testing::ElementsAre(of(sent)));
  }
}

TEST(Lawicel, random_bytes_never_break_it_and_a_frame_after_them_is_found) {
  std::mt19937 random(2);
  for (int round = 0; round < 500; ++round) {
    LawicelDecoder decoder;
    std::string noise(random() % 200, '\0');
    for (char& byte : noise) byte = static_cast<char>(random());
    (void)decode(decoder, noise + "\r");
    EXPECT_THAT(decode(decoder, "t1230\r"), testing::ElementsAre(of(frame(0x123, {}))));
  }
}

TEST(Lawicel, each_bit_rate_has_its_digit_and_others_have_none) {
  constexpr std::array<std::uint32_t, 9> kRates{10000, 20000, 50000, 100000, 125000, 250000, 500000, 800000, 1000000};
  for (std::size_t i = 0; i < kRates.size(); ++i) EXPECT_EQ(lawicel_rate(kRates[i]), static_cast<char>('0' + i));
  EXPECT_FALSE(lawicel_rate(83333));
  EXPECT_FALSE(lawicel_rate(0));
}

}  // namespace
}  // namespace axisgate::can
