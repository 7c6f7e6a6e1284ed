// SPDX-License-Identifier: Apache-2.0
// Instants of this program, and how they are written for people: the steady clock that the gateway shares, and what
// makes the time of day of it. Promises UTC with microseconds. Never looks at a clock: whoever asks brings the instant.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/upstream/link/coder.hpp"

namespace axisgate::web {

using link::kMillisecond;
using link::kSecond;
using link::SteadyNs;
inline constexpr SteadyNs kMicrosecond = 1000;

struct Now {
  SteadyNs at = 0;
  /// What is to be added to a steady instant: the sum counts from 1970 in UTC, ns.
  std::int64_t to_utc = 0;
};

/// "2026-11-28T20:40:00.123456Z"
[[nodiscard]] std::string utc_text(SteadyNs at, const Now& now);
/// Back: with a 'Z' at its end, whole seconds or up to nine digits of a fraction; of the years 1971 to 2199. None: it
/// is no such text.
[[nodiscard]] std::optional<SteadyNs> parse_utc(std::string_view text, const Now& now);
/// Of now, as the Date of an answer has it (RFC 9110, 5.6.7): "Sat, 28 Nov 2026 20:40:00 GMT".
[[nodiscard]] std::string http_date(const Now& now);

/// Whole milliseconds since then; 0 where it is still to come.
[[nodiscard]] constexpr std::int64_t ms_since(SteadyNs then, SteadyNs now) {
  return then >= now ? 0 : (now - then) / kMillisecond;
}

}  // namespace axisgate::web
