// Long objects: chains of exchanges, segmented and in blocks, against a server of the standard.
#include "tests/unit/canopen/sdo_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

using SdoTransfer = SdoStage;

constexpr std::size_t kSizes[] = {1, 2, 3, 4, 5, 7, 8, 14, 15, 21, 22, 28, 111, 112, 113, 224, 300, 4090, 4095, 4096};

/// Whatever its length: the object itself, as field or as bytes.
ByteRow content(const std::optional<bus::ExchangeResult>& result) {
  if (!result || result->code != Errc::ok) return {};
  if (result->bytes) return *result->bytes;
  ByteRow bytes(result->fields.at(0).size);
  store_le(bytes, 0, bytes.size(), result->fields.at(0).raw);
  return bytes;
}

TEST_F(SdoTransfer, objects_of_every_length_are_read_in_segments) {
  for (const bool size_told : {true, false}) {
    server.indicates_size = size_told;
    for (const std::size_t size : kSizes) {
      server.objects[kObject] = content_of(size);
      EXPECT_EQ(content(transfer(long_read_of(kObject))), content_of(size)) << size;
      EXPECT_TRUE(server.idle());
    }
  }
  EXPECT_EQ(wire->statistics().late_replies + wire->statistics().bad_frames, 0u);
}

TEST_F(SdoTransfer, objects_of_every_length_are_written_in_segments) {
  for (const std::size_t size : kSizes) {
    EXPECT_EQ(transfer(long_write_of(kObject, content_of(size))), bus::ExchangeResult{}) << size;
    EXPECT_EQ(server.objects[kObject], content_of(size)) << size;
    EXPECT_TRUE(server.idle());
  }
}

TEST_F(SdoTransfer, objects_of_every_length_are_read_in_blocks) {
  begin_with_blocks();
  for (const bool threshold : {false, true}) {
    server.honours_threshold = threshold;
    for (const std::size_t size : kSizes) {
      server.objects[kObject] = content_of(size);
      EXPECT_EQ(content(transfer(long_read_of(kObject))), content_of(size)) << size;
      EXPECT_TRUE(server.idle());
    }
  }
  EXPECT_THAT(server.aborts_heard, IsEmpty());
}

TEST_F(SdoTransfer, objects_of_every_length_are_written_in_blocks) {
  begin_with_blocks();
  for (const bool crc : {true, false}) {
    server.does_crc = crc;
    for (const std::size_t size : kSizes) {
      EXPECT_EQ(transfer(long_write_of(kObject, content_of(size))), bus::ExchangeResult{}) << size;
      EXPECT_EQ(server.objects[kObject], content_of(size)) << size;
    }
  }
  EXPECT_THAT(server.aborts_heard, IsEmpty());
}

TEST_F(SdoTransfer, a_block_has_sixteen_segments_at_most_and_is_one_exchange) {
  begin_with_blocks();
  server.objects[kObject] = content_of(4096);
  transfer(long_read_of(kObject));
  EXPECT_EQ(exchanges, 1 + 37) << "586 segments in blocks of 16";
  transfer(long_write_of(kObject, content_of(4096)));
  EXPECT_EQ(exchanges, 1 + 37);
}

TEST_F(SdoTransfer, a_server_that_wants_longer_blocks_gets_segments) {
  begin_with_blocks();
  for (const std::uint8_t size : std::initializer_list<std::uint8_t>{17, 127, 0}) {
    server.block_size = size;
    server.aborts_heard.clear();
    EXPECT_EQ(transfer(long_write_of(kObject, content_of(200))), bus::ExchangeResult{});
    EXPECT_EQ(server.objects[kObject], content_of(200));
    EXPECT_THAT(server.aborts_heard, ElementsAre(0x05040002u));
  }
}

TEST_F(SdoTransfer, a_server_that_wants_shorter_blocks_gets_them) {
  begin_with_blocks();
  server.block_size = 3;
  EXPECT_EQ(transfer(long_write_of(kObject, content_of(200))), bus::ExchangeResult{});
  EXPECT_EQ(server.objects[kObject], content_of(200));
}

