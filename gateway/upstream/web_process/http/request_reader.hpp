// SPDX-License-Identifier: Apache-2.0
// Requests out of the bytes of one connection, within bounds of size and time. Pure: bytes and instants in.
// Promises that no more than one header and what came with it is ever held, that each bound has its own answer, and
// that how the bytes were cut makes no difference. Never takes a body.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "gateway/upstream/web_process/http/refusals.hpp"
#include "gateway/upstream/web_process/http/request.hpp"
#include "gateway/upstream/web_process/time/utc.hpp"

namespace axisgate::web {

inline constexpr std::size_t kMaxRequestLine = 2048;  ///< bytes, without its end
inline constexpr std::size_t kMaxFields = 64;
inline constexpr std::size_t kMaxHeader = 8192;         ///< bytes, with the line that ends it
inline constexpr SteadyNs kHeaderWithin = 5 * kSecond;  ///< from its first byte to its end
inline constexpr SteadyNs kIdle = 15 * kSecond;         ///< between two requests, and before the first
inline constexpr SteadyNs kAnswerTakenIn = 30 * kSecond;

class RequestReader {
 public:
  explicit RequestReader(SteadyNs now) : since_(now) {}

  /// How many bytes may be given next: none while a whole request waits.
  [[nodiscard]] std::size_t room() const { return kMaxHeader + 1 - std::min(bytes_.size(), kMaxHeader + 1); }
  void received(std::string_view bytes, SteadyNs now);

  /// A request, or why there is none and the connection ends; nothing: more bytes are needed.
  using Read = std::variant<Request, Refusal>;
  [[nodiscard]] std::optional<Read> next();
  /// The request before is answered: the time of the next one begins.
  void answered(SteadyNs now) { since_ = now; }

  /// By when something must have come.
  [[nodiscard]] SteadyNs deadline() const { return since_ + (bytes_.empty() ? kIdle : kHeaderWithin); }
  /// At its deadline: an answer is owed, since a part of a request is here; else the connection is just closed.
  [[nodiscard]] bool late() const { return !bytes_.empty(); }

 private:
  /// Looks at the lines that are new. A refusal; nothing so far.
  [[nodiscard]] std::optional<Refusal> look();

  std::string bytes_;
  SteadyNs since_;          ///< the connection, the answer before, or the first byte of what is here
  std::size_t line_ = 0;    ///< where the line begins that is not looked at yet
  std::size_t looked_ = 0;  ///< no line ends before
  std::size_t lines_ = 0;   ///< of the request that is being read
  std::size_t header_ = 0;  ///< its length, once its end is here
};

}  // namespace axisgate::web
