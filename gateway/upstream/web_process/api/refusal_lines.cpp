// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/refusal_lines.hpp"

#include <string_view>
#include <utility>

namespace axisgate::web {
namespace {

/// Empty: no line of it.
std::string_view what_happened(Refusal refusal) {
  switch (refusal) {
    case Refusal::not_allowed:
      return "closed: no entry of `allow` names this address";
    case Refusal::connections:
      return "refused: max_connections is reached";
    case Refusal::streams:
      return "refused: max_streams is reached";
    case Refusal::rate:
      return "refused: more than 50 requests a second";
    case Refusal::host:
      return "refused: called by a name that is not ours; `hosts` names further ones";
    case Refusal::slow_reader:
      return "closed: it has not taken what it was sent";
    default:
      return {};
  }
}

}  // namespace

std::optional<std::string> RefusalLines::on(Refusal refusal, const Address& who, SteadyNs now) {
  const std::string_view what = what_happened(refusal);
  if (what.empty()) return std::nullopt;
  Lines& lines = written_[static_cast<std::size_t>(refusal)];
  if (lines.at != 0 && now - lines.at < kEach) {
    ++lines.left_out;
    return std::nullopt;
  }
  lines.at = now;
  const std::uint64_t left_out = std::exchange(lines.left_out, 0);
  std::string out = text(who) + ": " + std::string(what);
  if (left_out != 0) out += " (and " + std::to_string(left_out) + " more since the last such line)";
  return out;
}

}  // namespace axisgate::web
