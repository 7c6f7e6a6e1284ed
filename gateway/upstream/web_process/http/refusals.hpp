// SPDX-License-Identifier: Apache-2.0
// Why somebody did not get what was asked for, with the status that says so, and how often each reason was met.
// Promises that every reason has one status and one name. Never decides whether it is met.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace axisgate::web {

enum class Refusal : std::uint8_t {
  not_allowed,        ///< no `allow` entry names the address: closed without an answer
  connections,        ///< max_connections
  streams,            ///< max_streams
  rate,               ///< more requests than an address has
  long_request_line,  ///< above kMaxRequestLine
  large_header,       ///< above kMaxFields or kMaxHeader
  slow_header,        ///< its end did not come within kHeaderWithin
  malformed,          ///< no HTTP/1.x request
  body,               ///< a GET or HEAD with a body
  method,             ///< neither GET nor HEAD
  host,               ///< Host is not ours
  not_found,          ///< nothing is called so
  parameter,          ///< unknown, or of a value that it cannot have
  large_answer,       ///< above kMaxJson
  memory,             ///< answers that others have not taken yet fill what there is for them
  slow_reader,        ///< an answer or a stream was not taken in time: closed
};
inline constexpr std::size_t kRefusals = static_cast<std::size_t>(Refusal::slow_reader) + 1;

[[nodiscard]] std::string_view name_of(Refusal refusal);
/// 0: there is no answer.
[[nodiscard]] unsigned status_of(Refusal refusal);

class RefusalCounts {
 public:
  void count(Refusal refusal) { ++counts_[static_cast<std::size_t>(refusal)]; }
  [[nodiscard]] std::uint64_t of(Refusal refusal) const { return counts_[static_cast<std::size_t>(refusal)]; }

 private:
  std::array<std::uint64_t, kRefusals> counts_{};
};

}  // namespace axisgate::web
