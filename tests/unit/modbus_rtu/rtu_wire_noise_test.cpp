// A line that babbles: opened anew three times, then given up until it is quiet.
#include "tests/unit/modbus_rtu/rtu_wire_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class RtuWireNoise : public RtuWireStage {
 protected:
  /// Bytes that are no frame, each millisecond.
  void babble(Duration how_long) {
    for (const Instant end = runtime.now() + how_long; runtime.now() < end; runtime.advance_by(1ms)) {
      link->events->on_bad_frame(link->newest, 2);
    }
  }
  void give_up() {
    babble(500ms);
    told.clear();
  }
  void exchange() {
    wire->send(read_of(0x3200));
    link->bring("01 03 02 C0 37");
  }
};

TEST_F(RtuWireNoise, a_burst_is_one_bad_frame_and_keeps_no_answer_away) {
  wire->send(read_of(0x3200));
  babble(50ms);
  link->bring("01 03 02 C0 37");
  EXPECT_THAT(told, ElementsAre("reply"));
  EXPECT_THAT(link->reopened, IsEmpty());
  EXPECT_EQ(wire->statistics().dropped_bytes, 100u);
  EXPECT_EQ(wire->statistics().bad_frames, 1u);
}

TEST_F(RtuWireNoise, spoilt_answers_with_pauses_between_them_are_a_bad_frame_each) {
  for (int i = 0; i < 10; ++i) {
    wire->send(read_of(0x3200));
    link->events->on_bad_frame(link->newest, 7);
    runtime.advance_by(50ms);
    wire->abandon();
  }
  EXPECT_EQ(wire->statistics().bad_frames, 10u);
  EXPECT_EQ(wire->statistics().dropped_bytes, 70u);
  EXPECT_THAT(link->reopened, IsEmpty());
  EXPECT_THAT(replies, IsEmpty());
}

TEST_F(RtuWireNoise, after_100_ms_the_line_is_opened_anew) {
  babble(150ms);
  EXPECT_THAT(link->reopened, ElementsAre(HasSubstr("noise without a pause")));
  EXPECT_THAT(told, ElementsAre(HasSubstr("noise without a pause"), "up"));
}

TEST_F(RtuWireNoise, after_three_openings_in_a_row_it_is_given_up_with_what_was_asked) {
  wire->send(read_of(0x3200));
  babble(3s);
  EXPECT_THAT(told, ElementsAre(HasSubstr("down"), "up", HasSubstr("down"), "up", HasSubstr("down"), "up",
                                HasSubstr("opened anew 3 times, waiting for silence")));
  link->bring("01 03 02 C0 37");
  EXPECT_THAT(replies, IsEmpty());
}

TEST_F(RtuWireNoise, a_link_that_cannot_be_opened_anew_is_given_up_all_the_same) {
  link->opens_again = false;
  babble(3s);
  ASSERT_THAT(told, SizeIs(1));
  link->events->on_link_up();
  runtime.advance_by(2s);
  exchange();
  EXPECT_EQ(replies.size(), 1u);
}

TEST_F(RtuWireNoise, an_answer_starts_the_count_anew) {
  for (int i = 0; i < 5; ++i) {
    babble(150ms);
    runtime.advance_by(1s);
    exchange();
  }
  EXPECT_THAT(link->reopened, SizeIs(5));
  EXPECT_EQ(replies.size(), 5u);
}

TEST_F(RtuWireNoise, a_line_given_up_that_stays_noisy_is_opened_anew_each_second) {
  give_up();
  const std::size_t before = link->reopened.size();
  babble(5s);
  EXPECT_EQ(link->reopened.size(), before + 5);
  EXPECT_THAT(told, IsEmpty()) << "the bus hears of it once";
}

TEST_F(RtuWireNoise, a_line_given_up_is_taken_back_within_a_second_of_silence) {
  give_up();
  runtime.advance_by(1s);
  EXPECT_THAT(told, ElementsAre("up"));
  exchange();
  EXPECT_EQ(replies.size(), 1u);
}

TEST_F(RtuWireNoise, a_line_given_up_and_then_pulled_comes_back_when_it_is_plugged_in) {
  give_up();
  link->events->on_link_down("/dev/ttyUSB0: hung up");
  runtime.advance_by(10s);
  EXPECT_THAT(told, IsEmpty()) << "down was told already";
  link->events->on_link_up();
  runtime.advance_by(1s);
  EXPECT_THAT(told, ElementsAre("up"));
}

}  // namespace
}  // namespace axisgate::test
