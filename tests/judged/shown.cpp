// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/shown.hpp"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "tests/obey/client.hpp"

namespace axisgate::test::judged {
namespace {

using namespace reference;

/// 3.2: what the motor did for as long as a drive may take to tell it.
bool velocity_fits(std::int64_t shown, std::int64_t age_ms, const History& history) {
  constexpr std::int64_t kLagMs = 700, kCreep = 15'000;
  return history.was(age_ms + kLagMs, [shown](const Sight& sight) {
    if (std::abs(shown) <= kCreep) return std::abs(sight.velocity) <= 2 * kCreep;
    return sight.velocity != 0 && (sight.velocity > 0) == (shown > 0);
  });
}

bool bit_of(std::uint32_t word, unsigned bit) { return (word >> bit & 1U) != 0; }

}  // namespace

std::int64_t Shown::number(std::size_t at, double units) const {
  const std::uint32_t whole = wide(at);
  return float_numbers ? std::llround(units * static_cast<double>(std::bit_cast<float>(whole)))
                       : static_cast<std::int32_t>(whole);
}

// 3.3 Outcomes, and 3.3 Not new (0x06: 10), 3.3 Not reached (0x04: 11), 3.4 Owed stops ("0x06, result 9").
bool result_fits(int exception, int result) {
  static const std::map<int, std::set<int>> kResults{
      {1, {0}}, {2, {0}}, {3, {0}}, {4, {3, 8, 9, 11}}, {6, {0, 5, 6, 7, 8, 9, 10}}, {10, {6}}, {11, {4, 8}}};
  const auto found = kResults.find(exception);
  return found != kResults.end() && found->second.contains(result);
}

std::optional<std::string> wrong_in(const Shown& shown, std::size_t client, Contract& contract,
                                    const History& history) {
  constexpr std::size_t kMode = 1, kErrorCode = 10, kLink = 18, kAge = 19, kValid = 22, kAlarms = 34;
  constexpr unsigned kBitOfMode = 1, kBitOfVelocity = 3, kBitOfErrorCode = 7;
  constexpr std::int64_t kCauseMs = 1'000;  // from the end of a fault until it is read
  constexpr std::uint16_t kOnline = 2, kSuspect = 3, kUnknown = 7;
  constexpr unsigned kBitOfStatusword = 0, kBitOfPosition = 2, kBitOfStopLatched = 7;
  const int owner = shown.words[obey::shown::owner];
  const bool latched = bit_of(shown.wide(kAlarms), kBitOfStopLatched);
  const int lease_ms = shown.words[obey::shown::lease_remaining];
  std::optional<int> mode;
  if (bit_of(shown.wide(kValid), kBitOfMode)) mode = static_cast<std::int16_t>(shown.words[kMode]);
  if (!contract.shown(client, {owner, latched, lease_ms, mode}))
    return "shown owner " + std::to_string(owner) + ", its lease for " + std::to_string(lease_ms) + " ms" +
           (latched ? ", stop-latched" : ", not stop-latched") + (mode ? ", in mode " + std::to_string(*mode) : "") +
           "; the contract: " + contract.expected();
  // The drive obeys, and counts as its profile says: whatever was asked in whatever order, no watch has anything to
  // say.
  constexpr unsigned kBitOfUnexpectedMotion = 13, kBitOfUnitsDisagree = 14;
  for (const unsigned watched : {kBitOfUnexpectedMotion, kBitOfUnitsDisagree})
    if (shown.alone && bit_of(shown.wide(kAlarms), watched))
      return "alarm " + std::to_string(watched) + " is shown of a drive that obeys";
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
    return (reached ? "target_reached" : "a completed motion") + (" is shown; the contract: " + contract.expected());
  const std::int64_t age_ms = shown.words[kAge];
  const std::string old = ", " + std::to_string(age_ms) + " ms old, ";
  if (bit_of(valid, kBitOfPosition) && !history.was_at(shown.position(), age_ms))
    return "position " + std::to_string(shown.position()) + " is shown as valid" + old + "and the motor was elsewhere";
  if (bit_of(valid, kBitOfVelocity) && !velocity_fits(shown.velocity(), age_ms, history))
    return "velocity " + std::to_string(shown.velocity()) + " is shown as valid" + old + "and the motor did otherwise";
  // 3.1: error_code is that of the first active row; of a fault whose cause is not known yet it "reads 65535, not
  // valid", 500 ms at the latest.
  const std::uint16_t code = shown.words[kErrorCode];
  const auto faulted = [](const Sight& sight) { return sight.faulted; };
  if (in_sight && bit_of(valid, kBitOfErrorCode) && code != 0 && !history.was(age_ms + kCauseMs, faulted))
    return "error_code " + std::to_string(code) + " is shown as valid" + old + "of a drive without a fault";
  if (!bit_of(valid, kBitOfStatusword) || !shown.statusword_tells) return {};
  constexpr std::uint16_t kFault = 0x08, kNotKnown = 0xFFFF;
  if ((shown.words[obey::shown::statusword] & kFault) != 0) {
    if (code == 0) return "a fault is shown without a cause";
    if (code == kNotKnown && bit_of(valid, kBitOfErrorCode)) return "a cause that is not known is shown as valid";
  }
  constexpr std::uint16_t kStateBits = 0x6F, kOperationEnabled = 0x27;
  const bool enabled = (shown.words[obey::shown::statusword] & kStateBits) == kOperationEnabled;
  if (history.was_enabled(enabled, age_ms)) return {};
  return std::string("the axis is shown as ") + (enabled ? "enabled" : "not enabled") + old + "and was not";
}

}  // namespace axisgate::test::judged
