// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/wire/general_reference.hpp"

#include <gtest/gtest.h>

#include "gateway/upstream/modbus_tcp/wire/pdu.hpp"
#include "tests/unit/modbus_tcp/support/hex.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

std::optional<GeneralReference> decoded(const std::string& pdu) { return decode_reference(bytes(pdu)); }

/// A request of axis 1's object 1008h:3 with this control byte and the fields it says are there.
std::vector<Byte> request_with(unsigned control, const std::string& data = {}) {
  std::vector<Byte> pdu{0x2B, 0x0D, static_cast<Byte>(control)};
  if ((control & 0x40) != 0) pdu.push_back(0);
  pdu.push_back(0);
  if ((control & 0x20) != 0) pdu.push_back(0x77);
  if ((control & 0x04) != 0) pdu.push_back(0x01);
  if ((control & 0x02) != 0) pdu.push_back(0x50);
  const auto rest = bytes("05 10 08 03 00 00");
  pdu.insert(pdu.end(), rest.begin(), rest.end());
  const auto content = bytes(data);
  pdu.insert(pdu.end(), {0, static_cast<Byte>(content.size())});
  pdu.insert(pdu.end(), content.begin(), content.end());
  return pdu;
}

TEST(GeneralReferences, TakeEveryControlByteOfTheContractAndNoOther) {
  for (unsigned control = 0; control < 256; ++control) {
    SCOPED_TRACE(control);
    const bool write = (control & 0x01) != 0;
    const auto found = decode_reference(request_with(control, write ? "AA BB" : ""));
    const bool reserved = (control & 0x18) != 0;
    const bool only_of_writes = (control & 0xC0) != 0;
    ASSERT_EQ(found.has_value(), !reserved && (write || !only_of_writes));
    if (!found) continue;
    EXPECT_EQ(found->write, write);
    EXPECT_EQ(found->more_follows, (control & 0x80) != 0);
    EXPECT_EQ(found->node, (control & 0x04) != 0 ? 0x0105 : 0x0005) << "the network id is the high byte";
    EXPECT_EQ(found->index, 0x1008);
    EXPECT_EQ(found->subindex, 3);
    EXPECT_EQ(found->count, write ? 2 : 0);
    const auto request = request_with(control, write ? "AA BB" : "");
    EXPECT_EQ(found->data_at(), request.size() - (write ? 2 : 0));
  }
}

TEST(GeneralReferences, AreNeverTakenInPart) {
  for (const unsigned control : {0x00U, 0x01U, 0x26U, 0x27U, 0xE7U}) {
    const auto whole = request_with(control, (control & 1) != 0 ? "11 22 33 44" : "");
    ASSERT_TRUE(decode_reference(whole));
    for (std::size_t size = 2; size < whole.size(); ++size) {
      EXPECT_FALSE(decode_reference(Bytes(whole).first(size))) << control << ", " << size << " bytes";
    }
    auto longer = whole;
    longer.push_back(0);
    EXPECT_FALSE(decode_reference(longer)) << "and none with more";
  }
}

TEST(GeneralReferences, DoNotGuessAtReservedBytes) {
  EXPECT_FALSE(decoded("2B 0D 00 01 01 10 08 00 00 00 00 00"));
  EXPECT_TRUE(decoded("2B 0D 41 00 00 01 10 08 00 00 00 00 01 AA"));
  EXPECT_FALSE(decoded("2B 0D 41 01 00 01 10 08 00 00 00 00 01 AA")) << "the second control byte";
  EXPECT_FALSE(decode_reference(request_with(0x01)) || decode_reference(request_with(0x81))) << "a write of nothing";
}

TEST(GeneralReferences, FillOnePdu) {
  const auto shortest = decoded("2B 0D 00 00 01 10 08 00 00 00 00 00");
  ASSERT_TRUE(shortest);
  EXPECT_EQ(room_for_data(*shortest), 241U);
  EXPECT_EQ(reference_reply(*shortest, std::vector<Byte>(241), true).size(), kMaxPdu);
  const auto longest = decode_reference(request_with(0xE7, "AA"));
  ASSERT_TRUE(longest);
  EXPECT_EQ(longest->head.size(), kMaxReferenceHead);
  EXPECT_EQ(room_for_data(*longest), 237U);
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
