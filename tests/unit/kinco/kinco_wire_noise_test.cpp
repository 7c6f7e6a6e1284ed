// A line that babbles: opened anew three times, then given up until it is quiet (faults.md row 6).
#include "tests/unit/kinco/kinco_wire_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class KincoWireNoise : public KincoWireStage {
 protected:
  /// Bytes that add up to nothing, each millisecond.
  void babble(Duration how_long) {
    for (const Instant end = runtime.now() + how_long; runtime.now() < end; runtime.advance_by(1ms))
      link->bring({0x55, 0x01});
  }
  void give_up() {
    babble(500ms);
    told.clear();
  }
};

TEST_F(KincoWireNoise, a_burst_is_skipped_and_counted) {
  wire->send(read_of(0x6041));
  babble(50ms);
  link->bring(from_hex(kStatusReply));
  EXPECT_THAT(told, ElementsAre("reply"));
  EXPECT_THAT(link->reopened, IsEmpty());
  EXPECT_EQ(wire->statistics().dropped_bytes, 100u);
  EXPECT_EQ(wire->statistics().bad_frames, 1u);
}

TEST_F(KincoWireNoise, after_100_ms_the_line_is_opened_anew) {
  babble(150ms);
  EXPECT_THAT(link->reopened, ElementsAre(HasSubstr("noise without a pause")));
  EXPECT_THAT(told, ElementsAre(HasSubstr("noise without a pause"), "up"));
}

TEST_F(KincoWireNoise, after_three_openings_in_a_row_it_is_given_up) {
  babble(3s);
  EXPECT_GE(link->reopened.size(), 3u);
  EXPECT_THAT(told, ElementsAre(HasSubstr("down"), "up", HasSubstr("down"), "up", HasSubstr("down"), "up",
                                HasSubstr("opened anew 3 times, waiting for silence")));
}

TEST_F(KincoWireNoise, an_answer_starts_the_count_anew) {
  for (int i = 0; i < 5; ++i) {
    babble(150ms);
    runtime.advance_by(1s);
    wire->send(read_of(0x6041));
    link->bring(from_hex(kStatusReply));
  }
  EXPECT_THAT(link->reopened, SizeIs(5));
  EXPECT_EQ(replies.size(), 5u);
}

TEST_F(KincoWireNoise, a_line_given_up_that_stays_noisy_is_opened_anew_each_second) {
  give_up();
  const std::size_t before = link->reopened.size();
  babble(5s);
  EXPECT_EQ(link->reopened.size(), before + 5);
  EXPECT_THAT(told, IsEmpty()) << "the bus hears of it once";
}

TEST_F(KincoWireNoise, a_line_given_up_is_taken_back_within_a_second_of_silence) {
  give_up();
  runtime.advance_by(1s);
  EXPECT_THAT(told, ElementsAre("up"));
  wire->send(read_of(0x6041));
  link->bring(from_hex(kStatusReply));
  EXPECT_EQ(replies.size(), 1u);
}

TEST_F(KincoWireNoise, a_line_given_up_and_then_pulled_comes_back_when_it_is_plugged_in) {
  give_up();
  link->events->on_link_down("/dev/ttyUSB0: hung up");
  runtime.advance_by(10s);
  EXPECT_THAT(told, IsEmpty()) << "down was told already";
  link->events->on_link_up();
  runtime.advance_by(1s);
  EXPECT_THAT(told, ElementsAre("up"));
}

TEST_F(KincoWireNoise, whole_frames_of_others_are_no_noise) {
  for (int i = 0; i < 1000; ++i) {
    link->bring(from_hex(kStatusReply));
    runtime.advance_by(1ms);
  }
  EXPECT_THAT(link->reopened, IsEmpty());
}

}  // namespace
}  // namespace axisgate::test
