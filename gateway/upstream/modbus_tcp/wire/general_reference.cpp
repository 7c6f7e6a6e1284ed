// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/wire/general_reference.hpp"

#include <algorithm>
#include <cassert>

namespace axisgate::modbus_tcp {
namespace {

// The control byte, most significant bit first.
constexpr Byte kExtend = 0x80;
constexpr Byte kTwoByteControl = 0x40;
constexpr Byte kCounter = 0x20;
constexpr Byte kReserved = 0x18;
constexpr Byte kNetwork = 0x04;
constexpr Byte kEncoding = 0x02;
constexpr Byte kWrite = 0x01;

constexpr std::size_t kControlAt = 2;

/// The fields of a header one after another; what lies behind the end of the request reads 0 and makes it short.
class Fields {
 public:
  Fields(Bytes pdu, std::size_t at) : pdu_(pdu), at_(at) {}
  std::uint8_t byte() {
    ++at_;
    return at_ <= pdu_.size() ? pdu_[at_ - 1] : std::uint8_t{0};
  }
  std::uint16_t word() {
    const unsigned high = byte();
    return static_cast<std::uint16_t>((high << 8) | byte());
  }
  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] bool whole() const { return at_ <= pdu_.size(); }

 private:
  Bytes pdu_;
  std::size_t at_;
};

bool control_is_known(Byte control, Byte second, Byte reserved) {
  if ((control & kReserved) != 0 || second != 0 || reserved != 0) return false;
  return (control & kWrite) != 0 || (control & (kExtend | kTwoByteControl)) == 0;
}

}  // namespace

std::optional<GeneralReference> decode_reference(Bytes pdu) {
  Fields fields(pdu, kControlAt);
  const Byte control = fields.byte();
  const Byte second = (control & kTwoByteControl) != 0 ? fields.byte() : Byte{0};
  const Byte reserved = fields.byte();
  if (!control_is_known(control, second, reserved)) return std::nullopt;

  GeneralReference out;
  out.write = (control & kWrite) != 0;
  out.more_follows = (control & kExtend) != 0;
  // Counter and encoding are the client's own: repeated, and otherwise of no meaning here.
  if ((control & kCounter) != 0) static_cast<void>(fields.byte());
  const unsigned network = (control & kNetwork) != 0 ? fields.byte() : 0U;
  if ((control & kEncoding) != 0) static_cast<void>(fields.byte());
  out.node = static_cast<std::uint16_t>((network << 8) | fields.byte());
  out.index = fields.word();
  out.subindex = fields.byte();
  out.start = fields.word();
  const std::size_t head = fields.at();
  out.count = fields.word();
  if (!fields.whole()) return std::nullopt;

  const std::size_t data = pdu.size() - fields.at();
  if (out.write ? data == 0 || data != out.count : data != 0) return std::nullopt;
  const Bytes repeated = pdu.first(head);
  out.head.assign(repeated.begin(), repeated.end());
  return out;
}

std::size_t room_for_data(const GeneralReference& request) { return kMaxPdu - request.data_at(); }

Pdu reference_reply(const GeneralReference& request, Bytes data, bool more) {
  assert(data.size() <= room_for_data(request));
  Pdu pdu(request.head.begin(), request.head.end());
  if (more) pdu[kControlAt] |= kExtend;
  pdu.push_back(static_cast<Byte>(data.size() >> 8));
  pdu.push_back(static_cast<Byte>(data.size() & 0xFF));
  pdu.insert(pdu.end(), data.begin(), data.end());
  return pdu;
}

Pdu abort_pdu(std::uint32_t abort_code) {
  // Extended exception: so many bytes follow, of MEI type 13, its error class, and the code.
  Pdu pdu{0xAB, 0xFF, 0x00, 0x06, kGeneralReference, 0xCE};
  for (int shift = 24; shift >= 0; shift -= 8) pdu.push_back(static_cast<Byte>((abort_code >> shift) & 0xFF));
  return pdu;
}

}  // namespace axisgate::modbus_tcp
