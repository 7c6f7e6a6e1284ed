// SPDX-License-Identifier: Apache-2.0
// What an axis shows: its image, brought up to date from the newest samples, and the events of what has changed in it.
// Promises that the image's sequence steps once for each change that a client could notice, and that each cause of a
// fault and how the fault ended is logged once. Never decides anything about the axis.
#pragma once

#include <string>

#include "gateway/drive/axis/axis_host.hpp"
#include "gateway/drive/axis/publisher.hpp"
#include "gateway/drive/motion/jog.hpp"
#include "gateway/drive/state/axis_core.hpp"
#include "gateway/drive/watch/way_meter.hpp"
#include "gateway/image/shown.hpp"

namespace axisgate::drive {

class AxisPublisher {
 public:
  AxisPublisher(AxisCore& core, AxisImage& image, AxisHost& host);

  /// What does not change with its samples: what it has, its limits.
  void show_model() { writer_.show_model(); }
  /// Brings the image up to date. `zero_may_move`: a homing or set_position is asked for or under way.
  void publish(const Jog& jog, bool zero_may_move);

  /// The latest result. `stop`: its number, of a stop.
  void result(const WriteBatch& batch, CommandResult result, std::uint32_t detail = 0, std::uint64_t stop = 0);

  /// The axis has shown a fault until now; a client asks for its reset.
  void reset_asked(const std::string& by);
  /// What was asked for has failed.
  void reset_failed() { fault_.reset_by.clear(); }
  /// Between the last two samples of the statusword: the poll cycle as it really is.
  [[nodiscard]] Duration cycle() const { return cycle_; }
  /// When publish() would show something else without a new sample.
  [[nodiscard]] Instant stale_at() const { return writer_.stale_at(); }
  /// When the newest statusword was asked for.
  [[nodiscard]] Instant heard() const { return last_statusword_; }

 private:
  void measure_cycle();
  void tell_link(LinkState before);
  void tell_changes(const AxisView& before);
  void tell_fault(const AxisView& before);
  void count();

  AxisCore& core_;
  AxisImage& image_;
  AxisHost& host_;
  AxisWriter writer_;
  AxisView shown_;  ///< as it was published last
  Duration cycle_{};
  Instant last_statusword_ = kLongAgo;
  bool zero_moves_ = false;         ///< when it was published last
  Instant enabled_until_ = kNever;  ///< its time with torque is counted until then; kNever: it has none
  WayMeter way_;
  struct Fault {
    Instant since = kLongAgo;               ///< kLongAgo: there is none
    std::optional<std::uint16_t> logged{};  ///< its cause, as log and events have it
    std::string reset_by{};                 ///< who has asked for a reset of it last; empty: nobody
  } fault_;
};

}  // namespace axisgate::drive
