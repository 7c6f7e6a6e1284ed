// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/http/refusals.hpp"

namespace axisgate::web {
namespace {

struct RefusalRow {
  Refusal refusal;
  std::string_view name;
  unsigned status;
};

constexpr std::array<RefusalRow, kRefusals> kRefusalRows{{
    {Refusal::not_allowed, "not_allowed", 0},
    {Refusal::connections, "connections", 503},
    {Refusal::streams, "streams", 503},
    {Refusal::rate, "rate", 429},
    {Refusal::long_request_line, "long_request_line", 414},
    {Refusal::large_header, "large_header", 431},
    {Refusal::slow_header, "slow_header", 408},
    {Refusal::malformed, "malformed", 400},
    {Refusal::body, "body", 400},
    {Refusal::method, "method", 405},
    {Refusal::host, "host", 421},
    {Refusal::not_found, "not_found", 404},
    {Refusal::parameter, "parameter", 400},
    {Refusal::large_answer, "large_answer", 400},
    {Refusal::memory, "memory", 503},
    {Refusal::slow_reader, "slow_reader", 0},
}};

consteval bool refusals_in_order() {
  for (std::size_t i = 0; i < kRefusalRows.size(); ++i)
    if (static_cast<std::size_t>(kRefusalRows[i].refusal) != i) return false;
  return true;
}
static_assert(refusals_in_order(), "a refusal's number is its position in the table");

}  // namespace

std::string_view name_of(Refusal refusal) { return kRefusalRows.at(static_cast<std::size_t>(refusal)).name; }
unsigned status_of(Refusal refusal) { return kRefusalRows.at(static_cast<std::size_t>(refusal)).status; }

}  // namespace axisgate::web
