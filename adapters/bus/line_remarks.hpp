// SPDX-License-Identifier: Apache-2.0
// What the log says of a serial line that is not good, whatever is spoken on it: only copies of our requests come, a
// whole frame came that does not fit.
// Promises one line of each kind in kPause at most, with how many were left out. Never decides anything.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "adapters/bus/echo_watch.hpp"
#include "gateway/core/clock.hpp"
#include "gateway/core/log.hpp"

namespace axisgate::bus {

class LineRemarks {
 public:
  static constexpr Duration kPause = std::chrono::minutes(1);

  /// `log` must outlive it; `source` as Log::write() has it.
  LineRemarks(const Log& log, LogSource source) : log_(log), source_(std::move(source)) {}

  /// Before a request goes out: what the watch knows by now.
  void tell_of(const EchoWatch& echo, Instant now);
  /// A frame that is whole and well summed is not the answer.
  void misfit(std::string_view asked, std::string_view came, std::string_view why, Instant now);

 private:
  struct Kind {
    Instant logged_at = kLongAgo;
    std::uint32_t left_out = 0;
  };
  void tell(Kind& kind, std::string message, Instant now);

  const Log& log_;
  LogSource source_;
  Kind only_copies_;
  Kind misfit_;
  EchoWatch::Belief logged_belief_ = EchoWatch::Belief::unknown;
  Kind echoes_;
};

}  // namespace axisgate::bus
