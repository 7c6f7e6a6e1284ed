// SPDX-License-Identifier: Apache-2.0
// One request on its way to its answer, and what several answers ask of a request in the same words.
// Promises that what a parameter may not be is named with what it may be. Never knows a path.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gateway/upstream/web_process/api/history_csv.hpp"
#include "gateway/upstream/web_process/api/history_json.hpp"
#include "gateway/upstream/web_process/api/router.hpp"
#include "gateway/upstream/web_process/http/query.hpp"

namespace axisgate::web {

struct Asked {
  const Request& request;
  const Stores& stores;
  const Served& served;
  const Now& now;
  std::string name{};  ///< behind the route's path
};

[[nodiscard]] Answer refuse(Refusal refusal);
[[nodiscard]] Answer refuse(Refusal refusal, const std::string& detail);
/// JSON; refused where it is longer than kMaxJson.
[[nodiscard]] Answer text_answer(std::string text, unsigned status = 200);

/// Numbers of all axes, with commas between.
[[nodiscard]] std::string axes_text(const Picture& picture);

// What follows throws ParameterFault where a parameter is none of those that it may be.

/// Why there is nothing of this axis; empty: there is.
using NotThere = std::function<std::string(std::uint16_t axis)>;
/// `series`: up to kMostSeries, each once, of axes that there are; empty: it was not given.
[[nodiscard]] std::vector<Series> series_asked(Query& query, const NotThere& not_there);
[[nodiscard]] std::vector<Series> series_asked(Query& query, const Picture& picture);
/// `from` and `to`: UTC, or seconds before now ("-10"); without them the last minute.
[[nodiscard]] Span span_asked(Query& query, const Now& now);
/// `points`.
[[nodiscard]] std::size_t points_asked(Query& query);
/// `separator` and `decimal`.
[[nodiscard]] CsvSigns signs_asked(Query& query);

}  // namespace axisgate::web
