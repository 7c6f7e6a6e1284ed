// SPDX-License-Identifier: Apache-2.0
// Whether a serial line can be spoken on: its link, and the noise on it.
// Promises that a line that babbles is opened again kReopensInARow times and then reported down until it is quiet, with
// a look at it each kSecondLook, and that the bus hears of up and down in turn. Never looks into a byte: the wire says
// what was an answer and what was noise.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "adapters/bus/noise_watch.hpp"
#include "adapters/bus/wire.hpp"
#include "gateway/core/clock.hpp"

namespace axisgate::bus {

class LineWatch {
 public:
  /// Since the last answer.
  static constexpr int kReopensInARow = 3;
  /// How often a line that was given up is looked at again.
  static constexpr Duration kSecondLook = std::chrono::seconds(1);

  /// What it asks of the wire.
  struct Line {
    /// Opens the link again; down and up may be reported from inside it.
    std::function<void(std::string_view why)> reopen;
    /// The line is given up, and the link stays open: what is outstanding is to be dropped, before the bus hears of it.
    std::function<void()> drop;
  };

  LineWatch(Runtime& runtime, Line line);
  /// Before anything else; `events` must outlive the watch.
  void start(WireEvents& events) { events_ = &events; }

  // What the wire hears of its link. Last in its handlers: the bus may act from inside these.
  void on_link_up();
  void on_link_down(std::string_view why);
  void on_answer();
  /// Bytes came that belong to no frame.
  void on_noise();

  /// As reported to the bus last.
  [[nodiscard]] bool up() const { return reported_up_; }
  /// Noise goes on, but for a pause of NoiseWatch::kPause at most.
  [[nodiscard]] bool noisy() const { return noise_.heard_lately(runtime_.now()); }
  /// How often it was up again.
  [[nodiscard]] std::uint32_t reconnects() const { return reconnects_; }

 private:
  void on_babble();
  void look_again();
  void report(bool up, std::string_view why);

  Runtime& runtime_;
  Line line_;
  WireEvents* events_ = nullptr;
  NoiseWatch noise_;
  bool link_up_ = false;
  bool reported_up_ = false;
  bool ever_up_ = false;
  bool given_up_ = false;  ///< reported down for its noise, though the link is open
  int reopens_ = 0;        ///< since the last answer
  std::uint32_t reconnects_ = 0;
  std::unique_ptr<Timer> timer_;
};

}  // namespace axisgate::bus
