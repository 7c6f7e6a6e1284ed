// SPDX-License-Identifier: Apache-2.0
#include "adapters/can/lawicel.hpp"

#include <array>
#include <string_view>

namespace axisgate::can {
namespace {

constexpr Byte kEndOfLine = '\r';
constexpr Byte kBell = 0x07;
constexpr Byte kLineFeed = '\n';  // some firmware adds it; it means nothing
constexpr std::size_t kStandardIdDigits = 3;
constexpr std::size_t kExtendedIdDigits = 8;
constexpr std::size_t kStampDigits = 4;

/// Upper and lower case: adapters send either.
std::optional<std::uint32_t> hex_number(std::string_view digits) {
  std::uint32_t value = 0;
  for (const char c : digits) {
    std::uint32_t digit = 0;
    if (c >= '0' && c <= '9') {
      digit = static_cast<std::uint32_t>(c - '0');
    } else if (c >= 'A' && c <= 'F') {
      digit = static_cast<std::uint32_t>(c - 'A') + 10;
    } else if (c >= 'a' && c <= 'f') {
      digit = static_cast<std::uint32_t>(c - 'a') + 10;
    } else {
      return std::nullopt;
    }
    value = (value << 4) | digit;
  }
  return value;
}

void append_hex(std::string& out, std::uint32_t value, std::size_t digits) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  for (std::size_t i = digits; i-- > 0;) out += kDigits[(value >> (4 * i)) & 0x0F];
}

bool take_data(CanFrame& frame, std::string_view digits) {
  for (std::size_t i = 0; i * 2 < digits.size(); ++i) {
    const auto byte = hex_number(digits.substr(i * 2, 2));
    if (!byte) return false;
    frame.data[i] = static_cast<Byte>(*byte);
  }
  return true;
}

std::optional<LawicelLine> parse_frame(std::string_view text) {
  LawicelLine line;
  line.kind = LawicelLine::Kind::frame;
  CanFrame& frame = line.frame;
  frame.extended = text[0] == 'T' || text[0] == 'R';
  frame.remote = text[0] == 'r' || text[0] == 'R';
  const std::size_t id_digits = frame.extended ? kExtendedIdDigits : kStandardIdDigits;
  if (text.size() < 1 + id_digits + 1) return std::nullopt;
  const auto id = hex_number(text.substr(1, id_digits));
  const char size = text[1 + id_digits];
  if (!id || *id > (frame.extended ? kMaxExtendedId : kMaxStandardId) || size < '0' || size > '8') return std::nullopt;
  frame.id = *id;
  frame.size = static_cast<std::uint8_t>(size - '0');
  text.remove_prefix(1 + id_digits + 1);
  const std::size_t data_digits = frame.bytes().size() * 2;
  if (text.size() != data_digits && text.size() != data_digits + kStampDigits) return std::nullopt;
  if (!take_data(frame, text.substr(0, data_digits))) return std::nullopt;
  if (text.size() > data_digits) {
    const auto stamp = hex_number(text.substr(data_digits));
    if (!stamp) return std::nullopt;
    line.stamp_ms = static_cast<std::uint16_t>(*stamp);
  }
  return line;
}

std::optional<LawicelLine> parse_line(std::string_view text) {
  LawicelLine line;
  if (text.empty()) return line;
  switch (text[0]) {
    case 't':
    case 'T':
    case 'r':
    case 'R':
      return parse_frame(text);
    case 'z':
    case 'Z':
      line.kind = LawicelLine::Kind::sent;
      return text.size() == 1 ? std::optional(line) : std::nullopt;
    case 'F': {
      const auto flags = hex_number(text.substr(1));
      if (text.size() != 3 || !flags) return std::nullopt;
      line.kind = LawicelLine::Kind::status;
      line.flags = static_cast<Byte>(*flags);
      return line;
    }
    case 'V':
    case 'N':
      line.kind = text[0] == 'V' ? LawicelLine::Kind::version : LawicelLine::Kind::serial_number;
      line.text = text.substr(1);
      return text.size() > 1 ? std::optional(line) : std::nullopt;
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<LawicelLine> LawicelDecoder::push(Byte byte) {
  if (byte == kLineFeed) return std::nullopt;
  if (byte == kEndOfLine) {
    std::optional<LawicelLine> line = too_long_ ? std::nullopt : parse_line(line_);
    if (!line) {
      ++bad_bytes_;
      drop_line();
    }
    line_.clear();
    too_long_ = false;
    return line;
  }
  if (byte == kBell) {
    drop_line();
    too_long_ = false;
    LawicelLine refused;
    refused.kind = LawicelLine::Kind::refused;
    return refused;
  }
  if (byte < ' ' || byte > '~') {
    // What follows may be a whole line; what was before it, joined with that, must not become one.
    ++bad_bytes_;
    drop_line();
    return std::nullopt;
  }
  if (too_long_ || line_.size() == kMaxLawicelLine) {
    too_long_ = true;
    ++bad_bytes_;
    drop_line();
    return std::nullopt;
  }
  line_ += static_cast<char>(byte);
  return std::nullopt;
}

void LawicelDecoder::drop_line() {
  bad_bytes_ += static_cast<std::uint32_t>(line_.size());
  line_.clear();
}

std::string lawicel_text(const CanFrame& frame) {
  std::string out;
  out.reserve(kMaxLawicelLine);
  const char type = frame.remote ? 'r' : 't';
  out += frame.extended ? static_cast<char>(type - 'a' + 'A') : type;
  append_hex(out, frame.id, frame.extended ? kExtendedIdDigits : kStandardIdDigits);
  append_hex(out, frame.size, 1);
  for (const Byte byte : frame.bytes()) append_hex(out, byte, 2);
  out += static_cast<char>(kEndOfLine);
  return out;
}

std::optional<char> lawicel_rate(std::uint32_t bitrate) {
  constexpr std::array<std::uint32_t, 9> kRates{10'000,  20'000,  50'000,  100'000,  125'000,
                                                250'000, 500'000, 800'000, 1'000'000};
  for (std::size_t i = 0; i < kRates.size(); ++i) {
    if (kRates[i] == bitrate) return static_cast<char>('0' + i);
  }
  return std::nullopt;
}

}  // namespace axisgate::can
