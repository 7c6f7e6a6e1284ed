// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/lawicel_text.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::string_view digits_in_hex = "0123456789ABCDEF0123456789abcdef";

std::optional<std::uint32_t> hex_in(std::string_view text, std::size_t at, std::size_t digits) {
  if (text.size() < at + digits) return std::nullopt;
  std::uint32_t value = 0;
  for (const char letter : text.substr(at, digits)) {
    const std::size_t digit = digits_in_hex.find(letter);
    if (digit == std::string_view::npos) return std::nullopt;
    value = value << 4 | static_cast<std::uint32_t>(digit & 0xF);
  }
  return value;
}

void append_hex(std::string& text, std::uint32_t value, int digits) {
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) text += digits_in_hex[value >> shift & 0xF];
}

}  // namespace

std::string lawicel_text(const BusFrame& frame) {
  std::string text(1, frame.remote ? (frame.extended ? 'R' : 'r') : (frame.extended ? 'T' : 't'));
  append_hex(text, frame.id, frame.extended ? 8 : 3);
  append_hex(text, frame.size, 1);
  for (const std::uint8_t byte : bytes_of(frame)) append_hex(text, byte, 2);
  return text;
}

std::optional<BusFrame> lawicel_frame(std::string_view line) {
  if (line.empty() || std::string_view("tTrR").find(line[0]) == std::string_view::npos) return std::nullopt;
  const bool extended = line[0] == 'T' || line[0] == 'R';
  const bool remote = line[0] == 'r' || line[0] == 'R';
  const std::size_t digits = extended ? 8 : 3;
  const auto id = hex_in(line, 1, digits);
  const auto size = hex_in(line, 1 + digits, 1);
  if (!id || !size || *size > longest_can_frame) return std::nullopt;
  const std::size_t data_at = 2 + digits;
  if (line.size() != data_at + (remote ? 0 : 2 * *size)) return std::nullopt;
  BusFrame frame;
  frame.id = *id;
  frame.extended = extended;
  frame.remote = remote;
  frame.size = static_cast<std::uint8_t>(*size);
  for (std::size_t i = 0; !remote && i < *size; ++i) {
    const auto byte = hex_in(line, data_at + 2 * i, 2);
    if (!byte) return std::nullopt;
    frame.data[i] = static_cast<std::uint8_t>(*byte);
  }
  return frame;
}

}  // namespace axisgate::simulated
