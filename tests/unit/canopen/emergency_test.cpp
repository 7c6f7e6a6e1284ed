// EMCY frames, and storms of them.
#include "adapters/canopen/emergency.hpp"

#include "tests/unit/canopen/canopen_frames.hpp"

namespace axisgate::canopen {
namespace {

using namespace std::chrono_literals;

bus::Notice emergency(std::uint16_t code) {
  bus::Notice notice{.kind = bus::Notice::Kind::emergency, .node = 1};
  notice.code = code;
  return notice;
}

TEST(EmergencyFrame, has_code_register_and_five_bytes_of_the_maker) {
  const auto heard = decode_emergency(5, test::from_hex("30 81 10 01 02 03 04 05"));
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->node, 5);
  EXPECT_EQ(heard->code, 0x8130);
  EXPECT_EQ(heard->error_register, 0x10);
  EXPECT_THAT(heard->vendor, testing::ElementsAre(1, 2, 3, 4, 5));
}

TEST(EmergencyFrame, may_be_short_but_must_have_a_code) {
  EXPECT_EQ(decode_emergency(1, test::from_hex("30 81"))->code, 0x8130);
  EXPECT_EQ(decode_emergency(1, test::from_hex("30 81 10"))->error_register, 0x10);
  EXPECT_THAT(decode_emergency(1, test::from_hex("30 81 10 AA"))->vendor, testing::ElementsAre(0xAA, 0, 0, 0, 0));
  EXPECT_FALSE(decode_emergency(1, test::from_hex("30")));
  EXPECT_FALSE(decode_emergency(1, {}));
}

class EmergencyStorm : public testing::Test {
 protected:
  std::optional<bus::Notice> pass(std::uint16_t code) { return limit.pass(emergency(code), now); }
  Instant now = Instant{} + 1h;
  EmergencyLimit limit;
};

TEST_F(EmergencyStorm, the_first_ones_pass_and_the_last_one_comes_with_the_number_of_the_rest) {
  for (int i = 0; i < EmergencyLimit::kMaxEmergencies; ++i) {
    const auto told = pass(0x3210);
    ASSERT_TRUE(told);
    EXPECT_EQ(told->repeats, 0u);
  }
  for (int i = 0; i < 9; ++i) EXPECT_FALSE(pass(0x3210));
  EXPECT_FALSE(pass(0x4310));
  EXPECT_FALSE(limit.take_held(now));
  now += 1s;
  EXPECT_EQ(limit.next_deadline(), now);
  const auto last = limit.take_held(now);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->code, 0x4310) << "what it said last";
  EXPECT_EQ(last->repeats, 9u);
  EXPECT_FALSE(limit.take_held(now));
  EXPECT_EQ(limit.next_deadline(), kNever);
}

TEST_F(EmergencyStorm, error_reset_always_passes_and_counts_what_was_held_back_before) {
  for (int i = 0; i < 20; ++i) static_cast<void>(pass(0x3210));
  const auto reset = pass(0x0000);
  ASSERT_TRUE(reset);
  EXPECT_EQ(reset->repeats, 20u - EmergencyLimit::kMaxEmergencies);
  EXPECT_EQ(limit.next_deadline(), kNever) << "the error is over: what it was last is no news any more";
}

TEST_F(EmergencyStorm, emergencies_that_come_slowly_all_pass) {
  for (int i = 0; i < 50; ++i) {
    now += 300ms;
    EXPECT_TRUE(pass(0x3210)) << i;
  }
}

TEST_F(EmergencyStorm, no_second_has_more_than_the_limit_and_none_is_lost_count_of) {
  int told = 0;
  std::uint32_t repeats = 0;
  const int kHeard = 10'000;
  for (int i = 0; i < kHeard; ++i) {
    now += 1ms;
    if (const auto held = limit.take_held(now)) {
      ++told;
      repeats += held->repeats;
    }
    if (const auto notice = pass(0x3210)) {
      ++told;
      repeats += notice->repeats;
    }
  }
  now += 1s;
  if (const auto held = limit.take_held(now)) {
    ++told;
    repeats += held->repeats;
  }
  EXPECT_LE(told, 11 * EmergencyLimit::kMaxEmergencies);
  EXPECT_EQ(static_cast<std::uint32_t>(told) + repeats, static_cast<std::uint32_t>(kHeard));
}

}  // namespace
}  // namespace axisgate::canopen
