// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/lawicel_line.hpp"

#include <cstdio>

namespace axisgate::simulated {
namespace {

constexpr char done = '\r';
constexpr char refused = '\a';
constexpr unsigned flag_warning = 0x04;
constexpr unsigned flag_passive = 0x20;
constexpr unsigned flag_bus_error = 0x80;
constexpr std::int64_t milliseconds_in_a_minute = 60000;
constexpr std::array<std::uint32_t, 9> bit_rates{10000, 20000, 50000, 100000, 125000, 250000, 500000, 800000, 1000000};

std::optional<std::uint32_t> hex_in(const std::string& text, std::size_t at, std::size_t digits) {
  if (text.size() < at + digits) return std::nullopt;
  std::uint32_t value = 0;
  for (std::size_t i = at; i < at + digits; ++i) {
    const std::size_t digit = std::string_view("0123456789ABCDEF0123456789abcdef").find(text[i]);
    if (digit == std::string_view::npos) return std::nullopt;
    value = value << 4 | static_cast<std::uint32_t>(digit & 0xF);
  }
  return value;
}

std::string text_of(const BusFrame& frame) {
  const bool extended = frame.extended;
  std::array<char, 16> head{};
  const char kind = frame.remote ? (extended ? 'R' : 'r') : (extended ? 'T' : 't');
  (void)std::snprintf(head.data(), head.size(), extended ? "%c%08X%u" : "%c%03X%u", kind, frame.id,
                      static_cast<unsigned>(frame.size));
  std::string text = head.data();
  for (const std::uint8_t byte : bytes_of(frame)) {
    (void)std::snprintf(head.data(), head.size(), "%02X", static_cast<unsigned>(byte));
    text += head.data();
  }
  return text;
}

}  // namespace

void LawicelLine::tell(const std::string& text, Time now, std::uint64_t tag) {
  give(now, tag, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void LawicelLine::answer(bool was_done, Time now) {
  if (adapter_.acknowledges) tell(std::string(1, was_done ? done : refused), now);
}

void LawicelLine::to_host(const CanToHost& frame) {
  if (!open_) return;
  std::string text = text_of(frame.frame);
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
  const bool extended = line[0] == 'T' || line[0] == 'R';
  const bool remote = line[0] == 'r' || line[0] == 'R';
  const std::size_t digits = extended ? 8 : 3;
  const auto id = hex_in(line, 1, digits);
  const auto size = hex_in(line, 1 + digits, 1);
  if (!open_ || listen_only_ || !id || !size || *size > longest_can_frame) return false;
  const std::size_t data_at = 2 + digits;
  if (line.size() != data_at + (remote ? 0 : 2 * *size)) return false;
  CanBytes data;
  for (std::size_t i = 0; !remote && i < *size; ++i) {
    const auto byte = hex_in(line, data_at + 2 * i, 2);
    if (!byte) return false;
    data.push_back(static_cast<std::uint8_t>(*byte));
  }
  BusFrame frame = bus_frame(*id, data);
  frame.extended = extended;
  frame.remote = remote;
  frame.size = static_cast<std::uint8_t>(*size);
  bus().from_host(frame, now);
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
