// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/lawicel_line.hpp"

#include <cstdio>

#include "tests/simulated/lawicel_text.hpp"

namespace axisgate::simulated {
namespace {

constexpr char done = '\r';
constexpr char refused = '\a';
constexpr unsigned flag_warning = 0x04;
constexpr unsigned flag_passive = 0x20;
constexpr unsigned flag_bus_error = 0x80;
constexpr std::int64_t milliseconds_in_a_minute = 60000;
constexpr std::array<std::uint32_t, 9> bit_rates{10000, 20000, 50000, 100000, 125000, 250000, 500000, 800000, 1000000};

}  // namespace

void LawicelLine::tell(const std::string& text, Time now, std::uint64_t tag) {
  give(now, tag, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void LawicelLine::answer(bool was_done, Time now) {
  if (adapter_.acknowledges) tell(std::string(1, was_done ? done : refused), now);
}

void LawicelLine::to_host(const CanToHost& frame) {
  if (!open_) return;
  std::string text = lawicel_text(frame.frame);
  if (timestamps_) {
    std::array<char, 8> stamp{};
    const std::int64_t milliseconds = frame.at / one_millisecond % milliseconds_in_a_minute;
    (void)std::snprintf(stamp.data(), stamp.size(), "%04X", static_cast<unsigned>(milliseconds));
    text += stamp.data();
  }
  tell(text + done, frame.at, frame.tag);
}

void LawicelLine::from_host(std::span<const std::uint8_t> bytes, Time now) {
  for (const std::uint8_t byte : bytes) {
    if (byte == static_cast<std::uint8_t>(done)) {
      const std::string line = std::exchange(line_, {});
      if (std::exchange(overlong_, false)) {
        answer(false, now);
      } else {
        take(line, now);
      }
    } else if (byte != '\n' && line_.size() < longest_line) {
      line_ += static_cast<char>(byte);
    } else if (byte != '\n') {
      overlong_ = true;
    }
  }
}

void LawicelLine::take(const std::string& line, Time now) {
  if (line.empty()) {  // hosts send empty lines to get rid of what was begun
    answer(true, now);
    return;
  }
  switch (line[0]) {
    case 't':
    case 'T':
    case 'r':
    case 'R': {
      const bool sent = transmit(line, now);
      const bool extended = line[0] == 'T' || line[0] == 'R';
      if (sent && adapter_.acknowledges) tell(extended ? "Z\r" : "z\r", now);
      if (!sent) answer(false, now);
      break;
    }
    case 'V':
      tell("V1013\r", now);
      break;
    case 'N':
      tell("NA123\r", now);
      break;
    case 'F':
      if (!open_ || !adapter_.has_flags) {
        answer(false, now);
      } else {
        std::array<char, 8> text{};
        const unsigned still = bus().bus_off() ? flag_passive | flag_bus_error : 0U;
        (void)std::snprintf(text.data(), text.size(), "F%02X\r", std::exchange(flags_, still));
        tell(text.data(), now);
      }
      break;
    default:
      take_channel(line, now);
  }
}

void LawicelLine::take_channel(const std::string& line, Time now) {
  const char command = line[0];
  bool accepted = false;
  if (command == 'S' && line.size() == 2 && line[1] >= '0' && line[1] <= '8') {
    accepted = !open_;
    if (accepted) bus().set_bit_rate(bit_rates.at(static_cast<std::size_t>(line[1] - '0')));
    rate_set_ = rate_set_ || accepted;
  } else if (command == 's' && line.size() == 5) {
    accepted = !open_;
    rate_set_ = rate_set_ || accepted;
  } else if ((command == 'O' || command == 'L') && line.size() == 1) {
    accepted = !open_ && rate_set_;
    open_ = open_ || accepted;
    if (accepted) listen_only_ = command == 'L';
  } else if (command == 'C' && line.size() == 1) {
    accepted = open_;
    open_ = false;
  } else if (command == 'Z' && line.size() == 2 && (line[1] == '0' || line[1] == '1')) {
    accepted = !open_;
    if (accepted) timestamps_ = line[1] == '1';
  } else if (command == 'M' || command == 'm') {
    accepted = !open_ && line.size() == 9;
  } else if (command == 'X') {
    accepted = !open_;
  }
  answer(accepted, now);
}

bool LawicelLine::transmit(const std::string& line, Time now) {
  const auto frame = lawicel_frame(line);
  if (!open_ || listen_only_ || !frame) return false;
  bus().from_host(*frame, now);
  return true;
}

// The cable of the adapter is pulled: it loses its power.
void LawicelLine::cut() {
  CanPortLine::cut();
  open_ = listen_only_ = rate_set_ = timestamps_ = overlong_ = false;
  line_.clear();
  flags_ = 0;
}

void LawicelLine::set_bus_off(bool off, Time) {
  bus().set_bus_off(off);
  if (off) flags_ |= flag_passive | flag_bus_error;
}

void LawicelLine::miss_acknowledge(Time) { flags_ |= flag_warning | flag_passive | flag_bus_error; }

}  // namespace axisgate::simulated
