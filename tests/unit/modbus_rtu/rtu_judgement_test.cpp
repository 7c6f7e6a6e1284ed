// SPDX-License-Identifier: Apache-2.0
// A frame is the answer only if everything in it fits: what differs in one byte, or is shorter or longer, is not.
#include "tests/unit/modbus_rtu/rtu_frames.hpp"

namespace axisgate::modbus_rtu {
namespace {

using namespace test;

struct Pair {
  const char* name;
  bus::Exchange exchange;
  const char* reply;
};
void PrintTo(const Pair& pair, std::ostream* out) { *out << pair.name; }

class RtuAnswer : public testing::TestWithParam<Pair> {
 protected:
  [[nodiscard]] std::optional<bus::ExchangeResult> taken(const ByteRow& frame) const {
    const Judgement judgement = judge(frame, GetParam().exchange, kinco_node());
    const auto* result = std::get_if<bus::ExchangeResult>(&judgement);
    return result == nullptr ? std::nullopt : std::optional(*result);
  }
  const ByteRow reply_ = from_hex(GetParam().reply);
};

TEST_P(RtuAnswer, is_taken_as_it_is_and_neither_shorter_nor_longer_nor_from_another_unit) {
  EXPECT_TRUE(taken(reply_));
  for (std::size_t size = 0; size < reply_.size(); ++size) {
    EXPECT_FALSE(taken({reply_.begin(), reply_.begin() + static_cast<std::ptrdiff_t>(size)})) << size << " bytes";
  }
  for (std::size_t extra = 1; extra <= kMaxFrame - reply_.size(); ++extra) {
    EXPECT_FALSE(taken(reply_ + ByteRow(extra, 0))) << extra << " more";
  }
  bus::Exchange other = GetParam().exchange;
  other.node = 2;
  EXPECT_EQ(judged(reply_, other, kinco_node(2)), "from another unit");
}

/// Of a read, the data may be anything; of an error, the code.
TEST_P(RtuAnswer, is_not_taken_for_this_answer_with_any_byte_changed) {
  const bool is_error = (reply_[1] & kErrorBit) != 0;
  const bool is_read = reply_[1] == 0x03;
  for (std::size_t at = 0; at < reply_.size(); ++at) {
    const bool is_content = is_error ? at == 2 : is_read && at >= 3;
    for (int to = 0; to < 256; ++to) {
      if (to == reply_[at]) continue;
      ByteRow changed = reply_;
      changed[at] = static_cast<Byte>(to);
      const auto result = taken(changed);
      if (is_content) {
        ASSERT_TRUE(result) << "byte " << at << " = " << to;
        EXPECT_NE(result, taken(reply_)) << "another content is another result";
      } else if (result) {
        // The one way to become another answer: 0x81 and 0x83 both say that a read has failed.
        EXPECT_TRUE(is_error && at == 1 && (to == 0x81 || to == 0x83)) << "byte " << at << " = " << to;
        EXPECT_EQ(result->code, Errc::refused_by_drive);
      }
    }
  }
}

const Pair kPairs[] = {
    {"read_of_one_register", read_of(0x3200, 2), "01 03 02 C0 37"},
    {"read_of_two_registers", read_of(0x3700, 4), "01 03 04 C3 50 00 00"},
    {"read_of_a_block", block_of(108, 2, {{109, 2}, {110, 4}}), "01 03 08 00 01 00 02 00 04 00 05"},
    {"write_of_one_register", write_of(0x3100, 0x0F, 2), "01 06 31 00 00 0F"},
    {"write_of_two_registers", write_of(0x6F00, 0x85555, 4), "01 10 6F 00 00 02"},
    {"error_of_a_read", read_of(0x3200, 2), "01 83 02"},
    {"error_of_a_read_as_kinco_prints_it", read_of(0x3200, 2), "01 81 02"},
    {"error_of_a_write_of_one_register", write_of(0x3100, 0x0F, 2), "01 86 03"},
    {"error_of_a_write_of_two_registers", write_of(0x6F00, 0x85555, 4), "01 90 03"},
};
INSTANTIATE_TEST_SUITE_P(Each, RtuAnswer, testing::ValuesIn(kPairs),
                         [](const testing::TestParamInfo<Pair>& it) { return std::string(it.param.name); });

TEST(RtuJudgement, says_why_a_frame_is_not_the_answer) {
  const auto why = [](const char* reply, const bus::Exchange& exchange) { return judged(from_hex(reply), exchange); };
  EXPECT_EQ(why("01 06 32 00 00 01", read_of(0x3200)), "another function");
  EXPECT_EQ(why("01 03 04 C0 37 00 00", read_of(0x3200)), "another length") << "of a read that asked for two";
  EXPECT_EQ(why("01 06 31 00 00 1F", write_of(0x3100, 0x0F, 2)), "another echo");
  EXPECT_EQ(why("01 10 6F 00 00 01", write_of(0x6F00, 1, 4)), "another echo");
  EXPECT_EQ(why("01 03 02 C0 37 00", read_of(0x3200)), "malformed") << "its count of bytes contradicts its length";
  EXPECT_EQ(why("01", read_of(0x3200)), "malformed");
  EXPECT_EQ(why("", read_of(0x3200)), "malformed");
  EXPECT_EQ(why("01 03 02 00 64", read_of(200)), shown(value_of(200, 2, 100)))
      << "a read of another place with the same length cannot be told apart: why a drive that was late gets a "
         "resynchronisation read";
}

TEST(RtuJudgement, every_exception_code_is_the_drives_refusal_and_says_whether_it_may_pass) {
  for (int code = 0; code < 256; ++code) {
    const bool for_ever = code == 1 || code == 2;
    for (const auto& [function, exchange] : {std::pair(0x83, read_of(0x3200)), std::pair(0x86, write_of(0x3100, 1, 2)),
                                             std::pair(0x90, write_of(0x6F00, 1, 4))}) {
      const ByteRow reply{1, static_cast<Byte>(function), static_cast<Byte>(code)};
      EXPECT_EQ(judged(reply, exchange), shown(refusal_of(static_cast<std::uint32_t>(code), !for_ever)));
    }
  }
}

TEST(RtuJudgement, the_error_function_of_a_node_counts_for_its_reads_alone) {
  const ByteRow reply = from_hex("01 81 02");
  EXPECT_EQ(judged(reply, read_of(0x3200)), shown(refusal_of(2)));
  EXPECT_EQ(judged(reply, write_of(0x3100, 1, 2)), "another function");
  EXPECT_EQ(judged(reply, write_of(0x6F00, 1, 4)), "another function");
  EXPECT_EQ(judged(reply, read_of(0x3200), stepper_node()), "another function");
}

TEST(RtuWellFormed, is_what_could_be_a_reply_to_some_request_of_ours) {
  for (const char* frame : {"07 03 02 00 00", "07 06 00 00 00 00", "07 10 00 00 00 02", "07 83 02", "07 FF 02",
                            "07 01 01 01", "07 02 01 00", "07 04 02 00 00", "07 05 00 00 FF 00"}) {
    EXPECT_TRUE(well_formed(from_hex(frame))) << frame;
  }
  for (const char* frame : {"07 03 02 00", "07 03 01 00", "07 03 00", "07 03", "07 06 00 00 00", "07 14 02 00 00",
                            "07 01 02 00", "07 83 02 00", "07 11 00 00 00 00", "07", ""}) {
    EXPECT_FALSE(well_formed(from_hex(frame))) << frame;
  }
}

}  // namespace
}  // namespace axisgate::modbus_rtu
