// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/sdo_faults.hpp"

#include <algorithm>
#include <array>

namespace axisgate::simulated {
namespace {

constexpr std::array<std::string_view, sdo_fault_count> fault_names{"unsized", "wide", "wide-sign", "unnamed-abort",
                                                                    "other-object"};
constexpr std::uint8_t abort_specifier = 0x80;
constexpr std::size_t value_at = 4;
constexpr std::size_t widest = 4;

bool is_value(CanView answer) { return (answer[0] & 0xE2) == 0x42; }
bool names_object(CanView answer) { return (answer[0] >> 5) == 2 || (answer[0] >> 5) == 3; }

std::size_t bytes_of_value(CanView answer) {
  const bool sized = (answer[0] & 0x01) != 0;
  return sized ? widest - ((answer[0] >> 2) & 0x03U) : widest;
}

}  // namespace

std::string_view name_of(SdoFault fault) { return fault_names.at(static_cast<std::size_t>(fault)); }

std::optional<SdoFault> sdo_fault_named(std::string_view name) {
  const auto found = std::find(fault_names.begin(), fault_names.end(), name);
  if (found == fault_names.end()) return std::nullopt;
  return static_cast<SdoFault>(found - fault_names.begin());
}

SdoFaults::Switch& SdoFaults::switch_of(SdoFault fault, std::optional<ObjectKey> only) {
  const auto same = [&](const Switch& it) { return it.fault == fault && it.only == only; };
  const auto found = std::find_if(switches_.begin(), switches_.end(), same);
  if (found != switches_.end()) return *found;
  return switches_.emplace_back(Switch{fault, only});
}

bool SdoFaults::strikes(SdoFault fault, ObjectKey object, Random& random) {
  for (Switch& it : switches_) {
    if (it.fault != fault || (it.only && *it.only != object)) continue;
    if (it.next > 0) {
      --it.next;
      return true;
    }
    if (random.chance(it.rate)) return true;
  }
  return false;
}

CanBytes SdoFaults::spoil(CanBytes answer, Random& random) {
  if (switches_.empty() || answer.size() < value_at) return answer;
  const CanBytes before = buffer_;
  const std::size_t sent = answer.size();
  answer.resize(longest_can_frame);
  buffer_ = answer;
  const ObjectKey object{static_cast<std::uint16_t>(answer[1] | answer[2] << 8), answer[3]};
  const std::size_t size = bytes_of_value(answer);
  const auto above = answer.begin() + static_cast<std::ptrdiff_t>(value_at + size);
  bool whole = sent == longest_can_frame;
  if (is_value(answer) && strikes(SdoFault::wide, object, random)) {
    answer[0] = 0x43;
    std::fill(above, answer.end(), std::uint8_t{0});
    whole = true;
  }
  if (is_value(answer) && strikes(SdoFault::wide_sign, object, random)) {
    answer[0] = 0x43;
    std::fill(above, answer.end(), static_cast<std::uint8_t>((*(above - 1) & 0x80) != 0 ? 0xFF : 0));
    whole = true;
  }
  if (is_value(answer) && strikes(SdoFault::unsized, object, random)) {
    answer[0] = 0x42;
    std::copy(before.end() - (answer.end() - above), before.end(), above);
    whole = true;
  }
  if (names_object(answer) && strikes(SdoFault::other_object, object, random)) answer[1] ^= 0x01;
  if (answer[0] == abort_specifier && strikes(SdoFault::unnamed_abort, object, random))
    std::fill_n(answer.begin() + 1, 3, std::uint8_t{0});
  if (!whole) answer.resize(sent);
  return answer;
}

}  // namespace axisgate::simulated
