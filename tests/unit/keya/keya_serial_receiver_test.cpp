// SPDX-License-Identifier: Apache-2.0
// Which of several possible frames is meant: RS232 has no sum, so only the form of a frame and what follows it tell.
#include "adapters/keya/keya_serial_receiver.hpp"

#include "tests/unit/keya/keya_frames.hpp"

namespace axisgate::keya {
namespace {

using test::from_hex;
using testing::ElementsAre;
using testing::IsEmpty;
using test::operator+;
using Heard = SerialReceiver::Heard;

class KeyaReceiver : public testing::Test {
 protected:
  void ask(std::uint16_t index, KeyaLine line = KeyaLine::rs232) {
    receiver = SerialReceiver(line);
    const bus::Exchange query = test::read_of(index);
    receiver.sent(query, encode(line, request_of(line, query)));
  }
  std::vector<Heard> take(const test::ByteRow& bytes) {
    std::vector<Heard> heard;
    for (const Byte byte : bytes) {
      if (const Heard one = receiver.take(byte); one != Heard::nothing) heard.push_back(one);
    }
    return heard;
  }
  std::vector<Heard> take(std::string_view hex) { return take(from_hex(hex)); }
  [[nodiscard]] std::string frame() const { return hex_text(receiver.frame_bytes()); }

