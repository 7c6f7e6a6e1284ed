// Nodes that flood the bus (one id, or all of them) are thinned and named.
#include "adapters/can/babble_watch.hpp"

#include "tests/unit/canopen/canopen_wire_stage.hpp"

namespace axisgate::test {
namespace {

using can::BabbleWatch;
using testing::ElementsAre;
using Kind = bus::Notice::Kind;

TEST(BabbleWatchTest, lets_the_limit_through_in_each_second_and_tells_once_in_ten) {
  BabbleWatch watch(50);
  Instant now = Instant{} + 1h;
  int told = 0;
  for (int second = 0; second < 20; ++second) {
    int passed = 0;
    for (int i = 0; i < 1000; ++i, now += 1ms) {
      const auto verdict = watch.on_frame(now);
      passed += verdict.pass ? 1 : 0;
      told += verdict.tell ? 1 : 0;
    }
    EXPECT_EQ(passed, 50);
  }
  EXPECT_EQ(told, 2);
}

TEST(BabbleWatchTest, says_nothing_of_a_rate_within_the_limit) {
  BabbleWatch watch(50);
  Instant now = Instant{} + 1h;
  for (int i = 0; i < 1000; ++i, now += 21ms) {
    const auto verdict = watch.on_frame(now);
    ASSERT_TRUE(verdict.pass && !verdict.tell) << i;
  }
}

class Babble : public CanopenWireStage {
 protected:
  void flood(std::uint32_t id, std::string_view hex, int frames) {
    for (int i = 0; i < frames; ++i) bring(id, hex);
  }
  [[nodiscard]] auto of(Kind kind) const { return std::ranges::count(kinds(), kind); }
};

TEST_F(Babble, process_data_at_full_bus_load_are_thinned_and_their_id_named) {
  wire->map_process_data(1, 3, {{{0x6041, 0}, 2}});
  flood(0x381, "37 06", 5000);
  EXPECT_EQ(of(Kind::values), can::kMaxProcessDataPerSecond);
  ASSERT_EQ(of(Kind::babbling), 1);
  EXPECT_EQ(std::ranges::find(notices, Kind::babbling, &bus::Notice::kind)->code, 0x381);
}

TEST_F(Babble, heartbeats_and_emergencies_are_thinned_by_themselves) {
  flood(0x702, "05", 200);
  flood(0x082, "10 32 04", 200);
  EXPECT_EQ(of(Kind::babbling), 2);
  EXPECT_EQ(of(Kind::present), 1);
  bring(0x081, "10 32 04");
  EXPECT_EQ(notices.back().node, 1) << "other nodes are heard as ever";
  EXPECT_EQ(notices.back().kind, Kind::emergency);
}

TEST_F(Babble, replies_that_nobody_asked_for_are_counted_and_named_and_the_true_one_is_still_taken) {
  wire->send(read_of(0x6041));
  flood(0x581, "4B 42 60 00 37 02 00 00", 500);
  EXPECT_THAT(kinds(), ElementsAre(Kind::babbling));
  EXPECT_EQ(notices[0].code, 0x581);
  bring(0x581, "4B 41 60 00 37 02 00 00");
  EXPECT_EQ(replies.size(), 1u);
}

TEST_F(Babble, frames_that_are_no_replies_are_counted_once_and_named) {
  flood(0x581, "E0 00 00 00", 500);
  EXPECT_THAT(kinds(), ElementsAre(Kind::babbling));
  EXPECT_EQ(wire->statistics().bad_frames, 500u);
}

TEST_F(Babble, replies_that_were_asked_for_come_as_fast_as_we_ask) {
  for (int i = 0; i < 2000; ++i) {
    wire->send(read_of(0x6041));
    bring(0x581, "4B 41 60 00 37 02 00 00");
  }
  EXPECT_EQ(replies.size(), 2000u);
  EXPECT_THAT(notices, testing::IsEmpty());
}

}  // namespace
}  // namespace axisgate::test
