// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/cable_words.hpp"

#include <algorithm>

#include "tests/stage_drive/rtu_truth.hpp"

namespace axisgate::test::judged {
namespace {

namespace cob = simulated::cob;

constexpr std::size_t kKincoFrame = 10, kSdoFrame = 8, kErrorReply = 5;
constexpr Byte kWriteFour = 0x23, kWriteTwo = 0x2B, kWriteOne = 0x2F, kReadReply4 = 0x43, kReadReply2 = 0x4B,
               kReadReply1 = 0x4F, kWriteReply = 0x60, kError = 0x80;
constexpr std::uint32_t kNodeBits = 0x7F;

bool between(std::uint32_t id, std::uint32_t base) { return id > base && id <= base + kNodeBits; }

bool is_sdo_request(const CableFrame& frame) { return !frame.can->remote && between(frame.can->id, cob::sdo_request); }

bool sums_to_zero(Bytes window) {
  unsigned sum = 0;
  for (const Byte b : window) sum += b;
  return (sum & 0xFF) == 0;
}

std::uint32_t named(Bytes bytes, std::size_t at) { return std::uint32_t{load_le16(bytes, at)} << 8 | bytes[at + 2]; }

Request kinco_request(Bytes frame) {
  const bool write = frame[1] == kWriteFour || frame[1] == kWriteTwo || frame[1] == kWriteOne;
  return {Tongue::kinco, frame[0], write, true, named(frame, 2), load_le(frame, 5, 4), {}};
}

Request rtu_request(Bytes frame) {
  const RtuRequest asked = test::request_in(frame);
  Request out{Tongue::rtu, asked.unit, asked.write, true, std::uint32_t{asked.start} << 8, 0, {}};
  if (asked.write) out.value = asked.values.front();
  return out;
}

Request sdo_request(const CableFrame& frame) {
  const auto node = static_cast<std::uint8_t>(frame.can->id & kNodeBits);
  const bool names = frame.bytes[0] >> 5 == sdo::kUpload || frame.bytes[0] >> 5 == sdo::kDownload;
  return {Tongue::canopen,
          node,
          frame.bytes[0] >> 5 == sdo::kDownload,
          true,
          names ? named(frame.bytes, 1) : 0,
          load_le(frame.bytes, 4, 4),
          {}};
}

Request keya_request(Tongue tongue, Bytes frame) {
  const bool control = frame[0] == simulated::keya_start::control;
  const std::size_t code = tongue == Tongue::keya_rs485 ? 2 : 1;
  return {tongue, code == 2 ? frame[1] : Byte{0}, control, !control, 0, frame[code], {}};
}

// Some window of what was heard is an answer to it: same station, object and a response command.
bool kinco_answered(Bytes request, Bytes heard) {
  for (std::size_t at = 0; at + kKincoFrame <= heard.size(); ++at) {
    const Bytes window = heard.subspan(at, kKincoFrame);
    const bool same =
        window[0] == request[0] && std::equal(window.begin() + 2, window.begin() + 5, request.begin() + 2);
    constexpr std::array kResponses{kReadReply4, kReadReply2, kReadReply1, kWriteReply, kError};
    if (same && std::ranges::find(kResponses, window[1]) != kResponses.end() && sums_to_zero(window)) return true;
  }
  return false;
}

// The registers asked for, an acknowledgement, or an error reply.
bool rtu_answered(Bytes request, Bytes heard) {
  if (reply_in(heard, test::request_in(request))) return true;
  for (std::size_t at = 0; at + kErrorReply <= heard.size(); ++at) {
    const Bytes window = heard.subspan(at, kErrorReply);
    if (window[0] == request[0] && (window[1] & 0x80) != 0 && simulated::open_rtu(window)) return true;
  }
  return false;
}

// Segments name no object; an abort ends whatever is open.
bool sdo_answered(const Request& request, const CableFrame& heard) {
  if (heard.can->remote || (heard.can->id & kNodeBits) != request.node) return false;
  if (!between(heard.can->id, cob::sdo_reply) || heard.bytes.size() < 4) return false;
  if (request.object == 0) return true;
  return named(heard.bytes, 1) == request.object;
}

bool keya_answered(const Request& request, Bytes heard) {
  const std::size_t head = request.tongue == Tongue::keya_rs485 ? 3 : 2;
  for (std::size_t at = 0; at + simulated::keya_frame_length <= heard.size(); ++at)
    if (std::equal(request.bytes.begin(), request.bytes.begin() + static_cast<std::ptrdiff_t>(head),
                   heard.begin() + static_cast<std::ptrdiff_t>(at)))
      return true;
  return false;
}

// CiA 402: the bits of operation enabled, and the one whose edge starts a move or a homing unless halt holds it.
void read_controlword(Deeds& deeds, std::uint32_t word) {
  deeds.enabled_after = (word & 0xF) == 0xF;
  deeds.starts = deeds.enabled_after && (word & 0x110) == 0x10;
}

}  // namespace

Tongue tongue_of(Subject subject) {
  if (is_eds(subject)) return Tongue::canopen;
  constexpr std::array<Tongue, kSubjects.size()> kTongues{
      Tongue::kinco,    Tongue::kinco,   Tongue::rtu,        Tongue::rtu,       Tongue::canopen,    Tongue::canopen,
      Tongue::canopen,  Tongue::rtu,     Tongue::keya_can,   Tongue::canopen,   Tongue::keya_rs232, Tongue::keya_rs485,
      Tongue::keya_can, Tongue::canopen, Tongue::keya_rs232, Tongue::keya_rs485};
  const auto at = static_cast<std::size_t>(std::ranges::find(kSubjects, subject) - kSubjects.begin());
  return kTongues.at(at);
}

bool is_whole(Tongue tongue, const CableFrame& frame) {
  switch (tongue) {
    case Tongue::kinco:
      return frame.bytes.size() == kKincoFrame && sums_to_zero(frame.bytes);
    case Tongue::rtu:
      return simulated::open_rtu(frame.bytes).has_value();
    case Tongue::canopen:
      return !is_sdo_request(frame) || frame.bytes.size() == kSdoFrame;
    case Tongue::keya_can:
      return frame.can->extended && frame.bytes.size() == can::kMaxFrameBytes;
    default:
      return frame.bytes.size() == simulated::keya_frame_length;
  }
}

std::optional<Request> request_in(Tongue tongue, const CableFrame& frame) {
  std::optional<Request> out;
  switch (tongue) {
    case Tongue::kinco:
      out = kinco_request(frame.bytes);
      break;
    case Tongue::rtu:
      out = rtu_request(frame.bytes);
      break;
    case Tongue::canopen:
      if (!is_sdo_request(frame) || frame.bytes[0] == sdo::kAbort) return std::nullopt;
      out = sdo_request(frame);
      break;
    case Tongue::keya_can:
      out = Request{tongue,
                    static_cast<std::uint8_t>(frame.can->id & 0xFF),
                    frame.bytes[0] == kWriteFour,
                    true,
                    named(frame.bytes, 1),
                    simulated::big_endian(frame.bytes.subspan(4, 4)),
                    {}};
      break;
    default:
      out = keya_request(tongue, frame.bytes);
  }
  out->bytes.assign(frame.bytes.begin(), frame.bytes.end());
  return out;
}

bool is_over(const Request& request, const CableFrame& heard) {
  switch (request.tongue) {
    case Tongue::kinco:
      return kinco_answered(request.bytes, heard.bytes);
    case Tongue::rtu:
      return rtu_answered(request.bytes, heard.bytes);
    case Tongue::canopen:
      return sdo_answered(request, heard) || booted(request.tongue, heard) == request.node;
    case Tongue::keya_can:
      return heard.can->id == simulated::keya_can::reply + request.node && heard.bytes.size() == 8 &&
             load_le16(heard.bytes, 1) == request.object >> 8;
    default:
      return keya_answered(request, heard.bytes);
  }
}

bool is_abort_of(const Request& request, const CableFrame& frame) {
  return request.tongue == Tongue::canopen && is_sdo_request(frame) && frame.bytes[0] == sdo::kAbort &&
         (frame.can->id & kNodeBits) == request.node;
}

bool is_nmt_command(Tongue tongue, const CableFrame& frame) {
  return tongue == Tongue::canopen && frame.to_drive && frame.can->id == cob::nmt;
}

std::optional<std::uint8_t> booted(Tongue tongue, const CableFrame& frame) {
  if (tongue != Tongue::canopen || frame.to_drive || frame.can->remote) return std::nullopt;
  const bool boot = between(frame.can->id, cob::error_control) && frame.bytes.size() == 1 && frame.bytes[0] == 0;
  return boot ? std::optional(static_cast<std::uint8_t>(frame.can->id & kNodeBits)) : std::nullopt;
}

Deeds deeds_of(Subject subject, const Request& request, bool enabled_before) {
  Deeds deeds{.node = request.node, .enabled_after = enabled_before};
  if (!request.write) return deeds;
  constexpr std::uint32_t kControlword = 0x604000, kItsRegister = 0x310000, kSteppersControl = 323U << 8;
  constexpr std::uint32_t kEnableA = 0x200D01, kEnableB = 0x200D02, kDisableA = 0x200C01;
  constexpr std::uint32_t kCommandA = 0x607A00, kCommandB = 0x608300, kCodeOfEnable = 0x030D20;
  if (is_cia402(subject)) {
    if (request.object == kControlword || request.object == kItsRegister) read_controlword(deeds, request.value);
  } else if (subject == Subject::id286pro) {
    // Absolute and relative move, speed, both jogs, a new position, homing (iD286pro 5).
    constexpr std::array<std::uint32_t, 7> kStarts{1, 2, 3, 4, 5, 8, 12};
    deeds.starts = request.object == kSteppersControl && std::ranges::find(kStarts, request.value) != kStarts.end();
  } else if (request.tongue == Tongue::keya_can) {
    deeds.of_motor_b = request.object == kEnableB;
    deeds.enables = request.object == kEnableA;  // carries no value: each one enables
    if (request.object == kEnableA || request.object == kDisableA) deeds.enabled_after = deeds.enables;
    return deeds;
  } else if (request.tongue == Tongue::canopen) {
    deeds.of_motor_b = request.object == kCommandB && request.value >> 8 == kCodeOfEnable;
    deeds.enables = request.object == kCommandA && request.value >> 8 == kCodeOfEnable;
    return deeds;
  } else {
    deeds.enabled_after = (request.value & 1) != 0;
    deeds.of_motor_b = (request.value & 2) != 0;
  }
  deeds.enables = deeds.enabled_after && !enabled_before;
  return deeds;
}

}  // namespace axisgate::test::judged
