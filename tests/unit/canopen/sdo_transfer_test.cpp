// SPDX-License-Identifier: Apache-2.0
// Long objects: chains of exchanges, segmented and in blocks, against a server of the standard.
#include "tests/unit/canopen/sdo_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::size_t kSizes[] = {1, 2, 3, 4, 5, 7, 8, 14, 15, 21, 22, 28, 111, 112, 113, 224, 300, 4090, 4095, 4096};

/// Whatever its length: the object itself, as field or as bytes.
ByteRow content(const std::optional<bus::ExchangeResult>& result) {
  if (!result || result->code != Errc::ok) return {};
  if (result->bytes) return *result->bytes;
  ByteRow bytes(result->fields.at(0).size);
  store_le(bytes, 0, bytes.size(), result->fields.at(0).raw);
  return bytes;
}

class SdoTransfer : public SdoStage {
 protected:
  void expect_reads(std::initializer_list<std::size_t> sizes) { expect_reads(std::vector<std::size_t>(sizes)); }
  template <typename Sizes>
  void expect_reads(const Sizes& sizes) {
    for (const std::size_t size : sizes) {
      server.objects[kObject] = content_of(size);
      EXPECT_EQ(content(transfer(long_read_of(kObject))), content_of(size)) << size;
      EXPECT_TRUE(server.idle());
    }
  }
  void expect_writes(std::initializer_list<std::size_t> sizes) { expect_writes(std::vector<std::size_t>(sizes)); }
  template <typename Sizes>
  void expect_writes(const Sizes& sizes) {
    for (const std::size_t size : sizes) {
      EXPECT_EQ(transfer(long_write_of(kObject, content_of(size))), bus::ExchangeResult{}) << size;
      EXPECT_EQ(server.objects[kObject], content_of(size)) << size;
      EXPECT_TRUE(server.idle());
    }
  }
  /// A chain of a long read that is open, its first exchange over.
  bus::Exchange open_chain(std::size_t size = 100) {
    server.objects[kObject] = content_of(size);
    const auto result = exchange(long_read_of(kObject));
    EXPECT_TRUE(result && result->more);
    return next_of(long_read_of(kObject));
  }
  /// The read ends as bad, with that code, which the server is told.
  void expect_bad_read(std::uint32_t code) {
    server.aborts_heard.clear();
    const auto result = transfer(long_read_of(kObject));
    ASSERT_TRUE(result);
    EXPECT_EQ(result->code, Errc::bad_reply);
    EXPECT_EQ(result->detail, code);
    EXPECT_THAT(server.aborts_heard, ElementsAre(code));
  }
};

TEST_F(SdoTransfer, objects_of_every_length_are_read_and_written_in_segments) {
  for (const bool size_told : {true, false}) {
    server.indicates_size = size_told;
    expect_reads(kSizes);
  }
  expect_writes(kSizes);
  EXPECT_EQ(wire->statistics().late_replies + wire->statistics().bad_frames, 0u);
}

TEST_F(SdoTransfer, objects_of_every_length_are_read_and_written_in_blocks) {
  begin_with_blocks();
  for (const bool switched : {false, true}) {
    server.honours_threshold = switched;
    expect_reads(kSizes);
    server.does_crc = !switched;
    expect_writes(kSizes);
    server.does_crc = true;
  }
  EXPECT_THAT(server.aborts_heard, IsEmpty());
}

TEST_F(SdoTransfer, a_block_has_sixteen_segments_at_most_and_is_one_exchange) {
  begin_with_blocks();
  expect_reads({4096});
  EXPECT_EQ(exchanges, 1 + 37) << "586 segments in blocks of 16";
  expect_writes({4096});
  EXPECT_EQ(exchanges, 1 + 37);
}

TEST_F(SdoTransfer, a_server_that_wants_shorter_blocks_gets_them_and_one_that_wants_longer_ones_or_none_gets_segments) {
  begin_with_blocks();
  server.block_size = 3;
  expect_writes({200});
  EXPECT_THAT(server.aborts_heard, IsEmpty());
  for (const std::uint8_t size : std::initializer_list<std::uint8_t>{17, 127, 0}) {
    server.block_size = size;
    server.aborts_heard.clear();
    expect_writes({200});
    EXPECT_THAT(server.aborts_heard, ElementsAre(0x05040002u));
  }
  server.offers_block = false;
  expect_reads({100});
  expect_writes({50});
}

