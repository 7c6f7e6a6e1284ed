// SPDX-License-Identifier: Apache-2.0
// Bytes as tests write and read them: "03 00 64 00 02".
// Promises that what is printed can be pasted back. Never used outside tests.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/bytes.hpp"

namespace axisgate::modbus_tcp::test {

inline std::vector<Byte> bytes(std::string_view hex) {
  std::vector<Byte> out;
  int digits = 0;
  unsigned value = 0;
  for (const char c : hex) {
    if (c == ' ') continue;
    value = value * 16 + static_cast<unsigned>(c <= '9' ? c - '0' : (c & ~0x20) - 'A' + 10);
    if (++digits % 2 == 0) {
      out.push_back(static_cast<Byte>(value));
      value = 0;
    }
  }
  return out;
}

/// The whole frame of a PDU.
inline std::vector<Byte> frame(std::uint16_t transaction, std::uint8_t unit, const std::vector<Byte>& pdu) {
  const auto length = static_cast<std::uint16_t>(pdu.size() + 1);
  std::vector<Byte> out(7);
  store_be16(out, 0, transaction);
  store_be16(out, 4, length);
  out[6] = unit;
  out.insert(out.end(), pdu.begin(), pdu.end());
  return out;
}

/// Two registers of a number, high word first.
inline std::string words(std::int64_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  const Byte parts[] = {static_cast<Byte>(bits >> 24), static_cast<Byte>(bits >> 16), static_cast<Byte>(bits >> 8),
                        static_cast<Byte>(bits)};
  return hex_text(parts);
}
inline std::string word(std::int64_t value) {
  const auto bits = static_cast<std::uint16_t>(value);
  const Byte parts[] = {static_cast<Byte>(bits >> 8), static_cast<Byte>(bits)};
  return hex_text(parts);
}

}  // namespace axisgate::modbus_tcp::test
