// SPDX-License-Identifier: Apache-2.0
// object_request: sizes, values and bytes, and what its reply says.
#include <gmock/gmock.h>

#include "tests/unit/dds/plain_session.hpp"

namespace axisgate::dds {
namespace {

using test::guid;
using test::PlainSession;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

struct Objects : testing::Test {
  PlainSession plain;
  std::uint64_t id = 0;
  ObjectRequestRecord request(bool write, std::uint8_t size, std::uint32_t value = 0, std::vector<Byte> data = {}) {
    return {guid(1), 0, {}, 1, ++id, write, 0x6083, 2, size, value, std::move(data)};
  }
  int ask(const ObjectRequestRecord& record) {
    plain.port.submitted.clear();
    return plain.ask<ObjectReplyRecord>(record);
  }
  ObjectReplyRecord answered(const ObjectRequestRecord& record, const BatchResult& result) {
    static_cast<void>(plain.read());
    plain.port.submitted.clear();
    plain.session->on_record(record, plain.now);
    plain.port.submitted.at(0).on_result(result);
    const auto replies = plain.read<ObjectReplyRecord>();
    EXPECT_THAT(replies, SizeIs(1));
    return replies.at(0);
  }
};

TEST_F(Objects, AReadClaimsNothingAndAWriteClaims) {
  plain.port.at_once = BatchResult{};
  EXPECT_EQ(ask(request(false, 4)), 2);
  const WriteBatch read = plain.port.submitted.at(0).batch;
  EXPECT_FALSE(read.claims);
  ASSERT_TRUE(read.object);
  EXPECT_EQ(read.object->index, 0x6083);
  EXPECT_EQ(read.object->subindex, 2);
  EXPECT_EQ(read.object->size, 4);
  EXPECT_FALSE(read.object->write);
  EXPECT_EQ(ask(request(true, 2, 0xFFFFFFFF)), 2) << "-1";
  const WriteBatch write = plain.port.submitted.at(0).batch;
  EXPECT_TRUE(write.claims);
  EXPECT_TRUE(write.object->write);
  EXPECT_EQ(write.object->data, 0xFFFFU);
}

TEST_F(Objects, AWriterThatMakesWayForACommandOfItsParticipantIsStillThere) {
  plain.port.at_once = BatchResult{};
  EXPECT_EQ(ask(request(true, 2, 1)), 2);
  const auto life = plain.port.submitted.at(0).batch.life;
  plain.image.find(1)->lease.owner = life;
  EXPECT_EQ(plain.ask(test::command(guid(1, 2), 1, 1)), 2);
  EXPECT_TRUE(life->connected);
}

TEST_F(Objects, MoreBytesThanADriveTakesAreRefused) {
  plain.port.at_once = BatchResult{};
  EXPECT_EQ(ask(request(true, 0, 0, std::vector<Byte>(kMaxObjectBytes))), 2);
  EXPECT_EQ(ask(request(true, 0, 0, std::vector<Byte>(kMaxObjectBytes + 1))), 17);
}

TEST_F(Objects, OfNoSizeThatThereIsOrAValueThatDoesNotFitAreRefused) {
  plain.port.at_once = BatchResult{};
  for (const std::uint8_t size : std::initializer_list<std::uint8_t>{3, 5, 8, 255})
    EXPECT_EQ(ask(request(false, size)), 17) << int{size};
  EXPECT_EQ(ask(request(true, 1, 0x100)), 17);
  EXPECT_EQ(ask(request(true, 1, 0xFF7F)), 17);
  EXPECT_EQ(ask(request(true, 2, 0x10000)), 17);
  EXPECT_EQ(ask(request(true, 0)), 17) << "no bytes";
  EXPECT_THAT(plain.port.submitted, IsEmpty());
  EXPECT_EQ(ask(request(true, 1, 0xFF)), 2);
  EXPECT_EQ(ask(request(true, 1, 0xFFFFFF80)), 2) << "-128";
  EXPECT_EQ(ask(request(true, 4, 0xFFFFFFFF)), 2);
}

TEST_F(Objects, BytesGoOutAsTheyAre) {
  plain.port.at_once = BatchResult{};
  EXPECT_EQ(ask(request(true, 0, 0, {3, 1, 2})), 2);
  ASSERT_TRUE(plain.port.submitted.at(0).batch.object->bytes);
  EXPECT_THAT(*plain.port.submitted.at(0).batch.object->bytes, ElementsAre(3, 1, 2));
}

TEST_F(Objects, WhatIsReadComesAsAValueAndAsItsBytes) {
  const auto word = answered(request(false, 2), {{}, 0x1234, 2});
  EXPECT_EQ(word.result, 2);
  EXPECT_EQ(word.value, 0x1234U);
  EXPECT_THAT(word.data, ElementsAre(0x34, 0x12));
  const auto bytes = std::make_shared<const std::vector<Byte>>(std::vector<Byte>{'K', 'i', 'n', 'c', 'o'});
  const auto text = answered(request(false, 0), {{}, 0, 0, bytes});
  EXPECT_EQ(text.value, 0U);
  EXPECT_THAT(text.data, ElementsAre('K', 'i', 'n', 'c', 'o'));
  const auto three = std::make_shared<const std::vector<Byte>>(std::vector<Byte>{1, 2, 3});
  EXPECT_EQ(answered(request(false, 0), {{}, 0, 0, three}).value, 0x030201U);
}

TEST_F(Objects, ARefusalCarriesItsAbortCode) {
  const auto refused = answered(request(true, 2, 1), {{Errc::refused_by_drive, 3}, 0, 0, {}, 0x08000000});
  EXPECT_EQ(refused.result, 3);
  EXPECT_EQ(refused.detail, 0x08000000U);
  EXPECT_THAT(refused.data, IsEmpty());
  EXPECT_EQ(answered(request(false, 2), {{Errc::timed_out, 0}}).result, 4);
}

TEST_F(Objects, ThatComeAgainAreNotRunAgain) {
  plain.port.at_once = BatchResult{};
  const auto write = request(true, 2, 1);
  EXPECT_EQ(ask(write), 2);
  EXPECT_EQ(ask(write), 21);
  EXPECT_THAT(plain.port.submitted, IsEmpty());
  ObjectRequestRecord no_id = request(true, 2, 1);
  no_id.request_id = 0;
  EXPECT_EQ(ask(no_id), 17);
  ObjectRequestRecord elsewhere = request(true, 2, 1);
  elsewhere.axis = 7;
  EXPECT_EQ(ask(elsewhere), 20);
}

}  // namespace
}  // namespace axisgate::dds