  SerialReceiver receiver{KeyaLine::rs232};
};

constexpr std::string_view kStandingB = "ED 02 01 F5 00 00 00 00 00 00 00 00";

TEST_F(KeyaReceiver, a_fragment_with_the_start_of_the_answer_before_it_does_not_shift_its_fields) {
  ask(0x2102);
  EXPECT_THAT(take(from_hex("ED 02") + from_hex(kStandingB)), ElementsAre(Heard::answer));
  EXPECT_EQ(frame(), kStandingB) << "not 0xED02 for motor A";
  EXPECT_EQ(receiver.dropped_bytes(), 2u);
}

TEST_F(KeyaReceiver, data_that_look_like_the_answers_start_are_heard_when_silence_or_another_frame_follows) {
  constexpr std::string_view kLooksDouble = "ED 02 00 07 ED 02 00 00 00 00 00 00";
  ask(0x2102);
  EXPECT_THAT(take(kLooksDouble), IsEmpty()) << "the answer may begin at the second ED";
  EXPECT_EQ(receiver.on_silence(), Heard::answer);
  EXPECT_EQ(frame(), kLooksDouble);
  ask(0x2102);
  EXPECT_THAT(take(from_hex(kLooksDouble) + from_hex(test::kBeat232)), ElementsAre(Heard::answer, Heard::heartbeat));
}

TEST_F(KeyaReceiver, an_answer_whose_unused_bytes_are_not_0_is_none) {
  ask(0x2105);
  EXPECT_THAT(take("ED 05 31 00 00 00 00 00 00 00 00 01"), IsEmpty());
  EXPECT_EQ(receiver.on_silence(), Heard::nothing);
  EXPECT_EQ(receiver.dropped_bytes(), 12u);
}

TEST_F(KeyaReceiver, of_an_undocumented_answer_all_ten_bytes_are_taken) {
  for (const char* hex : {"ED 01 11 22 33 44 55 66 77 88 99 AA", "ED 04 11 22 33 44 55 66 77 88 99 AA"}) {
    ask(static_cast<std::uint16_t>(kQueryIndex + from_hex(hex)[1]));
    EXPECT_THAT(take(hex), ElementsAre(Heard::answer));
  }
}

TEST_F(KeyaReceiver, a_heartbeat_with_the_answers_start_in_it_is_no_answer_whatever_its_sum) {
  // Motor A at angle 0x00ED with fault word 0x02..; then with the drive at 2 degC and fault 0x00ED.
  for (const char* beat : {"EE 00 ED 02 00 22 31 02 58 00 00 55", "EE 00 05 00 ED 02 31 00 00 00 00 55",
                           "EE 00 05 00 ED 02 00 00 00 00 00 00"}) {
    for (const bool answer_follows : {false, true}) {
      ask(0x2102);
      auto heard = take(from_hex(beat) + (answer_follows ? from_hex(kStandingB) : test::ByteRow{}));
      if (const Heard last = receiver.on_silence(); last != Heard::nothing) heard.push_back(last);
      if (answer_follows) {
        EXPECT_THAT(heard, ElementsAre(Heard::heartbeat, Heard::answer)) << beat;
        EXPECT_EQ(frame(), kStandingB);
      } else {
        EXPECT_THAT(heard, ElementsAre(Heard::heartbeat)) << beat;
      }
      EXPECT_EQ(receiver.odd_heartbeats(), 1u);
    }
  }
}

TEST_F(KeyaReceiver, a_start_byte_of_a_heartbeat_before_an_answer_does_not_swallow_it) {
  for (const char* noise : {"EE", "EE 00", "EE 00 01 02", "EE EE", "E0", "E0 01 00 00", "ED", "ED 0A"}) {
    ask(0x2102);
    EXPECT_THAT(take(from_hex(noise) + from_hex(kStandingB)), ElementsAre(Heard::answer)) << noise;
    EXPECT_EQ(receiver.dropped_bytes(), from_hex(noise).size());
  }
}

TEST_F(KeyaReceiver, a_heartbeat_that_lost_a_byte_does_not_take_the_answer_along) {
  for (std::size_t lost = 0; lost < 12; ++lost) {
    test::ByteRow beat = from_hex(test::kBeat232);
    beat.erase(beat.begin() + static_cast<std::ptrdiff_t>(lost));
    ask(0x2102);
    EXPECT_THAT(take(beat + from_hex(kStandingB)), ElementsAre(Heard::answer)) << "without byte " << lost;
    EXPECT_EQ(receiver.lost_frames(), 1u);
  }
}

TEST_F(KeyaReceiver, a_heartbeat_with_neither_sum_nor_angles_is_noise) {
  EXPECT_THAT(take("EE 03 E9 00 00 22 31 00 00 00 00 55"), IsEmpty());
  EXPECT_THAT(take("EE 03 E8 00 00 22 31 00 00 00 00 55"), ElementsAre(Heard::heartbeat));
}

TEST_F(KeyaReceiver, on_rs485_the_answer_is_found_in_well_summed_frames_of_others) {
  ask(0x2102, KeyaLine::rs485);
  EXPECT_THAT(take(from_hex("E0 02 00 00 00 00 00 00 00 00 00 E2") + from_hex(test::kFaults485) +
                   from_hex("ED 02 02 01 F5 FE 0E 00 00 00 00 F3") + from_hex(test::kSpeed485)),
              ElementsAre(Heard::foreign, Heard::late, Heard::late, Heard::answer));
  EXPECT_EQ(receiver.foreign_frames(), 1u);
  EXPECT_EQ(receiver.late_replies(), 2u);
}

TEST_F(KeyaReceiver, on_rs485_a_code_that_no_query_has_is_no_frame) {
  ask(0x2102, KeyaLine::rs485);
  EXPECT_THAT(take("ED 01 0A 00 00 00 00 00 00 00 00 F8"), IsEmpty());
  EXPECT_THAT(take("E0 01 04 00 00 00 00 00 00 00 00 E5"), IsEmpty());
}

TEST_F(KeyaReceiver, a_frame_that_began_before_the_request_is_late_though_noise_before_it_has_given_way) {
  EXPECT_THAT(take("E0 ED 02"), IsEmpty());
  const bus::Exchange query = test::read_of(0x2102);
  receiver.sent(query, encode(KeyaLine::rs232, request_of(KeyaLine::rs232, query)));
  EXPECT_THAT(take("01 F5 00 00 00 00 00 00 00 00"), ElementsAre(Heard::late));
  EXPECT_THAT(take(kStandingB), ElementsAre(Heard::answer));
}

}  // namespace
}  // namespace axisgate::keya
