// SPDX-License-Identifier: Apache-2.0
// Whether this program stood still (stopped by a signal, or a machine that gave it no processor), and what of the
// samples that came has waited meanwhile. Promises that what is read from the sockets soon after a standstill counts as
// received when that began: nobody knows when it came, and its writer may be long dead. Pure: instants go in and come
// out. Never judges a sample: the gateway does, by its start_deadline_ms.
#pragma once

#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

class Standstill {
 public:
  /// A busy machine is late as well: below this nothing is made of it.
  static constexpr SteadyNs kLong = 2'000'000'000;
  /// By then the library has read what lay in the sockets.
  static constexpr SteadyNs kReadBy = 1'000'000'000;

  /// The loop has come round, as it does several times a second. @param now steady, in ns
  void turn(SteadyNs now) {
    if (last_ != 0 && now - last_ >= kLong) {
      from_ = last_;
      until_ = now;
    }
    last_ = now;
  }
  /// When a sample must be taken to have come that the library has read at `received`: as much earlier as the
  /// standstill was long, so that samples keep their order.
  [[nodiscard]] SteadyNs came(SteadyNs received) const {
    const bool waited = received > from_ && received <= until_ + kReadBy;
    return waited ? received - (until_ - from_) : received;
  }

 private:
  SteadyNs last_ = 0;
  SteadyNs from_ = 0, until_ = -kReadBy;  ///< of the newest standstill; none yet
};

}  // namespace axisgate::dds
