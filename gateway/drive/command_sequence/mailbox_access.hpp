// SPDX-License-Identifier: Apache-2.0
// The object of the mailbox within a command sequence: its exchanges, one after the other, and what their answers come
// to for who asked (design 3.1, FC 43/13). Pure. Promises that the parts of a long object go in order, from the first
// to the last, and that a refusal is answered with the abort code of CiA 301. Never looks at the axis's state, and
// decides nothing about other writes.
#pragma once

#include "adapters/bus/exchange.hpp"
#include "gateway/drive/state/axis_core.hpp"
#include "gateway/image/command.hpp"

namespace axisgate::drive {

// How drives say that they have no such object.
inline constexpr std::uint32_t kNoSuchObject = 0x06020000;  ///< CiA 301 table 22; Kinco's serial too
inline constexpr std::uint32_t kModbusIllegalAddress = 2;

class MailboxAccess {
 public:
  /// A write that would wear out the drive's memory, of what the drive is known to hold: it is sent on change only.
  [[nodiscard]] static bool is_needless(const AxisCore& core, const ObjectRequest& request);
  /// What goes on the wire next.
  [[nodiscard]] bus::Exchange next(const model::DriveModel& drive, const ObjectRequest& request) const;
  /// The result of the exchange given last. What was read, or how it was refused, goes into `answer`.
  [[nodiscard]] Outcome take(const model::DriveModel& drive, const ObjectRequest& request,
                             const bus::ExchangeResult& result, BatchResult& answer);

  /// Nothing is left to send.
  [[nodiscard]] bool done() const { return done_; }
  /// A part of a long object was answered, and more are to come.
  [[nodiscard]] bool chain_open() const { return chain_open_; }

 private:
  bool done_ = false;
  bool chain_open_ = false;
};

}  // namespace axisgate::drive
