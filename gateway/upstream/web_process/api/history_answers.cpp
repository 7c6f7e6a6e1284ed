// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/history_answers.hpp"

#include <fmt/format.h>

namespace axisgate::web {
namespace {

EachPoint points_of(const History& history) {
  return [&history](Series series, SteadyNs from, SteadyNs to, const Visit& visit) {
    history.each(series, from, to, visit);
  };
}

std::vector<Series> series_needed(Query& query, const Picture& picture) {
  std::vector<Series> out = series_asked(query, picture);
  if (out.empty())
    throw ParameterFault{
        fmt::format("series: 1 to {} with commas between: 1.velocity_rpm,1.position_rev", kMostSeries)};
  return out;
}

/// How far back all series reach.
std::string oldest_text(const Asked& asked) {
  const SteadyNs oldest = asked.stores.history.oldest();
  return oldest == 0 ? "null" : '"' + utc_text(oldest, asked.now) + '"';
}

}  // namespace

Answer history_answer(const Asked& asked, Query& query) {
  const Picture& picture = asked.stores.picture;
  const std::vector<Series> series = series_needed(query, picture);
  const Span span = span_asked(query, asked.now);
  const std::size_t points = points_asked(query);
  query.end();
  const auto info = [&](std::uint16_t axis) {
    const AxisPicture* found = picture.find(axis);
    return found == nullptr ? nullptr : &found->info;
  };
  const auto lines = series_json(points_of(asked.stores.history), series, span, points, info, asked.now);
  if (!lines)
    return refuse(Refusal::large_answer,
                  fmt::format("the answer would have more than {} bytes: ask for fewer series or points, or for "
                              "/api/v1/history.csv",
                              kMaxJson));
  return text_answer(fmt::format(R"({{"from":"{}","to":"{}","oldest":{},"series":{}}})", utc_text(span.from, asked.now),
                                 utc_text(span.to, asked.now), oldest_text(asked), *lines));
}

Answer csv_answer(const Asked& asked, CsvRequest request, EachPoint each) {
  const auto csv = std::make_shared<HistoryCsv>(std::move(request), std::move(each), asked.now);
  Response out;
  out.type = "text/csv; charset=utf-8";
  out.pieces = [csv] { return csv->next(); };
  out.chunked = asked.request.takes_chunks;
  return {std::move(out)};
}

Answer history_csv_answer(const Asked& asked, Query& query) {
  const Picture& picture = asked.stores.picture;
  CsvRequest request;
  request.series = series_needed(query, picture);
  request.span = span_asked(query, asked.now);
  request.signs = signs_asked(query);
  query.end();
  for (const Series& series : request.series) request.axes.push_back(picture.find(series.axis)->info);
  for (const EventRecord& event : picture.events())
    if (event.at >= request.span.from && event.at <= request.span.to) request.events.push_back(event);
  return csv_answer(asked, std::move(request), points_of(asked.stores.history));
}

}  // namespace axisgate::web
