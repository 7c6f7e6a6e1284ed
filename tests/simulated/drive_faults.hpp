// SPDX-License-Identifier: Apache-2.0
// The fault switches of one drive on a line: each a probability per reply, and a number of next replies for tests.
// And single objects of it that are mute, or refused. Promises that a switch which is off draws no random number, so
// switching one fault on shifts no other draw before it. Never touches the drive or the line; the line asks it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/simulated/random.hpp"
#include "tests/simulated/sdo_faults.hpp"
#include "tests/simulated/time.hpp"

namespace axisgate::simulated {

enum class DriveFault : std::uint8_t {
  unresponsive,   // the request is neither seen nor answered
  late,           // the reply comes `late_by` later
  lose,           // the drive acts, the reply is lost
  noise_before,   // random bytes before the reply
  noise_after,    // random bytes after it
  corrupt,        // one bit of the reply flips
  split,          // the reply comes in two pieces, `split_gap` apart
  duplicate,      // the reply comes twice
  wrong_station,  // the reply names another station, with a right checksum
  restart,        // the drive reboots on the request, before or after acting on it, and never answers it
  babble,         // bursts of random bytes every `babble_period`, unasked; frames too, where a frame has no fixed form
  // Modbus RTU alone:
  half,          // the reply breaks off
  wrong_length,  // a register more or less than was asked for, with a right CRC
  glued,         // the reply and, without a gap, a copy of the drive's reply before it
  exception,     // the drive does not act and refuses with `exception_code`; on CAN with `abort_code`
  // CAN alone:
  emergencies,  // an EMCY with `emergency_code` every `babble_period`, unasked
  // Where a drive says by itself that it lives:
  heartbeat_twice,  // its heartbeat comes twice
  // On serial lines alone:
  glitch,  // its transceiver turns round: `glitch_bytes` times `glitch_value` before the reply, `glitch_lead` or none
};

inline constexpr std::size_t drive_fault_count = 18;

std::string_view name_of(DriveFault fault);
std::optional<DriveFault> drive_fault_named(std::string_view name);

class DriveFaults {
 public:
  Time late_by = std::chrono::milliseconds(300);
  Time split_gap = std::chrono::milliseconds(3);
  Time babble_period = std::chrono::milliseconds(10);
  std::uint64_t longest_noise = 12;  // bytes
  std::size_t glitch_bytes = 1;
  std::uint8_t glitch_value = 0;
  Time glitch_lead{};  // from its last byte to the reply; 0: glued to it
  std::uint8_t exception_code = 4;
  std::uint32_t abort_code = 0x08000000;
  std::uint32_t babble_id = 0;  // CAN: whose frames; 0: those of the drive's own error control
  std::uint16_t emergency_code = 0x8110;
  SdoFaults sdo;                     // CAN: of its SDO server
  std::optional<bool> restart_acts;  // is the request carried out before the restart? none: by chance

  void set_rate(DriveFault fault, double probability) { switches_[number(fault)].rate = probability; }
  void next(DriveFault fault, std::uint64_t times = 1) { switches_[number(fault)].next = times; }
  bool armed(DriveFault fault) const { return switches_[number(fault)].rate > 0 || switches_[number(fault)].next > 0; }
  void clear() {
    switches_ = {};
    sdo.clear();
    spoilt_.clear();
  }

  // One object of the drive, as its requests name it: an object's index and sub, a register, a query code and 0.
  using Place = std::pair<std::uint16_t, std::uint8_t>;
  // What becomes of requests for it: no answer, or this refusal (abort code, exception; a Keya on a serial line has
  // none). Reads alone, unless it says otherwise.
  struct Spoilt {
    std::optional<std::uint32_t> refused_with;
    bool writes_too = false;
    bool reads = true;
  };
  void spoil(Place place, Spoilt how) { spoilt_[place] = how; }
  void mend(Place place) { spoilt_.erase(place); }
  // None: it is as it should be. Of a request for several, the first that is spoilt.
  std::optional<Spoilt> spoilt(Place place, bool write, std::uint16_t count = 1) const {
    const auto found = spoilt_.lower_bound(place);
    if (found == spoilt_.end() || found->first.first >= place.first + count) return std::nullopt;
    if (count == 1 && found->first != place) return std::nullopt;
    return (write ? found->second.writes_too : found->second.reads) ? std::optional(found->second) : std::nullopt;
  }

  // Does this fault strike now? Uses up one of the `next` ones first.
  bool strikes(DriveFault fault, Random& random) {
    Switch& chosen = switches_[number(fault)];
    if (chosen.next > 0) {
      --chosen.next;
      ++struck_[number(fault)];
      return true;
    }
    if (!random.chance(chosen.rate)) return false;
    ++struck_[number(fault)];
    return true;
  }

  // How often it has struck since the drive was made; clear() forgets nothing of that.
  std::uint64_t struck(DriveFault fault) const { return struck_[number(fault)]; }

  // Random bytes, at most `longest_noise`.
  std::vector<std::uint8_t> noise(Random& random) const {
    std::vector<std::uint8_t> bytes(1 + random.below(std::max<std::uint64_t>(longest_noise, 1)));
    for (std::uint8_t& byte : bytes) byte = random.byte();
    return bytes;
  }

 private:
  struct Switch {
    double rate = 0;
    std::uint64_t next = 0;
  };
  static std::size_t number(DriveFault fault) { return static_cast<std::size_t>(fault); }

  std::map<Place, Spoilt> spoilt_;
  std::array<Switch, drive_fault_count> switches_{};
  std::array<std::uint64_t, drive_fault_count> struck_{};
};

}  // namespace axisgate::simulated
