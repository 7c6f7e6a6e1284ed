// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/wire/mbap.hpp"

namespace axisgate::modbus_tcp {

void MbapFramer::push(Bytes bytes) {
  // Frames already taken are dropped here and not in next(), whose result still looks at them.
  if (begin_ != 0) {
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin_));
    begin_ = 0;
  }
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

MbapFramer::Verdict MbapFramer::next(Frame& frame) {
  const Bytes rest = Bytes(bytes_).subspan(begin_);
  if (rest.size() >= 3 && rest[2] != 0) return Verdict::malformed;  // protocol id: 0 is Modbus
  if (rest.size() >= 4 && rest[3] != 0) return Verdict::malformed;
  if (rest.size() < 6) return Verdict::need_more;
  const std::uint16_t length = load_be16(rest, 4);
  if (length < kMinLength || length > kMaxLength) return Verdict::malformed;
  const std::size_t whole = kMbapSize - 1 + length;
  if (rest.size() < whole) return Verdict::need_more;
  frame = {load_be16(rest, 0), rest[6], rest.subspan(kMbapSize, length - 1U)};
  begin_ += whole;
  return Verdict::frame;
}

}  // namespace axisgate::modbus_tcp
