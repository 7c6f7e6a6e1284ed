// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include "gateway/core/random.hpp"
#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

constexpr int kSeeds = 40;
constexpr int kFramesPerSeed = 300;

Byte any_byte(Random& random) { return static_cast<Byte>(random.below(256)); }

/// The rest of a function 43/13, mostly well-formed, of few objects, so that parts of long ones meet.
void put_reference(Random& random, std::vector<Byte>& pdu) {
  static constexpr Byte kControls[] = {0x00, 0x00, 0x01, 0x81, 0x20, 0x02, 0x26, 0x41, 0xC1, 0x40, 0x80};
  static constexpr std::size_t kStarts[] = {0, 0, 0, 1, 100, 241, 482, 4095, 65535};
  const auto put_word = [&pdu](std::size_t value) {
    pdu.push_back(static_cast<Byte>(value >> 8));
    pdu.push_back(static_cast<Byte>(value));
  };
  const Byte control = random.chance(1, 20) ? any_byte(random) : kControls[random.below(std::size(kControls))];
  pdu.insert(pdu.end(), {13, control, 0});
  for (const Byte option : {Byte{0x40}, Byte{0x20}, Byte{0x04}, Byte{0x02}})
    if ((control & option) != 0) pdu.push_back(0);
  pdu.insert(pdu.end(), {static_cast<Byte>(random.below(4)), 0x10, 0x08, static_cast<Byte>(random.below(2))});
  put_word(kStarts[random.below(std::size(kStarts))]);
  const std::size_t count = random.below(242);
  put_word(count);
  if ((control & 1) != 0) pdu.resize(std::min<std::size_t>(pdu.size() + count, 253));
}

/// A PDU that is well-formed often enough to reach every branch, at addresses that exist often enough.
std::vector<Byte> any_pdu(Random& random) {
  static constexpr Byte kFunctions[] = {1, 2, 3, 4, 5, 6, 8, 15, 16, 22, 23, 43};
  std::vector<Byte> pdu{random.chance(1, 20) ? any_byte(random) : kFunctions[random.below(std::size(kFunctions))]};
  const auto put = [&pdu](std::uint64_t value) {
    pdu.push_back(static_cast<Byte>(value >> 8));
    pdu.push_back(static_cast<Byte>(value));
  };
  const auto put_address = [&] {
    static constexpr int kBases[] = {0, 100, 140, 154, 178, 200, 300, 50000, 60010, 65500};
    put(static_cast<std::uint64_t>(kBases[random.below(std::size(kBases))]) + random.below(40));
  };
  const auto put_data = [&](std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) pdu.push_back(random.chance(1, 2) ? Byte{0} : any_byte(random));
  };
  const auto put_sized_data = [&](bool bits) {
    const std::uint64_t count = 1 + random.below(20);
    const std::uint64_t size = bits ? (count + 7) / 8 : 2 * count;
    put(count);
    pdu.push_back(static_cast<Byte>(size));
    put_data(size);
  };
  const Byte function = pdu[0];
  if (function == 8) {
    put(random.below(18));
    put(0);
  } else if (function == 43 && random.chance(1, 2)) {
    put_reference(random, pdu);
  } else if (function == 43) {
    pdu.insert(pdu.end(), {14, static_cast<Byte>(random.below(6))});
    put_data(1);
  } else {
    put_address();
    if (function == 5) put(random.chance(1, 2) ? 0xFF00 : 0);
    if (function == 15 || function == 16) put_sized_data(function == 15);
    if (function == 22) put_data(4);
    if (function == 23) {
      put(1 + random.below(125));
      put_address();
      put_sized_data(false);
    }
    if (pdu.size() == 3) put(1 + random.below(130));
  }
  if (random.chance(1, 10)) pdu.resize(1 + random.below(40));
  return pdu;
}

Outcome any_outcome(Random& random) {
  if (random.chance(3, 4)) return {};
  return {static_cast<Errc>(random.below(kErrcCount)), static_cast<std::uint32_t>(random.next())};
}

BatchResult any_result(Random& random) {
  BatchResult result{any_outcome(random), static_cast<std::uint32_t>(random.next()),
                     static_cast<std::uint8_t>(random.below(5))};
  if (result.object_size == 0 && random.chance(3, 4)) {
    result.object_bytes = std::make_shared<const std::vector<Byte>>(random.below(kMaxObjectBytes + 1));
  }
  result.abort_code = random.chance(1, 2) ? 0x06020000 : 0;
  return result;
}

