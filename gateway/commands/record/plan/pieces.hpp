// SPDX-License-Identifier: Apache-2.0
// A time that is recorded, cut into pieces that the page's history still holds when they are asked for, and put
// together again. Pure: instants and CSV in, CSV out.
// Promises each row once, however many pieces there are; of one piece the bytes as they came.
// Never looks at a clock, and never makes a row.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/upstream/web_process/time/utc.hpp"

namespace axisgate::commands::record {

/// Nanoseconds since 1970 in UTC, of the page's clock; whole microseconds, as it writes them.
using UtcNs = std::int64_t;
using web::kSecond;
[[nodiscard]] inline std::optional<UtcNs> parse_utc(std::string_view text) { return web::parse_utc(text, {}); }
[[nodiscard]] inline std::string utc_text(UtcNs at) { return web::utc_text(at, {}); }

/// What one request asks for.
struct Piece {
  UtcNs from = 0;
  UtcNs to = 0;
  bool last = false;
  /// Asked for up to there: what happens at a seam must be in one of the two, whatever a time is rounded to.
  [[nodiscard]] UtcNs asked_to() const { return last ? to : to + web::kMillisecond; }
  friend bool operator==(const Piece&, const Piece&) = default;
};
inline constexpr UtcNs kLongestPiece = 5 * kSecond;
/// One after the other, without a gap. At least one. @param to above `from`
[[nodiscard]] std::vector<Piece> pieces_of(UtcNs from, UtcNs to);

/// Puts the answers together. The page repeats at the begin and the end of each what had not changed: such rows stay at
/// the very begin and end alone.
class Joiner {
 public:
  /// What is to be written of it. None: it has other columns than the piece before, or is no CSV of a history.
  [[nodiscard]] std::optional<std::string> take(std::string_view csv, const Piece& piece);

 private:
  [[nodiscard]] bool wanted(std::string_view row, const Piece& piece) const;

  std::string columns_;
  std::optional<std::string> newest_;  ///< values of the newest row: what is between its time and its event
};

}  // namespace axisgate::commands::record
