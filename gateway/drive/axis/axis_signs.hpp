// SPDX-License-Identifier: Apache-2.0
// What the samples of one axis show that its drive has not said: that it has restarted between two polls, that its
// position counter has run over, that it no more holds what a client has written, that it has enabled itself. Promises
// that what was cached of before is read again, and one event for each. Never stops the axis: the guard does.
#pragma once

#include <cstdint>
#include <optional>

#include "gateway/drive/axis/axis_host.hpp"
#include "gateway/drive/axis/axis_watch.hpp"
#include "gateway/drive/axis/pending_batches.hpp"
#include "gateway/drive/guard/guard.hpp"
#include "gateway/drive/state/axis_core.hpp"

namespace axisgate::drive {

class AxisSigns {
 public:
  AxisSigns(AxisCore& core, AxisWatch& watch, Guard& guard, AxisHost& host)
      : core_(core), watch_(watch), guard_(guard), host_(host) {}

  /// The drive comes up from scratch.
  void on_bring_up();
  /// It was suspect: it may have restarted unseen.
  void on_invalidated() { reference_invalidated_ = true; }
  /// New samples.
  void observe(const AxisFacts& facts, const PendingBatches& pending);

 private:
  void observe_reference(const AxisFacts& facts, bool pending);
  void observe_counter();
  void observe_volatile(bool pending);
  void observe_homing_method(bool pending);
  void observe_end_of_fault(const AxisFacts& facts, bool enables);
  /// A serial drive has restarted between two polls, as that sign tells: what was cached of it is not true any more.
  void on_unseen_restart(const char* sign);
  void warn(std::string text) { host_.event(core_.model.number, EventKind::warning, 0, std::move(text)); }

  AxisCore& core_;
  AxisWatch& watch_;
  Guard& guard_;
  AxisHost& host_;
  bool reference_invalidated_ = false;
  bool holds_method_ = false;              ///< its drive was seen to hold the homing_method that a client has written
  bool faulted_ = false;                   ///< as seen last
  std::optional<std::int64_t> counted_{};  ///< the position as the drive counts, as seen last without a gap
  bool speeds_lost_ = false;  ///< its drive holds other speeds than it was sent; a start will write them again
};

}  // namespace axisgate::drive
