// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/outages.hpp"

namespace axisgate::test::judged {

using obey::Strike;

void strike(obey::Plant& plant, Watches& watches, const Step& step) {
  // Of one length more and late as well, with a right sum, nobody could tell it from the answer to another request.
  const bool late = plant.still_strikes(Strike::late_reply);
  const std::array kSpoilt{Strike::flip_bit, Strike::half_reply, late ? Strike::flip_bit : Strike::wrong_length,
                           Strike::wrong_station};
  constexpr std::array kMore{Strike::noise_before, Strike::noise_after, Strike::split_reply, Strike::glued_reply};
  constexpr std::uint64_t kStorm = 30;
  const std::uint64_t times = 1 + step.number % 3;
  const bool odd = step.id > 2 && tongue_of(plant.subject) != Tongue::keya_rs232;  // RS232 has no sum
  if (step.deed == Deed::late) {
    watches.line_is_troubled();
    plant.strike(Strike::late_reply, times);
  } else if (step.deed == Deed::twice) {
    watches.line_is_troubled(true);
    const Strike unasked = step.on ? Strike::emergencies : Strike::babble;
    if (odd && on_can(tongue_of(plant.subject)) && plant.strike(unasked, kStorm * times)) return;
    if (!odd || !plant.strike(kMore.at(step.length % kMore.size()), times)) plant.strike(Strike::double_reply, times);
  } else if (odd && plant.strike(kSpoilt.at(step.length % kSpoilt.size()), times)) {
    watches.line_is_troubled();
  } else if (step.id > 0) {
    watches.cable.lie_in_wait(std::chrono::seconds(5));
  } else {
    plant.strike(step.on ? Strike::lose_request : Strike::lose_reply, 1 + step.number % 4);
  }
}

void begin_to_die(obey::Plant& plant, const Step& step) {
  constexpr std::uint8_t kMostFrames = 6;
  const std::size_t units = on_can(tongue_of(plant.subject)) ? step.number % kMostFrames : step.number;
  plant.die_after(step.on ? 0 : units);
}

}  // namespace axisgate::test::judged
