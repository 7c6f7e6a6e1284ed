// The simulated SDO server: segmented and block transfers both ways, and every way to break one.
#include "tests/simulated/sdo_server.hpp"

#include <gmock/gmock.h>

#include <numeric>

#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

struct Texts final : ObjectAccess {
  ObjectReply read(ObjectKey key, Time) override {
    const auto found = held.find(key);
    if (found == held.end()) return {abort_of(Refusal::no_such_object)};
    return {0, found->second};
  }
  std::uint32_t write(ObjectKey key, CanView bytes, std::uint64_t, Time) override {
    if (key.index == 0x1008) return abort_of(Refusal::read_only);
    held[key] = {bytes.begin(), bytes.end()};
    return 0;
  }
  std::map<ObjectKey, CanBytes> held;
};

CanBytes counting(std::size_t size) {
  CanBytes bytes(size);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{1});
  return bytes;
}

class SdoServerTest : public testing::Test {
 protected:
  std::vector<CanBytes> ask(const char* hex) { return server.answer(from_hex(hex), objects, 1, Time{}); }
  CanBytes one(const char* hex) {
    const auto replies = ask(hex);
    return replies.size() == 1 ? replies[0] : CanBytes{};
  }
  static std::uint32_t abort_in(const CanBytes& reply) {
    return reply.size() == 8 && reply[0] == 0x80 ? little_endian(CanView(reply).subspan(4)) : 0;
  }
  void allow_blocks(std::uint8_t size = 16) {
    server.facts().block = true;
    server.facts().block_size = size;
  }

  Texts objects;
  SdoServer server{SdoFacts{}};
};

TEST_F(SdoServerTest, ALongObjectComesInSegments) {
  objects.held[{0x1008, 0}] = counting(9);
  EXPECT_EQ(one("40 08 10 00 00 00 00 00"), from_hex("41 08 10 00 09 00 00 00"));
  EXPECT_EQ(one("60 00 00 00 00 00 00 00"), from_hex("00 01 02 03 04 05 06 07"));
  EXPECT_EQ(one("70 00 00 00 00 00 00 00"), from_hex("1B 08 09 00 00 00 00 00"));
  EXPECT_TRUE(server.idle());
  EXPECT_EQ(abort_in(one("60 00 00 00 00 00 00 00")), sdo_abort::command);
}

TEST_F(SdoServerTest, ALongObjectIsWrittenInSegments) {
  EXPECT_EQ(one("21 00 20 01 09 00 00 00"), from_hex("60 00 20 01 00 00 00 00"));
  EXPECT_EQ(one("00 01 02 03 04 05 06 07"), from_hex("20 00 00 00 00 00 00 00"));
  EXPECT_TRUE(objects.held.empty());
  EXPECT_EQ(one("1B 08 09 00 00 00 00 00"), from_hex("30 00 00 00 00 00 00 00"));
  EXPECT_EQ((objects.held[{0x2000, 1}]), counting(9));
}

TEST_F(SdoServerTest, AWrongToggleOrLengthOrStepAbortsTheTransfer) {
  objects.held[{0x1008, 0}] = counting(9);
  (void)ask("40 08 10 00 00 00 00 00");
  EXPECT_EQ(abort_in(one("70 00 00 00 00 00 00 00")), sdo_abort::toggle);
  (void)ask("21 00 20 01 09 00 00 00");
  EXPECT_EQ(abort_in(one("10 01 02 03 04 05 06 07")), sdo_abort::toggle);
  (void)ask("21 00 20 01 09 00 00 00");
  EXPECT_EQ(abort_in(one("01 01 02 03 04 05 06 07")), 0x06070010U);
  EXPECT_EQ(abort_in(one("00 01 02 03 04 05 06 07")), sdo_abort::command);
  (void)ask("21 08 10 00 05 00 00 00");
  EXPECT_EQ(abort_in(one("05 01 02 03 04 05 00 00")), 0x06010002U);
  EXPECT_EQ(abort_in(one("21 00 20 01 00 00 01 00")), sdo_abort::out_of_memory);
  EXPECT_EQ(abort_in(one("E0 00 20 01 00 00 00 00")), sdo_abort::command);
}

