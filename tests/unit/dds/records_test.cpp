// SPDX-License-Identifier: Apache-2.0
// What the two processes say to each other: every kind comes through whole, and nothing that is not whole comes
// through.
#include "gateway/upstream/dds_link/records.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace axisgate::dds {
namespace {

using testing::Le;
using testing::SizeIs;

Guid a_guid() {
  Guid out{};
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<Byte>(0xF0 + i);
  return out;
}

BusRecord a_bus(std::string name) {
  return {std::move(name), 2, 999, 65535, 64, {1, 2, 3, 4, 5, 6, 7, 8, 9, UINT32_MAX}};
}

/// One of each kind, no two members alike.
std::vector<Record> one_of_each() {
  StateRecord state{3,     "lift", 123456789012345, 0xFFFFFFFE, 0x1237, -3,         -1.5,      2.25, -0.1,
                    1e300, 5e-324, 0x8130,          0xDEADBEEF, 0x8001, 0x10,       21.5,      40.0, 325.0,
                    2,     1,      0xFFFF,          0xFFF,      5,      0xFFFFFFFF, 0x7FFFFFFF};
  EventRecord event{499, -1, UINT64_MAX, 7, 0x06090011, "position wrapped"};
  GatewayRecord gateway{2, 499, 17, UINT32_MAX, 0x80, 5, {a_bus("can0"), a_bus("")}};
  ReplyRecord reply{1, UINT64_MAX, a_guid(), 21, 0x08000022};
  ObjectReplyRecord object_reply{2, 1, a_guid(), 2, 3, 4, {1, 2, 3}};
  BeatRecord beats{{a_guid(), Guid{}}, 123456789012345};
  CommandRecord command{
      a_guid(), -5, 123456789012345, {0xCAFEBABE, "cell_7"}, 1, 2, 33, -3, 0x7FF, 1, -2, 3, 4, 5, 6, 7, 8, -9, -4};
  ObjectRequestRecord object{a_guid(), -1, {7, "cell_8"}, 9, 8, true, 0x6040, 1, 4, 0xFFFFFFFF, {9}};
  return {state,
          event,
          gateway,
          reply,
          object_reply,
          ReadyRecord{"0.6.0"},
          LogRecord{3, "a line"},
          WriterRecord{a_guid(), -7, true, "192.168.1.7", LivelinessKind::manual_by_topic},
          beats,
          command,
          object,
          HeartbeatRecord{a_guid(), Guid{1, 2}, 0xFFFFFFFE, 300, -9, true},
          NamesakeRecord{a_guid(), 499, "192.168.1.8", true},
          JointCommandsRecord{a_guid(), 77, {"lift", "", "feeder"}, {1.5, -2, 0}, {3}, 2},
          RosActionRecord{a_guid(), -78, 499, 3},
          IdentityRecord{0x8001, a_guid()}};
}

TEST(Records, EveryKindComesThroughAsItWas) {
  const auto all = one_of_each();
  ASSERT_EQ(all.size(), std::variant_size_v<Record>);
  for (std::size_t kind = 0; kind < all.size(); ++kind) {
    ASSERT_EQ(all[kind].index(), kind) << "the order of the kinds is that on the wire";
    const Decoded back = decode(encode(all[kind]));
    EXPECT_EQ(back.error, DecodeError::none) << kind;
    EXPECT_TRUE(back.record == all[kind]) << kind;
  }
}

TEST(Records, NoValueComesThroughAsNone) {
  StateRecord state;
  state.position = std::numeric_limits<double>::quiet_NaN();
  state.velocity = -std::numeric_limits<double>::infinity();
  const Decoded back = decode(encode(state));
  ASSERT_EQ(back.error, DecodeError::none);
  EXPECT_TRUE(std::isnan(std::get<StateRecord>(back.record).position));
  EXPECT_EQ(std::get<StateRecord>(back.record).velocity, state.velocity);
}

TEST(Records, EveryOtherLengthIsRefused) {
  for (const Record& each : one_of_each()) {
    const std::vector<Byte> whole = encode(each);
    for (std::size_t size = 0; size < whole.size(); ++size)
      EXPECT_NE(decode(Bytes(whole).first(size)).error, DecodeError::none) << each.index() << " cut at " << size;
    std::vector<Byte> longer = whole;
    longer.push_back(0);
    EXPECT_EQ(decode(longer).error, DecodeError::length) << each.index();
  }
}

TEST(Records, AFlippedByteIsRefusedOrIsAnotherRecordOfTheSameLength) {
  for (const Record& each : one_of_each()) {
    const std::vector<Byte> whole = encode(each);
    for (std::size_t at = 0; at < whole.size(); ++at) {
      for (const unsigned flip : {0x01U, 0x80U, 0xFFU}) {
        std::vector<Byte> broken = whole;
        broken[at] = static_cast<Byte>(broken[at] ^ flip);
        const Decoded out = decode(broken);
        EXPECT_TRUE(at != 0 || out.error == DecodeError::version);
        EXPECT_TRUE(out.error != DecodeError::none || encode(out.record).size() == whole.size()) << each.index();
      }
    }
  }
}

TEST(Records, AnotherVersionAnUnknownKindAndNothingAreRefusedByName) {
  EXPECT_EQ(decode({}).error, DecodeError::too_short);
  EXPECT_EQ(decode(std::vector<Byte>{kLinkVersion}).error, DecodeError::too_short);
  EXPECT_EQ(decode(std::vector<Byte>{kLinkVersion + 1, 0}).error, DecodeError::version);
  EXPECT_EQ(decode(std::vector<Byte>{kLinkVersion, std::variant_size_v<Record>}).error, DecodeError::kind);
  EXPECT_EQ(decode(std::vector<Byte>{kLinkVersion, 0}).error, DecodeError::length);
  for (const auto error :
       {DecodeError::none, DecodeError::too_short, DecodeError::version, DecodeError::kind, DecodeError::length})
    EXPECT_NE(text(error, "axisgate-dds"), "");
}

TEST(Records, ACountThatCannotBeTrueIsRefused) {
  std::vector<Byte> packet = encode(BeatRecord{});
  packet[packet.size() - 2] = 0xFF;
  packet[packet.size() - 1] = 0xFF;
  EXPECT_EQ(decode(packet).error, DecodeError::length);
}

TEST(Records, WhatIsLongerThanItsBoundIsCutAndEveryPacketHasOne) {
  const Decoded event = decode(encode(EventRecord{1, 0, 1, 0, 0, std::string(1000, 'x')}));
  ASSERT_EQ(event.error, DecodeError::none);
  EXPECT_THAT(std::get<EventRecord>(event.record).text, SizeIs(kMaxText));

  GatewayRecord many;
  many.buses.assign(300, a_bus(std::string(300, 'b')));
  const std::vector<Byte> packet = encode(many);
  EXPECT_THAT(packet, SizeIs(Le(kMaxPacket)));
  const Decoded gateway = decode(packet);
  ASSERT_EQ(gateway.error, DecodeError::none);
  EXPECT_THAT(std::get<GatewayRecord>(gateway.record).buses, SizeIs(kMaxBusesShown));

  ObjectReplyRecord object;
  object.data.assign(kMaxObjectBytes + 1, 7);
  EXPECT_THAT(encode(object), SizeIs(Le(kMaxPacket)));
  EXPECT_EQ(decode(encode(object)).error, DecodeError::none);
  JointCommandsRecord joints;
  joints.names.assign(2000, std::string(300, 'j'));
  joints.positions.assign(2000, 1);
  joints.velocities.assign(2000, 1);
  EXPECT_THAT(encode(joints), SizeIs(Le(kMaxPacket)));
  EXPECT_EQ(decode(encode(joints)).error, DecodeError::none);
  BeatRecord beats;
  beats.writers.resize(2 * kMaxBeats);
  EXPECT_THAT(std::get<BeatRecord>(decode(encode(beats)).record).writers, SizeIs(kMaxBeats));
}

}  // namespace
}  // namespace axisgate::dds
