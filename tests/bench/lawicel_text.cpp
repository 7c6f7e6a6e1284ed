// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/lawicel_text.hpp"

namespace axisgate::bench {
namespace {

constexpr std::string_view kDigits = "0123456789ABCDEF";
constexpr std::size_t kHead = 5;  // the letter, three digits of the identifier, one of the size

std::optional<std::uint32_t> number_in(std::string_view digits) {
  std::uint32_t number = 0;
  for (const char digit : digits) {
    const std::size_t value = kDigits.find(digit >= 'a' ? static_cast<char>(digit - 'a' + 'A') : digit);
    if (value == std::string_view::npos) return std::nullopt;
    number = number << 4 | static_cast<std::uint32_t>(value);
  }
  return number;
}

}  // namespace

std::string lawicel_text(const simulated::BusFrame& frame) {
  std::string text(1, frame.remote ? 'r' : 't');
  for (int shift = 8; shift >= 0; shift -= 4) text += kDigits[frame.id >> shift & 0xF];
  text += kDigits[frame.size];
  for (const std::uint8_t byte : simulated::bytes_of(frame)) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 0xF];
  }
  return text + '\r';
}

std::optional<simulated::BusFrame> lawicel_frame(std::string_view line) {
  if (line.size() < kHead || (line[0] != 't' && line[0] != 'r')) return std::nullopt;
  const auto id = number_in(line.substr(1, 3));
  const auto size = number_in(line.substr(4, 1));
  if (!id || !size || *size > simulated::longest_can_frame) return std::nullopt;
  simulated::BusFrame frame;
  frame.id = *id;
  frame.remote = line[0] == 'r';
  frame.size = static_cast<std::uint8_t>(*size);
  for (std::size_t i = 0; !frame.remote && i < *size; ++i) {
    const auto byte = line.size() >= kHead + 2 * i + 2 ? number_in(line.substr(kHead + 2 * i, 2)) : std::nullopt;
    if (!byte) return std::nullopt;
    frame.data[i] = static_cast<std::uint8_t>(*byte);
  }
  return frame;
}

std::optional<std::string> LawicelLines::take(std::uint8_t byte) {
  if (byte == '\r' || byte == '\a') return std::exchange(begun_, {});
  if (begun_.size() < kLongest) begun_ += static_cast<char>(byte);
  return std::nullopt;
}

}  // namespace axisgate::bench
