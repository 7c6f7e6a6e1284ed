// SPDX-License-Identifier: Apache-2.0
// An answer, and how its header looks. Promises the fields of safety on every answer, errors too, and a problem+json
// that says what was wrong and what may be. Never any field that lets another origin read it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "gateway/upstream/web_process/http/refusals.hpp"
#include "gateway/upstream/web_process/time/utc.hpp"

namespace axisgate::web {

struct Response {
  unsigned status = 200;
  std::string_view type{};  ///< Content-Type; empty: there is no body, not even an empty one
  /// Shared, or of the program itself: no answer copies a file.
  std::shared_ptr<const std::string> owned{};
  std::string_view fixed{};
  /// The next piece of a body that is made while it is taken; empty: that was all. In place of `owned` and `fixed`.
  std::function<std::string()> pieces{};
  bool chunked = true;  ///< of pieces: as HTTP/1.1 has them; false: the connection's end is the body's
  std::string_view cache = "no-store";
  std::string fields{};  ///< further ones, each with its end
  bool close = false;    ///< the connection ends behind it

  [[nodiscard]] std::string_view body() const { return owned ? std::string_view(*owned) : fixed; }
};

inline constexpr std::string_view kJson = "application/json";
/// Answers of JSON are no longer.
inline constexpr std::size_t kMaxJson = 1024 * 1024;
/// Of pieces together: one that would be longer is broken off before its end, so that nobody takes it for whole.
inline constexpr std::uint64_t kMaxPieces = 64 * 1024 * 1024;

[[nodiscard]] Response json_response(std::string text, unsigned status = 200);
/// application/problem+json (RFC 9457), with what belongs to the refusal: Allow, Retry-After, the end of the
/// connection. @param detail what was wrong, and what may be
[[nodiscard]] Response problem(Refusal refusal, std::string_view detail);
/// What there is to say of a refusal that has no detail of its own.
[[nodiscard]] Response problem(Refusal refusal);

/// Status line and header, with the line that ends it. Keeps the connection where `keep_alive` and the response do.
[[nodiscard]] std::string header_of(const Response& response, bool keep_alive, const Now& now);
/// A piece as it goes out; an empty one: the end.
[[nodiscard]] std::string piece_of(const Response& response, std::string piece);
/// The header of a stream of events: it has no length, and ends with the connection.
[[nodiscard]] std::string stream_header(const Now& now);

}  // namespace axisgate::web
