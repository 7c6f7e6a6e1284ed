// SPDX-License-Identifier: Apache-2.0
// Frames over libmodbus on a pty: whole ones with their number, and everything that is none.
#include <poll.h>

#include "tests/unit/modbus_rtu/id286pro_frames.hpp"
#include "tests/unit/modbus_rtu/libmodbus_link_stage.hpp"

namespace axisgate::test {
namespace {

using testing::Each;
using testing::IsEmpty;
using testing::SizeIs;

class LibmodbusFrames : public LibmodbusLinkStage {
 protected:
  void SetUp() override { open_at(pty.device()); }
  void expect_frames(const std::vector<std::string>& expected) {
    EXPECT_TRUE(await([&] { return diary.frames.size() >= expected.size(); }));
    EXPECT_EQ(diary.frames, expected);
  }
  void expect_noise(std::size_t bytes) {
    EXPECT_TRUE(await([&] { return diary.dropped() >= bytes; }));
    EXPECT_EQ(diary.dropped(), bytes);
  }
  /// No frame, but noise to its last byte; the worker listens for frames again once something was sent.
  void expect_noise_only(const ByteRow& bad) {
    diary.frames.clear();
    const std::size_t before = diary.dropped();
    answer(pty, bad);
    ASSERT_TRUE(await([&] { return diary.dropped() == before + bad.size(); })) << hex_text(bad);
    ask(pty);
    EXPECT_THAT(diary.frames, IsEmpty());
  }
  Pty pty;
};

TEST_F(LibmodbusFrames, carry_the_crc_that_the_sheets_print) {
  modbus_rtu::ExchangeNumber number = 0;
  for (const SheetExchange& sheet : kId286pro) {
    link->transmit(++number, modbus_rtu::request_of(sheet.exchange, stepper_node()));
    EXPECT_EQ(request_at(pty, from_hex(sheet.request).size()), sheet.request);
    answer(pty, from_hex(sheet.reply));
    EXPECT_TRUE(await([&] { return diary.frames.size() == number; }));
    EXPECT_EQ(diary.frames.back(), fmt::format("{}: {}", number, hex_text(without_crc(from_hex(sheet.reply)))));
  }
  EXPECT_EQ(diary.noise, 0u);
}

TEST_F(LibmodbusFrames, the_longest_there_are_go_both_ways) {
  const ByteRow longest = from_hex("01 10 00 00 00 7B F6") + ByteRow(246, 0x5A);
  link->transmit(1, longest);
  EXPECT_EQ(request_at(pty, 255), hex_text(with_crc(longest)));
  const ByteRow reply = from_hex("01 03 FA") + ByteRow(250, 0xA5);
  answer(pty, with_crc(reply));
  expect_frames({"1: " + hex_text(reply)});
}

TEST_F(LibmodbusFrames, an_answer_split_at_any_byte_is_one_answer) {
  modbus_rtu::ExchangeNumber number = 0;
  for (const char* reply : {"01 03 04 C3 50 00 00", "01 06 31 00 00 0F", "01 10 6F 00 00 02", "01 83 02"}) {
    const ByteRow bytes = with_crc(reply);
    for (std::size_t cut = 1; cut < bytes.size(); ++cut) {
      send(++number, "01 03 32 00 00 02");
      request_at(pty, 8);
      answer(pty, ByteRow(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(cut)));
      context.restart();
      context.run_for(1ms);  // mostly long enough for the first part to be read alone; right either way
      answer(pty, ByteRow(bytes.begin() + static_cast<std::ptrdiff_t>(cut), bytes.end()));
      ASSERT_TRUE(await([&] { return diary.frames.size() == number; })) << reply << " cut at " << cut;
      EXPECT_EQ(diary.frames.back(), fmt::format("{}: {}", number, reply));
    }
  }
  EXPECT_EQ(diary.noise, 0u);
}

TEST_F(LibmodbusFrames, glued_together_they_are_told_one_by_one_errors_as_kinco_prints_them_among_them) {
  const std::vector<std::string> frames{"01 03 02 C0 37", "02 06 31 00 00 0F", "01 83 02",
                                        "01 81 02",       "01 86 03",          "01 90 04",
                                        "01 FF 0B",       "01 10 6F 00 00 02", "FA 03 04 00 01 00 02"};
  ByteRow glued;
  std::vector<std::string> expected;
  for (const std::string& frame : frames) {
    glued = glued + with_crc(frame);
    expected.push_back("0: " + frame);
  }
  answer(pty, glued);
  expect_frames(expected);
  EXPECT_EQ(diary.noise, 0u);
}

TEST_F(LibmodbusFrames, of_every_unit_are_told_and_only_with_a_right_crc) {
  // libmodbus leaves the CRC of all units but the one asked to us, and knows none above 247.
  send(1, "FE 03 32 00 00 01");
  request_at(pty, 8);
  for (int unit = 1; unit < 255; ++unit) {  // 0 and 255 answer nothing: they are glitches
    SCOPED_TRACE(unit);
    ByteRow frame = with_crc(ByteRow{static_cast<Byte>(unit), 0x03, 0x02, 0x12, 0x34});
    diary.frames.clear();
    answer(pty, frame);
    expect_frames({"1: " + hex_text(without_crc(frame))});
    frame.back() ^= 1;
    expect_noise_only(frame);
  }
}

// --- What libmodbus cannot skip ------------------------------------------------------------------------------------

TEST_F(LibmodbusFrames, behind_glitch_bytes_are_heard_at_once_glued_to_them_or_not) {
  // The patience is 20 s here: a frame that the glitch had spoilt would not come.
  for (const Byte glitch : {Byte{0x00}, Byte{0xFF}}) {
    for (std::size_t size = 1; size <= bus::GlitchSkip::kMost; ++size) {
      for (const bool glued : {true, false}) {
        SCOPED_TRACE(testing::Message() << size << " of " << int{glitch} << (glued ? " glued" : " alone"));
        diary.frames.clear();
        diary.skipped = 0;
        ask(pty);
        const ByteRow before(size, glitch);
        if (!glued) {
          answer(pty, before);
          ASSERT_TRUE(await([&] { return diary.skipped == size; }));
        }
        answer(pty, (glued ? before : ByteRow{}) + with_crc("01 03 02 C0 37"));
        expect_frames({"1: 01 03 02 C0 37"});
        EXPECT_EQ(diary.skipped, size);
      }
    }
  }
  EXPECT_EQ(diary.noise, 0u);
}

TEST_F(LibmodbusFrames, behind_the_copy_of_their_request_are_heard_though_it_looks_like_the_head_of_a_longer_one) {
  // 0x31 would be the number of bytes that follow.
  send(1, "01 03 31 00 00 02");
  request_at(pty, 8);
  answer(pty, "01 03 31 00 00 02");
  expect_frames({"1: 01 03 31 00 00 02"});
  answer(pty, "01 03 04 C3 50 00 00");
  expect_frames({"1: 01 03 31 00 00 02", "1: 01 03 04 C3 50 00 00"});
  diary.frames.clear();
  send(2, "01 10 6F 00 00 02 04 55 55 00 08");
  request_at(pty, 13);
  answer(pty, from_hex("00") + with_crc("01 10 6F 00 00 02 04 55 55 00 08") + from_hex("FF") +
                  with_crc("01 10 6F 00 00 02"));
  expect_frames({"2: 01 10 6F 00 00 02 04 55 55 00 08", "2: 01 10 6F 00 00 02"});
  EXPECT_EQ(diary.noise, 0u);
}

// --- What nobody asked for -----------------------------------------------------------------------------------------

TEST_F(LibmodbusFrames, nobody_asked_for_carry_the_number_of_the_newest_request) {
  answer(pty, "01 03 02 00 01");
  expect_frames({"0: 01 03 02 00 01"});
  ask(pty, 7);
  answer(pty, "01 03 02 00 02");
  answer(pty, "01 03 02 00 03");
  expect_frames({"0: 01 03 02 00 01", "7: 01 03 02 00 02", "7: 01 03 02 00 03"});
}

TEST_F(LibmodbusFrames, that_came_before_a_request_is_sent_are_told_with_the_older_number) {
  const int far_side = ::open(pty.device().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(far_side, 0);
  for (modbus_rtu::ExchangeNumber number = 1; number <= 200; ++number) {
    ask(pty, number);
    answer(pty, "01 03 02 00 01");  // too late for its exchange, and yet before the next
    int waiting = 0;
    ASSERT_TRUE(
        await([&] { return diary.frames.size() == number || (::ioctl(far_side, FIONREAD, &waiting), waiting > 0); }));
    send(number + 1, "01 03 37 00 00 02");
    request_at(pty, 8);
    ASSERT_TRUE(await([&] { return diary.frames.size() == number; }));
    ASSERT_EQ(diary.frames.back(), fmt::format("{}: 01 03 02 00 01", number));
  }
  ::close(far_side);
}

TEST_F(LibmodbusFrames, a_core_that_has_no_time_is_kept_from_a_flood_and_told_what_it_missed) {
  // The far end has sent more than any buffer holds, so the worker has read it, while the core's loop stood still.
  const ByteRow frame = with_crc("01 03 02 C0 37");
  std::size_t sent = 0;
  while (sent < 15'000 * frame.size()) {
    pollfd room{pty.master(), POLLOUT, 0};
    ASSERT_EQ(::poll(&room, 1, 60'000), 1);
    const ssize_t taken = ::write(pty.master(), frame.data() + sent % frame.size(), frame.size() - sent % frame.size());
    if (taken > 0) sent += static_cast<std::size_t>(taken);
  }
  context.restart();
  context.poll_one();
  EXPECT_LE(diary.frames.size(), modbus_rtu::PortWorker::kMaxHeard) << "in one turn of the loop";
  EXPECT_TRUE(await([&] { return diary.frames.size() * frame.size() + diary.noise == sent; }))
      << diary.frames.size() << " frames and " << diary.noise << " bytes";
  EXPECT_GT(diary.noise, 0u);
  EXPECT_THAT(diary.frames, Each("0: 01 03 02 C0 37"));
  ask(pty);
}

TEST_F(LibmodbusFrames, a_slave_that_babbles_keeps_no_request_from_leaving) {
  for (const ByteRow& babble : {ByteRow(64, 0x55), with_crc("09 03 02 00 01")}) {
    std::string got;
    modbus_rtu::ExchangeNumber number = 10;
    for (int i = 0; i < 100; ++i) {
      static_cast<void>(::write(pty.master(), babble.data(), babble.size()));
      turn();
    }
    send(++number, "01 03 32 00 00 01");
    EXPECT_TRUE(await([&] {
      static_cast<void>(::write(pty.master(), babble.data(), babble.size()));
      got += pty.read();
      return got.size() >= 8;
    }));
    EXPECT_EQ(hex_text({reinterpret_cast<const Byte*>(got.data()), got.size()}), "01 03 32 00 00 01 8A B2");
  }
}

TEST_F(LibmodbusFrames, a_request_given_up_before_it_left_does_not_leave) {
  // After the first frame the worker waits for the rest of the second, for 20 s: the requests wait with it.
  const ByteRow frame = with_crc("01 03 02 C0 37");
  answer(pty, frame + ByteRow(frame.begin(), frame.begin() + 2));
  expect_frames({"0: 01 03 02 C0 37"});
  send(1, "01 06 31 00 00 3F");
  link->withdraw(1);
  send(2, "01 03 32 00 00 01");
  answer(pty, ByteRow(frame.begin() + 2, frame.end()));
  EXPECT_EQ(request_at(pty, 8), "01 03 32 00 00 01 8A B2");
  EXPECT_THAT(log_lines, SizeIs(1)) << "the second one had its place";
}

// --- Half frames and noise, with the patience that the product has -------------------------------------------------

class LibmodbusHalfFrames : public LibmodbusFrames {
 protected:
  void SetUp() override { open_at(pty.device(), modbus_rtu::kAdapterLatency); }
  void expect_that_all_is_well() {
    diary.frames.clear();
    ask(pty, 100);
    answer(pty, "01 03 02 C0 37");
    expect_frames({"100: 01 03 02 C0 37"});
    diary.frames.clear();
  }
  /// These bytes are noise to the last, and what is asked next is answered.
  void expect_noise_alone(const ByteRow& bytes) {
    SCOPED_TRACE(hex_text(bytes));
    diary.noise = diary.skipped = 0;
    answer(pty, bytes);
    expect_noise(bytes.size());
    EXPECT_THAT(diary.frames, IsEmpty());
    expect_that_all_is_well();
  }
};

TEST_F(LibmodbusHalfFrames, are_noise_when_the_rest_does_not_come) {
  const ByteRow whole = with_crc("01 03 04 C3 50 00 00");
  for (std::size_t size = 1; size < whole.size(); ++size) {
    expect_noise_alone({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
  }
}

TEST_F(LibmodbusHalfFrames, are_noise_when_their_length_has_suffered_or_libmodbus_cannot_measure_it) {
  for (const std::size_t at : {1U, 2U}) {
    for (int bit = 0; bit < 8; ++bit) {
      ByteRow bad = with_crc("01 03 02 C0 37");
      bad[at] = static_cast<Byte>(bad[at] ^ (1 << bit));
      expect_noise_alone(bad);
    }
  }
  expect_noise_alone(with_crc("01 2B 0E 01 01 00 00 01 00 03 41 42 43"));
}

TEST_F(LibmodbusHalfFrames, that_drip_in_are_not_waited_for_to_their_end) {
  // Never a long pause, and yet far too slow: the whole frame has its time, not each byte of it. A worker that got no
  // processor meanwhile finds the frame whole, and has not waited: then it is tried again.
  constexpr std::size_t kMuch = 200, kTries = 50;
  std::size_t shortest = SIZE_MAX;
  for (std::size_t i = 0; i < kTries && shortest >= kMuch; ++i) {
    diary.noise = diary.skipped = 0;
    ByteRow slow = from_hex("01 03 FA");
    EXPECT_TRUE(await([&] {
      answer(pty, slow);
      slow = {0};
      return diary.noise > 0;
    }));
    shortest = std::min(shortest, diary.noise);
    EXPECT_THAT(diary.frames, IsEmpty());
    expect_that_all_is_well();
  }
  EXPECT_LT(shortest, kMuch);
}

TEST_F(LibmodbusHalfFrames, an_answer_after_any_noise_and_a_silence_is_heard) {
  std::uint32_t random = 1;
  for (int i = 0; i < 50; ++i) {
    ByteRow noise;
    for (int size = 1 + i; size > 0; --size) {
      random = random * 1664525 + 1013904223;
      const auto byte = static_cast<Byte>(random >> 24);
      noise.push_back(byte);
    }
    expect_noise_alone(noise);
  }
}

TEST_F(LibmodbusHalfFrames, an_answer_after_noise_is_heard_without_anything_being_sent_in_between) {
  ask(pty);
  answer(pty, from_hex("01 83 02 00 00"));
  expect_noise(5);
  EXPECT_TRUE(await([&] {
    answer(pty, "01 03 02 C0 37");
    context.restart();
    context.run_for(5ms);  // the silence that the standard asks for before the next frame, and more
    return !diary.frames.empty();
  }));
  EXPECT_THAT(diary.frames, Each("1: 01 03 02 C0 37"));
}

TEST_F(LibmodbusHalfFrames, an_answer_glued_to_noise_is_lost_or_heard_and_never_another) {
  for (const char* noise : {"00", "FF", "00 00", "01", "01 03", "01 03 02", "55 55 55 55 55", "01 83 02 00 00"}) {
    diary.noise = diary.skipped = 0;
    ask(pty);
    const ByteRow all = from_hex(noise) + with_crc("01 03 02 C0 37");
    answer(pty, all);
    EXPECT_TRUE(await([&] { return diary.dropped() + 7 * diary.frames.size() == all.size(); })) << noise;
    EXPECT_THAT(diary.frames, Each("1: 01 03 02 C0 37"));
    expect_that_all_is_well();
  }
}

}  // namespace
}  // namespace axisgate::test
