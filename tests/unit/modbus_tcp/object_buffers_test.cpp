#include "gateway/upstream/modbus_tcp/object_buffers.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/unit/modbus_tcp/support/hex.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

using namespace std::chrono_literals;

constexpr Instant kStart = Instant{} + 1h;
constexpr ObjectKey kName{1, 0x1008, 0};
constexpr ObjectKey kVersion{1, 0x100A, 0};

ObjectBytes content(std::size_t size, Byte fill = 0) { return std::make_shared<const std::vector<Byte>>(size, fill); }

TEST(ObjectsReadInParts, AreKeptFor5sFromWhenTheyWereRead) {
  ObjectBuffers buffers;
  EXPECT_EQ(buffers.kept(kName, kStart), nullptr);
  buffers.keep(kName, content(300), kStart);
  ASSERT_NE(buffers.kept(kName, kStart + 4999ms), nullptr);
  EXPECT_EQ(buffers.kept(kName, kStart + 4999ms)->size(), 300U);
  EXPECT_EQ(buffers.kept(kName, kStart + 5s), nullptr) << "also where it was looked at meanwhile";
}

TEST(ObjectsReadInParts, AreToldApartByAxisIndexAndSubIndex) {
  ObjectBuffers buffers;
  buffers.keep({1, 0x1018, 1}, content(1), kStart);
  EXPECT_NE(buffers.kept({1, 0x1018, 1}, kStart), nullptr);
  EXPECT_EQ(buffers.kept({2, 0x1018, 1}, kStart), nullptr);
  EXPECT_EQ(buffers.kept({1, 0x1019, 1}, kStart), nullptr);
  EXPECT_EQ(buffers.kept({1, 0x1018, 2}, kStart), nullptr);
}

TEST(ObjectsReadInParts, AreReplacedByANewerReading) {
  ObjectBuffers buffers;
  buffers.keep(kName, content(300), kStart);
  buffers.keep(kName, content(5), kStart + 4s);
  ASSERT_NE(buffers.kept(kName, kStart + 8s), nullptr);
  EXPECT_EQ(buffers.kept(kName, kStart + 8s)->size(), 5U);
  buffers.forget(kName);
  buffers.forget(kVersion);
  EXPECT_EQ(buffers.kept(kName, kStart + 8s), nullptr);
}

TEST(ObjectsReadInParts, AreFewAtATimeAndTheOldestGivesWay) {
  ObjectBuffers buffers;
  for (std::uint16_t i = 0; i <= kMaxKeptObjects; ++i) buffers.keep({1, i, 0}, content(kMaxObjectBytes), kStart);
  EXPECT_EQ(buffers.kept({1, 0, 0}, kStart), nullptr);
  for (std::uint16_t i = 1; i <= kMaxKeptObjects; ++i) EXPECT_NE(buffers.kept({1, i, 0}, kStart), nullptr) << i;
}

class ObjectsWrittenInParts : public ::testing::Test {
 protected:
  bool part(std::size_t start, const std::string& data, const ObjectKey& key = kName) {
    return buffers.add_part(key, start, bytes(data), now);
  }
  std::string last(std::size_t start, const std::string& data, const ObjectKey& key = kName) {
    const auto whole = buffers.add_last(key, start, bytes(data), now);
    return whole ? hex_text(*whole) : "refused";
  }
  ObjectBuffers buffers;
  Instant now = kStart;
};

TEST_F(ObjectsWrittenInParts, ArePutTogether) {
  EXPECT_TRUE(part(0, "01 02"));
  EXPECT_TRUE(part(2, "03"));
  EXPECT_EQ(last(3, "04 05"), "01 02 03 04 05");
  EXPECT_EQ(last(5, "06"), "refused") << "it was over";
}

TEST_F(ObjectsWrittenInParts, MayBeOne) { EXPECT_EQ(last(0, "01 02"), "01 02"); }

TEST_F(ObjectsWrittenInParts, HaveNoGapAndNoOverlap) {
  for (const std::size_t start : {1U, 3U}) {
    EXPECT_TRUE(part(0, "01 02"));
    EXPECT_FALSE(part(start, "03")) << start;
    EXPECT_FALSE(part(2, "03")) << "all was dropped";
  }
  EXPECT_FALSE(part(1, "02")) << "nor do they begin in the middle";
  EXPECT_EQ(last(1, "02"), "refused");
}

TEST_F(ObjectsWrittenInParts, AreOfOneObject) {
  EXPECT_TRUE(part(0, "01 02"));
  EXPECT_EQ(last(2, "03", kVersion), "refused");
  EXPECT_EQ(last(2, "03"), "refused") << "all was dropped";
  EXPECT_TRUE(part(0, "01 02"));
  EXPECT_EQ(last(0, "07", kVersion), "07") << "a whole write of another one between";
  EXPECT_EQ(last(2, "03"), "01 02 03");
  EXPECT_TRUE(part(0, "01 02"));
  EXPECT_EQ(last(0, "07"), "07") << "a whole write of this one";
  EXPECT_EQ(last(2, "03"), "refused");
}

TEST_F(ObjectsWrittenInParts, BeginAnewAt0) {
  EXPECT_TRUE(part(0, "01 02"));
  EXPECT_TRUE(part(0, "0A"));
  EXPECT_EQ(last(1, "0B"), "0A 0B");
}

TEST_F(ObjectsWrittenInParts, WaitFor5sForTheNextPart) {
  EXPECT_TRUE(part(0, "01"));
  now += 4999ms;
  EXPECT_TRUE(part(1, "02"));
  now += 4999ms;
  EXPECT_EQ(last(2, "03"), "01 02 03");
  EXPECT_TRUE(part(0, "01"));
  now += 5s;
  EXPECT_EQ(last(1, "02"), "refused");
}

TEST_F(ObjectsWrittenInParts, EndAt4KiB) {
  const std::vector<Byte> piece(256, 7);
  for (std::size_t start = 0; start < kMaxObjectBytes - 256; start += 256) {
    EXPECT_TRUE(buffers.add_part(kName, start, piece, now));
  }
  ObjectBuffers other = buffers;
  EXPECT_EQ(other.add_last(kName, kMaxObjectBytes - 256, piece, now).value().size(), kMaxObjectBytes);
  EXPECT_TRUE(buffers.add_part(kName, kMaxObjectBytes - 256, piece, now));
  EXPECT_FALSE(buffers.add_last(kName, kMaxObjectBytes, Bytes(piece).first(1), now));
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
