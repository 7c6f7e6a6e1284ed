// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/foreign_frames.hpp"

#include "gateway/core/bytes.hpp"

namespace axisgate::test::judged {
namespace {

constexpr std::uint32_t kNmt = 0, kSdoRequest = 0x601;  // CiA 301 7.3.3: of node 1
constexpr std::uint8_t kNode = 1;
constexpr std::uint8_t kPreOperational = 0x80, kResetCommunication = 0x82;  // 7.2.8.2.1.1

/// Expedited (CiA 301 7.2.4.3.3), of 2 or 4 bytes.
ForeignFrame download(std::uint16_t index, std::uint8_t sub, std::uint32_t value, unsigned size = 4) {
  const auto byte = [](std::uint32_t from, int at) { return static_cast<std::uint8_t>(from >> (8 * at)); };
  const std::uint8_t specifier = size == 4 ? 0x23 : 0x2B;
  return {
      kSdoRequest,
      {specifier, byte(index, 0), byte(index, 1), sub, byte(value, 0), byte(value, 1), byte(value, 2), byte(value, 3)}};
}

ForeignFrame controlword(std::uint16_t word) { return download(0x6040, 0, word, 2); }

}  // namespace

std::vector<ForeignFrame> foreign_frames(Subject subject, const Step& step) {
  const bool cia402 = subject == Subject::jd_can || subject == Subject::md_can || subject == Subject::leadshine;
  if (!cia402) return {};
  constexpr std::uint32_t kSlowly = 100'000;
  switch (step.number % 8) {
    case 0:
      return {{kNmt, {kResetCommunication, kNode}}};
    case 1:
      return {{kNmt, {kPreOperational, kNode}}};
    case 2:
      return {controlword(6)};
    case 3:
      return {controlword(6), controlword(7), controlword(15)};
    case 4:
      return {{kNmt, {kResetCommunication, kNode}}, controlword(6), controlword(15)};
    case 5:
      return {controlword(6), controlword(7), controlword(15), download(0x60FF, 0, kSlowly)};
    case 6:
      return {download(0x607A, 0, kSlowly), controlword(0x2F), controlword(0x3F)};
    default:
      return {controlword(2)};
  }
}

std::string text(const std::vector<ForeignFrame>& frames) {
  std::string out;
  for (const ForeignFrame& frame : frames)
    out += (out.empty() ? "" : ", ") + std::string(frame.id == kNmt ? "NMT " : "SDO ") + hex_text(frame.bytes);
  return out;
}

}  // namespace axisgate::test::judged
