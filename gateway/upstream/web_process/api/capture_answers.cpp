// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/capture_answers.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/upstream/web_process/api/captures_json.hpp"
#include "gateway/upstream/web_process/api/history_answers.hpp"

namespace axisgate::web {
namespace {

/// All that are asked for; without a word of it, those of its axis.
std::vector<Series> lines_asked(Query& query, const Capture& capture) {
  std::vector<Series> out = series_asked(query, [&](std::uint16_t axis) {
    return capture.find(axis) != nullptr ? std::string() : fmt::format("axis {} is not in this capture", axis);
  });
  if (!out.empty()) return out;
  for (const auto& [series, points] : capture.lines)
    if (series.axis == capture.first().axis) out.push_back(series);
  return out;
}

Answer capture_csv_answer(const Asked& asked, Query& query, const Recorder::Kept& capture) {
  CsvRequest request;
  request.series = lines_asked(query, *capture);
  request.signs = signs_asked(query);
  query.end();
  for (const Series& series : request.series) request.axes.push_back(*capture->find(series.axis));
  request.events = capture->events;
  request.span = span_of(*capture);
  const Now day = day_of(*capture);
  const Asked of_its_day{asked.request, asked.stores, asked.served, day};
  return csv_answer(of_its_day, std::move(request),
                    [capture](Series series, SteadyNs from, SteadyNs to, const Visit& visit) {
                      capture->each(series, from, to, visit);
                    });
}

}  // namespace

Answer captures_answer(const Asked& asked, Query& query) {
  query.end();
  return text_answer(
      captures_json(asked.stores.recorder).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

Answer capture_answer(const Asked& asked, Query& query) {
  constexpr std::string_view kCsv = ".csv";
  const bool csv = asked.name.ends_with(kCsv);
  const std::string id = csv ? asked.name.substr(0, asked.name.size() - kCsv.size()) : asked.name;
  const Recorder::Kept capture = asked.stores.recorder.find(id);
  if (!capture)
    return refuse(Refusal::not_found,
                  "there is no such capture, or it is not kept any more; /api/v1/captures lists those that there are");
  if (csv) return capture_csv_answer(asked, query, capture);
  const auto points = query.number("points", kLeastPoints, kMostPoints).value_or(kCapturePoints);
  const std::vector<Series> series = lines_asked(query, *capture);
  query.end();
  const auto whole = whole_capture_json(*capture, series, static_cast<std::size_t>(points), asked.stores.picture);
  if (whole) return text_answer(*whole);
  return refuse(Refusal::large_answer,
                fmt::format("the answer would have more than {} bytes: ask for some series or fewer points, or for "
                            "/api/v1/captures/{}.csv",
                            kMaxJson, id));
}

}  // namespace axisgate::web