TEST_F(SdoTransfer, a_server_that_knows_no_blocks_after_all_gets_segments) {
  begin_with_blocks();
  server.offers_block = false;
  server.objects[kObject] = content_of(100);
  EXPECT_EQ(content(transfer(long_read_of(kObject))), content_of(100));
  EXPECT_EQ(transfer(long_write_of(kObject, content_of(50))), bus::ExchangeResult{});
  EXPECT_EQ(server.objects[kObject], content_of(50));
}

TEST_F(SdoTransfer, segments_lost_in_a_block_are_sent_again) {
  begin_with_blocks();
  for (const int lost : {1, 2, 9, 15, 16}) {
    server.objects[kObject] = content_of(300);
    if (lost != 16) {  // a lost end of a block is a silence: the timeout's
      server.lose = {lost};
      EXPECT_EQ(content(transfer(long_read_of(kObject))), content_of(300)) << lost;
    }
    server.lose = {lost};
    EXPECT_EQ(transfer(long_write_of(kObject, content_of(299))), bus::ExchangeResult{}) << lost;
    EXPECT_EQ(server.objects[kObject], content_of(299)) << lost;
  }
}

TEST_F(SdoTransfer, blocks_of_which_nothing_arrives_end_the_transfer) {
  begin_with_blocks();
  server.lose = {1, 1, 1, 1, 1, 1, 1, 1};
  const auto lose_first = [&](ByteRow& row) { return row[0] != 0x01; };
  spoil = lose_first;
  server.objects[kObject] = content_of(300);
  const auto result = transfer(long_read_of(kObject));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->code, Errc::bad_reply);
  EXPECT_EQ(result->detail, 0x05040003u);
  EXPECT_THAT(server.aborts_heard, ElementsAre(0x05040003u));
  EXPECT_EQ(exchanges, 1 + 3);
}

TEST_F(SdoTransfer, content_whose_crc_is_wrong_is_not_handed_on) {
  begin_with_blocks();
  server.objects[kObject] = content_of(300);
  spoil = [](ByteRow& row) {
    if (row[0] == 0x05) row[3] ^= 1;
    return true;
  };
  const auto result = transfer(long_read_of(kObject));
  EXPECT_EQ(result->code, Errc::bad_reply);
  EXPECT_EQ(result->detail, 0x05040004u);
  EXPECT_THAT(server.aborts_heard, ElementsAre(0x05040004u));
}

TEST_F(SdoTransfer, content_longer_or_shorter_than_told_is_not_handed_on) {
  for (const std::size_t claimed : std::initializer_list<std::size_t>{19, 21}) {
    server.objects[kObject] = content_of(20);
    server.aborts_heard.clear();
    spoil = [&](ByteRow& row) {
      if (row[0] == 0x41) row[4] = static_cast<Byte>(claimed);
      return true;
    };
    const auto result = transfer(long_read_of(kObject));
    EXPECT_EQ(result->code, Errc::bad_reply);
    EXPECT_THAT(server.aborts_heard, ElementsAre(0x06070010u)) << claimed;
  }
}

TEST_F(SdoTransfer, objects_over_four_kibibytes_are_refused_wherever_it_shows) {
  server.objects[kObject] = content_of(4097);
  EXPECT_EQ(transfer(long_read_of(kObject)), refusal_of(0x05040005)) << "as told";
  EXPECT_EQ(exchanges, 1);
  server.indicates_size = false;
  EXPECT_EQ(transfer(long_read_of(kObject)), refusal_of(0x05040005)) << "as counted";
  begin_with_blocks();
  served = 0;
  EXPECT_EQ(transfer(long_read_of(kObject)), refusal_of(0x05040005)) << "as counted in blocks";
  server.objects[kObject] = content_of(5000);
  EXPECT_EQ(transfer(long_read_of(kObject)), refusal_of(0x05040005)) << "as counted in blocks, before the end";
  EXPECT_THAT(server.aborts_heard, testing::Each(0x05040005u));
  EXPECT_EQ(server.aborts_heard.size(), 4u);
}

