// SPDX-License-Identifier: Apache-2.0
// The write of some bits of an object (Exchange::mask): it is read, and written back with these bits changed. Pure:
// answers and instants go in, what goes over the wire comes out. Promises that nothing is written where the read before
// it was not answered in the object's own width. Never sends: the bus does, with nothing between the two.
#pragma once

#include <bit>

#include "adapters/bus/exchange.hpp"

namespace axisgate::bus {

class PartWrite {
 public:
  /// What goes over the wire first: of any other exchange itself.
  [[nodiscard]] const Exchange& begin(const Exchange& exchange) {
    mask_ = exchange.mask;
    wire_ = exchange;
    if (mask_ == 0) return wire_;
    raw_ = exchange.raw;
    wire_ = {exchange.node, Access::read, exchange.object, exchange.size, 0};
    wire_.unsaid = exchange.size;
    return wire_;
  }
  /// The answer of what went over the wire. True: there is more to send.
  [[nodiscard]] bool answered(const ExchangeResult& result) {
    if (mask_ == 0 || result.code != Errc::ok || !is_whole(result)) return false;
    wire_.access = Access::write;
    wire_.raw = (result.fields.front().raw & ~mask_) | ((raw_ << std::countr_zero(mask_)) & mask_);
    wire_.unsaid = 0;
    mask_ = 0;
    return true;
  }
  /// An answer that no write can go by; it proves nothing of the write.
  [[nodiscard]] bool is_useless(const ExchangeResult& result) const {
    return mask_ != 0 && result.code == Errc::ok && !is_whole(result);
  }
  /// It has come no further than the read.
  [[nodiscard]] bool reads() const { return mask_ != 0; }
  /// What went, or goes, over the wire.
  [[nodiscard]] const Exchange& on_wire() const { return wire_; }

 private:
  [[nodiscard]] bool is_whole(const ExchangeResult& result) const {
    return result.fields.size() == 1 && result.fields.front().size == wire_.size;
  }

  Exchange wire_;
  std::uint32_t raw_ = 0;
  std::uint32_t mask_ = 0;  ///< 0: no such write, or what is on the wire is the write
};

}  // namespace axisgate::bus
