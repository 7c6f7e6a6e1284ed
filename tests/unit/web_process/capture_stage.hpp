// SPDX-License-Identifier: Apache-2.0
// A gateway of some axes that turn, each sampled every 10 ms, and what the recorder makes of what happens to them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gateway/image/events.hpp"
#include "tests/unit/web_process/told.hpp"

namespace axisgate::web {

class CaptureStage {
 public:
  static constexpr SteadyNs kEach = 10 * kMillisecond;

  explicit CaptureStage(CaptureSettings settings = {}, std::uint16_t axes = 2, std::size_t bytes = kCaptureBytes,
                        std::size_t history = std::size_t{16} << 20);

  /// Hello and all axes: at the start, and after a reload.
  void greet();
  /// All axes are sampled again and again, a turn of the recorder between.
  void run(SteadyNs span, SteadyNs each = kEach);
  /// What the axis shows from now on.
  [[nodiscard]] AxisSample& axis(std::uint16_t number) { return axes_[number]; }
  void fault(std::uint16_t number, bool is = true);
  void event(std::uint16_t number, EventKind kind, std::uint32_t code, const std::string& text);
  /// It turns so fast, 0.001 rpm; at first so fast as 1000 times its number.
  void turn(std::uint16_t number, std::int32_t velocity) { velocities_[number] = velocity; }

  [[nodiscard]] std::vector<Recorder::Kept> captures() const { return stores.recorder.all(); }
  [[nodiscard]] std::vector<std::string> ids() const;
  /// All points of a line of a capture.
  [[nodiscard]] static std::vector<Point> points(const Capture& capture, std::uint16_t axis, Quantity quantity);

  Stores stores;
  SteadyNs now = kStarted;
  std::vector<Recorder::Kept> completed;
  std::vector<std::string> gone;

 private:
  void sample();
  void give_turn();

  std::map<std::uint16_t, AxisSample> axes_;
  std::map<std::uint16_t, std::int32_t> velocities_;
  std::uint64_t events_ = 0;
  std::int64_t steps_ = 0;
};

}  // namespace axisgate::web