TEST_F(SdoTransfer, a_segment_that_looks_like_an_abort_of_the_object_is_a_segment_also_when_it_comes_twice) {
  begin_with_blocks();
  server.objects[kObject] = content_of(28);
  const ByteRow object = from_hex("00 20 00");
  std::copy(object.begin(), object.end(), server.objects[kObject].begin() + 21);
  spoil = [&](ByteRow& row) {
    if (row[0] == 0x84) bring(can::data_frame(0x581, row));
    return true;
  };
  EXPECT_EQ(content(transfer(long_read_of(kObject))), server.objects[kObject]);
  EXPECT_EQ(wire->statistics().late_replies, 1u);
}

TEST_F(SdoTransfer, anything_else_with_the_node_ends_an_open_chain) {
  server.objects[kObject] = content_of(100);
  server.objects[0x6041] = {0x37, 0x02};
  ASSERT_TRUE(exchange(long_read_of(kObject))->more);
  EXPECT_EQ(exchange(read_of(0x6041, 0, 2)), value_of(0x6041, 2, 0x0237));
  EXPECT_THAT(server.aborts_heard, ElementsAre(0x08000022u));
  // What was open is gone: going on with it is refused, and nothing is sent for it.
  const std::size_t sent = link->sent.size();
  EXPECT_EQ(exchange(next_of(long_read_of(kObject))), refusal_of(0x08000022, true));
  EXPECT_EQ(link->sent.size(), sent);
}

TEST_F(SdoTransfer, an_nmt_command_ends_an_open_chain_too) {
  server.objects[kObject] = content_of(100);
  ASSERT_TRUE(exchange(long_read_of(kObject))->more);
  EXPECT_EQ(exchange(nmt_of(0x81, 1)), bus::ExchangeResult{});
  EXPECT_THAT(server.aborts_heard, ElementsAre(0x08000022u));
}

TEST_F(SdoTransfer, a_server_that_waited_too_long_ends_its_chain_and_is_no_twin) {
  server.objects[kObject] = content_of(100);
  ASSERT_TRUE(exchange(long_read_of(kObject))->more);
  bring(0x581, "80 00 20 00 00 00 04 05");
  EXPECT_THAT(notices, IsEmpty());
  EXPECT_EQ(exchange(next_of(long_read_of(kObject))), refusal_of(0x08000022, true));
  EXPECT_THAT(server.aborts_heard, IsEmpty()) << "there is nothing left to abort";
}

TEST_F(SdoTransfer, a_server_that_answers_an_abort_is_no_twin) {
  server.objects[kObject] = content_of(100);
  EXPECT_EQ(exchange(read_of(kObject)), refusal_of(0x06070010));
  bring(0x581, "80 00 20 00 00 00 04 05");
  ASSERT_TRUE(exchange(long_read_of(kObject))->more);
  EXPECT_EQ(exchange(nmt_of(0x80, 1)), bus::ExchangeResult{});
  bring(0x581, "80 00 20 00 00 00 04 05");
  EXPECT_THAT(notices, IsEmpty());
}

TEST_F(SdoTransfer, exchanges_with_other_nodes_leave_a_chain_open) {
  server.objects[kObject] = content_of(20);
  const auto what = long_read_of(kObject);
  ASSERT_TRUE(exchange(what)->more);
  wire->send(read_of(0x6041, 0, 2, 2));
  bring(0x582, "4B 41 60 00 37 02 00 00");
  ASSERT_TRUE(exchange(next_of(what))->more);
  ASSERT_TRUE(exchange(next_of(what))->more);
  EXPECT_EQ(content(exchange(next_of(what))), content_of(20));
}

}  // namespace
}  // namespace axisgate::test
