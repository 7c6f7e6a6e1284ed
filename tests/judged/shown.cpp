// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/shown.hpp"

#include <bit>
#include <cmath>

#include "tests/obey/client.hpp"

namespace axisgate::test::judged {
namespace {

using namespace model;

bool bit_of(std::uint32_t word, unsigned bit) { return (word >> bit & 1U) != 0; }

}  // namespace

std::int64_t Shown::position() const {
  constexpr double kUnitsPerTurn = 10'000;
  const std::uint32_t whole = wide(obey::shown::position);
  return float_numbers ? std::llround(kUnitsPerTurn * static_cast<double>(std::bit_cast<float>(whole)))
                       : static_cast<std::int32_t>(whole);
}

std::optional<std::string> wrong_in(const Shown& shown, std::size_t client, Contract& contract,
                                    const History& history) {
  constexpr std::size_t kLink = 18, kAge = 19, kValid = 22, kAlarms = 34;
  constexpr std::uint16_t kOnline = 2, kSuspect = 3, kUnknown = 7;
  constexpr unsigned kBitOfStatusword = 0, kBitOfPosition = 2, kBitOfStopLatched = 7;
  const int owner = shown.words[obey::shown::owner];
  const bool latched = bit_of(shown.wide(kAlarms), kBitOfStopLatched);
  const std::string expected = contract.expected();
  if (!contract.shown(client, owner, latched))
    return "shown owner " + std::to_string(owner) + (latched ? ", stop-latched" : ", not stop-latched") +
           "; the contract: " + expected;
  // 3.2 Unknown: "axis_state 7 unknown while link_state is not 2 or 3"; 3.2: "statusword and discrete inputs 0..10 read
  // 0".
  const std::uint16_t link = shown.words[kLink];
  const bool in_sight = link == kOnline || link == kSuspect;
  if ((shown.words[obey::shown::axis_state] == kUnknown) == in_sight ||
      (!in_sight && shown.words[obey::shown::statusword] != 0))
    return "axis_state " + std::to_string(shown.words[obey::shown::axis_state]) + " and statusword " +
           std::to_string(shown.words[obey::shown::statusword]) + " are shown at link_state " + std::to_string(link);
  const std::uint32_t valid = shown.wide(kValid);
  constexpr std::uint16_t kCompleted = 2, kTargetReached = 0x400;
  const bool reached = bit_of(valid, kBitOfStatusword) && (shown.words[obey::shown::statusword] & kTargetReached) != 0;
  if ((reached || shown.words[obey::shown::motion_state] == kCompleted) && !contract.may_be_over())
    return (reached ? "target_reached" : "a completed motion") + (" is shown; the contract: " + expected);
  const std::int64_t age_ms = shown.words[kAge];
  const std::string old = ", " + std::to_string(age_ms) + " ms old, ";
  if (bit_of(valid, kBitOfPosition) && !history.was_at(shown.position(), age_ms))
    return "position " + std::to_string(shown.position()) + " is shown as valid" + old + "and the motor was elsewhere";
  if (!bit_of(valid, kBitOfStatusword) || !shown.statusword_tells) return {};
  constexpr std::uint16_t kStateBits = 0x6F, kOperationEnabled = 0x27;
  const bool enabled = (shown.words[obey::shown::statusword] & kStateBits) == kOperationEnabled;
  if (history.was_enabled(enabled, age_ms)) return {};
  return std::string("the axis is shown as ") + (enabled ? "enabled" : "not enabled") + old + "and was not";
}

}  // namespace axisgate::test::judged