TEST_F(SdoServerTest, AnAbortEndsATransferWithoutAnAnswer) {
  objects.held[{0x1008, 0}] = counting(9);
  (void)ask("40 08 10 00 00 00 00 00");
  EXPECT_THAT(ask("80 08 10 00 22 00 00 08"), IsEmpty());
  EXPECT_TRUE(server.idle());
  (void)ask("40 08 10 00 00 00 00 00");
  EXPECT_EQ(one("40 08 10 00 00 00 00 00")[0], 0x41);  // a new request replaces it
}

TEST_F(SdoServerTest, BlocksAreRefusedUnlessSwitchedOn) {
  EXPECT_EQ(abort_in(one("A4 08 10 00 10 00 00 00")), sdo_abort::command);
  EXPECT_EQ(abort_in(one("C6 00 20 01 09 00 00 00")), sdo_abort::command);
}

TEST_F(SdoServerTest, ABlockUploadCarriesACrcAndRepeatsWhatWasLost) {
  allow_blocks();
  objects.held[{0x1008, 0}] = counting(16);
  EXPECT_EQ(one("A4 08 10 00 02 00 00 00"), from_hex("C6 08 10 00 10 00 00 00"));
  EXPECT_THAT(ask("A3 00 00 00 00 00 00 00"),
              ElementsAre(from_hex("01 01 02 03 04 05 06 07"), from_hex("02 08 09 0A 0B 0C 0D 0E")));
  // The second was lost: it comes again, and the rest behind it.
  EXPECT_THAT(ask("A2 01 02 00 00 00 00 00"),
              ElementsAre(from_hex("01 08 09 0A 0B 0C 0D 0E"), from_hex("82 0F 10 00 00 00 00 00")));
  const CanBytes end = one("A2 02 02 00 00 00 00 00");
  EXPECT_EQ(end[0], 0xC1 | 5 << 2);
  EXPECT_EQ(little_endian(CanView(end).subspan(1, 2)), sdo_crc(counting(16)));
  EXPECT_THAT(ask("A1 00 00 00 00 00 00 00"), IsEmpty());
  EXPECT_TRUE(server.idle());
}

TEST_F(SdoServerTest, ABlockDownloadIsTakenWithTheRightCrcAlone) {
  EXPECT_EQ(sdo_crc(CanBytes{'1', '2', '3', '4', '5', '6', '7', '8', '9'}), 0x31C3);  // CiA 301, the usual check value
  allow_blocks(2);
  const std::uint16_t crc = sdo_crc(counting(9));
  for (const bool right : {false, true}) {
    EXPECT_EQ(one("C6 00 20 01 09 00 00 00"), from_hex("A4 00 20 01 02 00 00 00"));
    EXPECT_THAT(ask("01 01 02 03 04 05 06 07"), IsEmpty());
    EXPECT_EQ(one("82 08 09 00 00 00 00 00"), from_hex("A2 02 02 00 00 00 00 00"));
    CanBytes end{0xC1 | 5 << 2, static_cast<std::uint8_t>(crc), static_cast<std::uint8_t>(crc >> 8), 0, 0, 0, 0, 0};
    if (!right) ++end[1];
    const auto reply = server.answer(end, objects, 1, Time{});
    ASSERT_EQ(reply.size(), 1U);
    if (right) {
      EXPECT_EQ(reply[0][0], 0xA1);
    } else {
      EXPECT_EQ(abort_in(reply[0]), sdo_abort::crc);
    }
    EXPECT_EQ((objects.held.contains({0x2000, 1})), right);
  }
}

TEST_F(SdoServerTest, ALostSegmentOfABlockIsTold) {
  allow_blocks(3);
  (void)ask("C2 00 20 01 10 00 00 00");
  (void)ask("01 01 02 03 04 05 06 07");
  EXPECT_EQ(one("83 0F 10 00 00 00 00 00"), from_hex("A2 01 03 00 00 00 00 00"));
  EXPECT_THAT(ask("01 08 09 0A 0B 0C 0D 0E"), IsEmpty());
  EXPECT_EQ(one("82 0F 10 00 00 00 00 00"), from_hex("A2 02 03 00 00 00 00 00"));
  EXPECT_EQ(one("D5 00 00 00 00 00 00 00")[0], 0xA1);
  EXPECT_EQ((objects.held[{0x2000, 1}]), counting(16));
}

}  // namespace
}  // namespace axisgate::simulated