TEST_F(SdoTransfer, segments_lost_in_a_block_are_sent_again) {
  begin_with_blocks();
  for (const int lost : {1, 2, 9, 15, 16}) {
    SCOPED_TRACE(lost);
    server.lose = {lost};
    if (lost != 16) expect_reads({300});  // a lost end of a block is a silence: the timeout's
    server.lose = {lost};
    expect_writes({299});
  }
}

TEST_F(SdoTransfer, blocks_of_which_nothing_arrives_end_the_transfer) {
  begin_with_blocks();
  spoil = [](ByteRow& row) { return row[0] != 0x01; };
  server.objects[kObject] = content_of(300);
  expect_bad_read(0x05040003);
  EXPECT_EQ(exchanges, 1 + 3);
}

TEST_F(SdoTransfer, content_with_a_wrong_crc_or_of_another_length_than_told_is_not_handed_on) {
  for (const int claimed : {19, 21}) {
    server.objects[kObject] = content_of(20);
    spoil = [&](ByteRow& row) {
      if (row[0] == 0x41) row[4] = static_cast<Byte>(claimed);
      return true;
    };
    expect_bad_read(0x06070010);
  }
  begin_with_blocks();
  served = 0;
  server.objects[kObject] = content_of(300);
  spoil = [](ByteRow& row) {
    if (row[0] == 0x05) row[3] ^= 1;
    return true;
  };
  expect_bad_read(0x05040004);
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
  EXPECT_EQ(server.aborts_heard, std::vector<std::uint32_t>(4, 0x05040005));
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

TEST_F(SdoTransfer, anything_else_with_the_node_ends_an_open_chain_and_with_other_nodes_leaves_it_open) {
  const bus::Exchange goes_on = open_chain();
  wire->send(read_of(0x6041, 0, 2, 2));
  bring(0x582, "4B 41 60 00 37 02 00 00");
  EXPECT_TRUE(exchange(goes_on)->more);
  server.objects[0x6041] = {0x37, 0x02};
  EXPECT_EQ(exchange(read_of(0x6041, 0, 2)), value_of(0x6041, 2, 0x0237));
  EXPECT_THAT(server.aborts_heard, ElementsAre(0x08000022u));
  // What was open is gone: going on with it is refused, and nothing is sent for it.
  const std::size_t sent = link->sent.size();
  EXPECT_EQ(exchange(goes_on), refusal_of(0x08000022, true));
  EXPECT_EQ(link->sent.size(), sent);
  server.aborts_heard.clear();
  open_chain();
  EXPECT_EQ(exchange(nmt_of(0x81, 1)), bus::ExchangeResult{});
  EXPECT_THAT(server.aborts_heard, ElementsAre(0x08000022u)) << "an NMT command ends it, too";
}

TEST_F(SdoTransfer, a_server_that_waited_too_long_ends_its_chain_and_is_no_second_device) {
  const bus::Exchange goes_on = open_chain();
  bring(0x581, "80 00 20 00 00 00 04 05");
  EXPECT_THAT(unsolicited_events, IsEmpty());
  EXPECT_EQ(exchange(goes_on), refusal_of(0x08000022, true));
  EXPECT_THAT(server.aborts_heard, IsEmpty()) << "there is nothing left to abort";
}

TEST_F(SdoTransfer, a_node_that_restarts_between_two_parts_has_no_chain_to_go_on_with) {
  const bus::Exchange goes_on = open_chain();
  bring(0x701, "00");
  const std::size_t sent = link->sent.size();
  EXPECT_EQ(exchange(goes_on), refusal_of(0x08000022, true));
  EXPECT_EQ(link->sent.size(), sent);
}

TEST_F(SdoTransfer, a_server_that_answers_an_abort_is_no_second_device) {
  server.objects[kObject] = content_of(100);
  EXPECT_EQ(exchange(read_of(kObject)), refusal_of(0x06070010, true));
  bring(0x581, "80 00 20 00 00 00 04 05");
  open_chain();
  EXPECT_EQ(exchange(nmt_of(0x80, 1)), bus::ExchangeResult{});
  bring(0x581, "80 00 20 00 00 00 04 05");
  EXPECT_THAT(unsolicited_events, IsEmpty());
}

}  // namespace
}  // namespace axisgate::test
