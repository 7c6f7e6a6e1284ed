// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/manual/plan/manual_keys.hpp"

#include <gmock/gmock.h>

#include <string_view>

#include "gateway/commands/manual/plan/stand_watch.hpp"

namespace axisgate::commands {
namespace {

using enum ManualKey;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<ManualKey> keys(ManualKeys& from, std::string_view typed) {
  const std::vector<Byte> bytes(typed.begin(), typed.end());
  return from.take(bytes);
}
std::vector<ManualKey> keys(std::string_view typed) {
  ManualKeys from;
  return keys(from, typed);
}

TEST(StandWatch, AMotorThatTurnsEitherWayDoesNotStand) {
  for (const double turned : {0.5, -0.5}) {
    StandWatch watch;
    watch.look(1.0, kLongAgo + std::chrono::seconds(1));
    watch.look(1.0 + turned, kLongAgo + std::chrono::seconds(9));
    EXPECT_EQ(watch.still_for(kLongAgo + std::chrono::seconds(10)), std::chrono::seconds(1)) << turned;
  }
}

TEST(ManualKeys, ArrowsOfBothKindsOfTerminalAndSignsAreButtons) {
  EXPECT_THAT(keys("\x1b[C\x1b[D\x1b[A\x1b[B"), ElementsAre(forward, reverse, forward, reverse));
  EXPECT_THAT(keys("\x1bOC\x1bOD"), ElementsAre(forward, reverse));
  EXPECT_THAT(keys("+-"), ElementsAre(forward, reverse));
}

TEST(ManualKeys, AKeyThatComesInPiecesIsOneKey) {
  ManualKeys from;
  EXPECT_THAT(keys(from, "\x1b"), IsEmpty());
  EXPECT_THAT(keys(from, "["), IsEmpty());
  EXPECT_THAT(keys(from, "C+"), ElementsAre(forward, forward));
}

TEST(ManualKeys, QAndTheEndOfTheInputEndIt) { EXPECT_THAT(keys("q\x04"), ElementsAre(quit, quit)); }

TEST(ManualKeys, EveryOtherKeyLetsGo) {
  EXPECT_THAT(keys(" x"), ElementsAre(other, other));
  EXPECT_THAT(keys("\x1b[H\x1b[3~\x1b[1;5C\x1bx"), ElementsAre(other, other, other, other));
  EXPECT_THAT(keys("\x1b\x1b[C"), ElementsAre(forward)) << "an escape before a key is none of its own";
}

}  // namespace
}  // namespace axisgate::commands
