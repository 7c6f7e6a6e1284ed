// SPDX-License-Identifier: Apache-2.0
#include "adapters/bus/line_remarks.hpp"

#include <fmt/format.h>

#include <utility>

namespace axisgate::bus {

void LineRemarks::tell_of(const EchoWatch& echo, Instant now) {
  if (echo.only_copies()) {
    tell(only_copies_, "only copies of our own requests come: the adapter hears itself, or the line is looped", now);
  }
  if (std::exchange(logged_belief_, echo.belief()) != echo.belief() && echo.belief() == EchoWatch::Belief::echoes) {
    tell(echoes_, "the line echoes: a copy of each request comes back, and is dropped and counted", now);
  }
}

void LineRemarks::misfit(std::string_view asked, std::string_view came, std::string_view why, Instant now) {
  tell(misfit_,
       fmt::format("a valid frame that does not fit: asked was \"{}\", what came is \"{}\" ({})", asked, came, why),
       now);
}

void LineRemarks::tell(Kind& kind, std::string message, Instant now) {
  if (kind.logged_at != kLongAgo && now - kind.logged_at < kPause) {
    ++kind.left_out;
    return;
  }
  kind.logged_at = now;
  if (const std::uint32_t left_out = std::exchange(kind.left_out, 0); left_out > 0) {
    message += fmt::format("; {} more since the last such line", left_out);
  }
  log_.write(LogLevel::warning, source_, message);
}

}  // namespace axisgate::bus
