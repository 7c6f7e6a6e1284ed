// SPDX-License-Identifier: Apache-2.0
// Function 43/13 with objects that do not fit a PDU: read in parts from one fetch, written in parts as one download.
#include <gtest/gtest.h>

#include "gateway/upstream/modbus_tcp/client/object_buffers.hpp"
#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

std::vector<Byte> long_content(std::size_t size) {
  std::vector<Byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<Byte>(i * 7 + i / 256);
  return bytes;
}

class LongObjects : public AtTheDesk {
 protected:
  static std::string read_at(std::size_t start, std::size_t count = 0, const std::string& object = "10 08 00") {
    return "2B 0D 00 00 01" + object + word(static_cast<std::int64_t>(start)) + word(static_cast<std::int64_t>(count));
  }
  static std::string write_at(const std::string& control, std::size_t start, const std::vector<Byte>& data,
                              const std::string& object = "20 30 00") {
    return "2B 0D" + control + "00 01" + object + word(static_cast<std::int64_t>(start)) +
           word(static_cast<std::int64_t>(data.size())) + hex_text(data);
  }
  static BatchResult holds(const std::vector<Byte>& content) {
    BatchResult result;
    result.object_bytes = std::make_shared<const std::vector<Byte>>(content);
    return result;
  }
  std::string fetch(const std::vector<Byte>& content, std::size_t count = 0) {
    desk.port.at_once = {holds(content)};
    return plc.ask(read_at(0, count));
  }
  /// As a client would: on and on while the extend flag is there.
  std::vector<Byte> read_all(const std::vector<Byte>& content, std::size_t step) {
    std::vector<Byte> out;
    std::string reply = fetch(content, step);
    for (int parts = 0; parts < 5000; ++parts) {
      const auto pdu = bytes(reply);
      EXPECT_LE(pdu.size(), kMaxPdu);
      if (pdu.size() < 12 || pdu[0] != 0x2B) break;
      EXPECT_EQ(load_be16(pdu, 10), pdu.size() - 12);
      out.insert(out.end(), pdu.begin() + 12, pdu.end());
      if ((pdu[2] & 0x80) == 0) return out;
      reply = plc.ask(read_at(out.size(), step));
    }
    ADD_FAILURE() << "no end: " << reply;
    return out;
  }
  const ObjectRequest& asked() { return last().object.value(); }
};

TEST_F(LongObjects, AreReadInPartsWithOneFetch) {
  for (const std::size_t size : {241U, 242U, 300U, 482U, 483U, 4096U}) {
    for (const std::size_t step : {0U, 1U, 100U, 241U, 1000U}) {
      SCOPED_TRACE(std::to_string(size) + " in steps of " + std::to_string(step));
      static_cast<void>(desk.port.taken());
      const auto content = long_content(size);
      EXPECT_EQ(read_all(content, step), content);
      EXPECT_EQ(desk.port.submitted.size(), 1U);
    }
  }
}

TEST_F(LongObjects, OptionsInTheHeaderTakeTheirRoomFromTheData) {
  desk.port.at_once = {holds(long_content(300))};
  const auto pdu = bytes(plc.ask("2B 0D 26 00 07 00 50 01 10 08 00 00 00 00 00"));
  ASSERT_EQ(pdu.size(), kMaxPdu);
  EXPECT_EQ(pdu[2], 0xA6);
  EXPECT_EQ(load_be16(pdu, 13), 238);
}

TEST_F(LongObjects, MayBeAskedForInOneGo) {
  desk.port.slow = true;
  const auto first = long_content(300);
  const auto second = std::vector<Byte>(300, 0xEE);
  plc.send(read_at(0));
  plc.send(read_at(241));
  plc.send(read_at(0));
  plc.send(read_at(241));
  ASSERT_EQ(desk.port.waiting.size(), 2U);
  std::swap(desk.port.waiting[0], desk.port.waiting[1]);
  desk.port.finish_with(holds(second));
  desk.port.finish_with(holds(first));
  EXPECT_EQ(plc.reply(), "2B 0D 80 00 01 10 08 00 00 00 00 F1 " + hex_text(Bytes(first).first(241)));
  EXPECT_EQ(plc.reply(), "2B 0D 00 00 01 10 08 00 00 F1 00 3B " + hex_text(Bytes(first).subspan(241)))
      << "of the fetch before it, though a newer one has ended";
  EXPECT_EQ(plc.reply(), "2B 0D 80 00 01 10 08 00 00 00 00 F1 " + hex_text(Bytes(second).first(241)));
  EXPECT_EQ(plc.reply(), "2B 0D 00 00 01 10 08 00 00 F1 00 3B " + hex_text(Bytes(second).subspan(241)));
}

TEST_F(LongObjects, OfUpTo4KiBAreWritten) {
  const auto content = long_content(4096);
  std::size_t at = 0;
  for (; at + 240 < content.size(); at += 240) {
    const auto from = content.begin() + static_cast<std::ptrdiff_t>(at);
    ASSERT_TRUE(is_done(plc.ask(write_at("81", at, {from, from + 240}))));
  }
  const std::vector<Byte> rest(content.begin() + static_cast<std::ptrdiff_t>(at), content.end());
  EXPECT_TRUE(is_done(plc.ask(write_at("81", at, rest)))) << "full";
  EXPECT_EQ(plc.ask(write_at("01", 4096, {1})), "AB 03");
  EXPECT_TRUE(desk.port.submitted.empty());
  for (at = 0; at + 240 < content.size(); at += 240) {
    const auto from = content.begin() + static_cast<std::ptrdiff_t>(at);
    ASSERT_TRUE(is_done(plc.ask(write_at("81", at, {from, from + 240}))));
  }
  EXPECT_TRUE(is_done(plc.ask(write_at("01", at, rest))));
  EXPECT_EQ(*asked().bytes, content);
}

TEST(ObjectBuffers, keep_few_at_a_time_and_the_oldest_gives_way) {
  ObjectBuffers buffers;
  const auto content = std::make_shared<const std::vector<Byte>>(kMaxObjectBytes);
  for (std::uint16_t i = 0; i <= kMaxKeptObjects; ++i) buffers.keep({1, i, 0}, content, Instant{});
  EXPECT_EQ(buffers.kept({1, 0, 0}, Instant{}), nullptr);
  for (std::uint16_t i = 1; i <= kMaxKeptObjects; ++i) EXPECT_NE(buffers.kept({1, i, 0}, Instant{}), nullptr) << i;
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
