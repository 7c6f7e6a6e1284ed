// SPDX-License-Identifier: Apache-2.0
// A CAN link with what every protocol on it does alike: frames out and in are counted and, where asked for, written to
// the log. Promises that no frame passes uncounted. Never knows what a frame means.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adapters/bus/statistics.hpp"
#include "adapters/can/can_link.hpp"
#include "gateway/core/log.hpp"

namespace axisgate::can {

class CanLine {
 public:
  /// A frame in the words of its protocol, for the log.
  using Describe = std::string (*)(const CanFrame& frame);

  /// `bus`: its name, for the log. `log` must outlive the line.
  CanLine(const std::string& bus, std::unique_ptr<CanLink> link, const Log& log, Describe describe);

  void start(CanLinkEvents& events, std::vector<CanFilter> filters) { link_->start(events, std::move(filters)); }
  void on_up();
  /// False: it was down already.
  [[nodiscard]] bool on_down() { return std::exchange(up_, false); }
  [[nodiscard]] bool up() const { return up_; }

  void send(const CanFrame& frame, bool urgent = false);
  /// Every frame that comes in, whoever's it is.
  void count(const CanFrame& frame);
  /// One that is ours; `remark` stands behind it.
  void tell(const CanFrame& frame, std::string_view remark = "") const { log_frame("<-", frame, remark); }

  void set_decode(bool on) { decode_ = on; }
  /// Of all frames, sent and heard.
  [[nodiscard]] std::uint64_t bits() const { return bits_; }
  [[nodiscard]] const bus::Statistics& statistics() const;
  void count_bad_frame() { ++statistics_.bad_frames; }
  void count_late_reply() { ++statistics_.late_replies; }

 private:
  void log_frame(std::string_view direction, const CanFrame& frame, std::string_view remark) const;

  LogSource log_source_;
  const Log& log_;
  Describe describe_;
  bool decode_ = false;
  bool up_ = false;
  bool ever_up_ = false;
  std::uint64_t bits_ = 0;
  mutable bus::Statistics statistics_;
  std::unique_ptr<CanLink> link_;  // last, so that it goes first
};

}  // namespace axisgate::can
