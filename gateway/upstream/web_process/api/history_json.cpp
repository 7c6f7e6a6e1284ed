// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/history_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/upstream/web_process/history/slices.hpp"
#include "gateway/upstream/web_process/http/response.hpp"

namespace axisgate::web {

std::optional<std::string> series_json(const EachPoint& each, const std::vector<Series>& series, const Span& span,
                                       std::size_t points, const InfoOf& info, const Now& now) {
  std::string out = "{";
  for (const Series& one : series) {
    const AxisInfoRecord* const axis = info(one.axis);
    out += fmt::format("{}\"{}\":[", out.back() == '{' ? "" : ",", series_text(one));
    for (const Slice& slice : axis == nullptr ? std::vector<Slice>() : slices(each, one, span.from, span.to, points)) {
      const auto number = [&](std::int64_t value) {
        return slice.known ? series_value(one.name, value, *axis).dump() : "null";
      };
      out += fmt::format("{}[\"{}\",{},{}]", out.back() == '[' ? "" : ",", utc_text(slice.at, now), number(slice.low),
                         number(slice.high));
      if (out.size() > kMaxJson) return std::nullopt;
    }
    out += ']';
  }
  return out + "}";
}

}  // namespace axisgate::web