/// Plays frames, results, splits and time in any order and checks each reply's place and function.
void play(std::uint64_t seed) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  Desk desk;
  desk.port.slow = random.chance(3, 4);
  desk.settings.posted_writes = random.chance(1, 4);
  desk.settings.offline_reads_fail = random.chance(1, 4);
  desk.settings.low_word_first = random.chance(1, 2);
  desk.settings.per_axis_units = random.chance(1, 4);
  desk.settings.float_numbers = seed % 2 == 0;
  desk.settings.staged_halves = seed % 3 == 0;
  Line plc(desk, static_cast<Role>(random.below(4)));
  std::deque<Byte> asked;
  std::vector<Byte> stream;
  std::uint16_t sent = 0;

  const auto take_one = [&] {
    const std::string reply = plc.reply();
    if (reply.empty()) return false;
    EXPECT_FALSE(asked.empty());
    EXPECT_EQ(bytes(reply)[0] & 0x7F, asked.front() & 0x7F);
    asked.pop_front();
    return true;
  };
  while (sent < kFramesPerSeed || !stream.empty()) {
    if (stream.empty() && sent < kFramesPerSeed) {
      for (std::uint64_t i = 0; i <= random.below(6) && sent < kFramesPerSeed; ++i) {
        const auto pdu = any_pdu(random);
        asked.push_back(pdu[0]);
        const auto whole = frame(++sent, static_cast<std::uint8_t>(random.below(7)), pdu);
        stream.insert(stream.end(), whole.begin(), whole.end());
      }
    }
    if (plc.session().wants_input()) {
      const auto count = static_cast<std::ptrdiff_t>(1 + random.below(stream.size()));
      plc.feed({stream.begin(), stream.begin() + count});
      stream.erase(stream.begin(), stream.begin() + count);
    }
    if (random.chance(1, 8)) desk.runtime.advance_by(std::chrono::milliseconds(random.below(1500)));
    if (random.chance(1, 8)) {
      desk.axis(1).link_state = static_cast<LinkState>(random.below(6));
    }
    if (!desk.port.waiting.empty() && (random.chance(1, 2) || !plc.session().wants_input())) {
      desk.port.finish_with(any_result(random));
    }
    while (random.chance(3, 4) && take_one()) {
    }
  }
  for (int i = 0; i < 4000 && !asked.empty(); ++i) {
    if (!desk.port.waiting.empty()) desk.port.finish_with(any_result(random));
    take_one();
  }
  EXPECT_TRUE(asked.empty()) << asked.size() << " requests got no reply";
  EXPECT_TRUE(plc.session().output().empty()) << "a reply nobody asked for";
}

TEST(RandomFrames, EachGetExactlyOneReplyInOrder) {
  for (std::uint64_t seed = 1; seed <= kSeeds && !::testing::Test::HasFailure(); ++seed) play(seed);
}

TEST(RandomBytes, NeverCrashASessionAndNeverMakeMoreThanFourRepliesAhead) {
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    Random random(seed);
    Desk desk;
    desk.port.slow = random.chance(1, 2);
    Line plc(desk, Role::engineer);
    for (int i = 0; i < 20 && !plc.session().finished(); ++i) {
      std::vector<Byte> noise(random.below(80));
      for (Byte& each : noise) each = any_byte(random);
      // A plausible head, so that not every story ends with its second byte.
      if (random.chance(2, 3) && noise.size() > 7) {
        noise[2] = noise[3] = noise[4] = 0;
        noise[5] = static_cast<Byte>(random.chance(1, 2) ? noise.size() - 6 : noise[5]);
      }
      plc.feed(noise);
      EXPECT_LE(plc.session().output().size(), kMaxPipelined * kMaxAdu);
      if (random.chance(1, 3)) plc.session().take_output(plc.session().output().size(), desk.runtime.now());
      if (!desk.port.waiting.empty() && random.chance(1, 3)) desk.port.finish_with(any_result(random));
      desk.runtime.advance_by(std::chrono::milliseconds(random.below(3000)));
      if (plc.session().next_deadline() <= desk.runtime.now()) plc.session().on_deadline(desk.runtime.now());
    }
  }
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
