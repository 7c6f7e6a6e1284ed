// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/router.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <nlohmann/json.hpp>

#include "gateway/upstream/web_process/api/asked.hpp"
#include "gateway/upstream/web_process/api/axis_json.hpp"
#include "gateway/upstream/web_process/api/capture_answers.hpp"
#include "gateway/upstream/web_process/api/events_json.hpp"
#include "gateway/upstream/web_process/api/history_answers.hpp"
#include "gateway/upstream/web_process/api/map_json.hpp"
#include "gateway/upstream/web_process/api/openapi_text.hpp"
#include "gateway/upstream/web_process/api/words_json.hpp"
#include "gateway/upstream/web_process/files/files.hpp"
#include "gateway/upstream/web_process/metrics/metrics.hpp"

namespace axisgate::web {
namespace {

Answer in_json(const nlohmann::ordered_json& json, unsigned status = 200) {
  return text_answer(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), status);
}

/// Throws where one is no axis of this gateway.
std::optional<std::set<std::uint64_t>> axes_asked(Query& query, const Picture& picture) {
  auto out = query.numbers("axes", 1, kMaxAxisNumber);
  for (const std::uint64_t axis : out.value_or(std::set<std::uint64_t>{}))
    if (picture.find(static_cast<std::uint16_t>(axis)) == nullptr)
      throw ParameterFault{fmt::format("axes: there is no axis {}; there are: {}", axis, axes_text(picture))};
  return out;
}

/// None: all of them. Throws where it is no axis of this gateway.
std::optional<std::uint16_t> axis_asked(Query& query, const Picture& picture, std::uint16_t least) {
  const auto number = query.number("axis", least, kMaxAxisNumber);
  if (!number) return std::nullopt;
  const auto axis = static_cast<std::uint16_t>(*number);
  if (axis != 0 && picture.find(axis) == nullptr)
    throw ParameterFault{fmt::format("axis: there is no axis {}; there are: {}", axis, axes_text(picture))};
  return axis;
}

Answer gateway(const Asked& asked, Query& query) {
  query.end();
  return in_json(gateway_json(asked.stores.picture, asked.served, asked.now));
}

Answer buses(const Asked& asked, Query& query) {
  query.end();
  return in_json(buses_json(asked.stores.picture, asked.now));
}

Answer bus(const Asked& asked, Query& query) {
  query.end();
  const BusPicture* found = bus_named(asked.stores.picture, asked.name);
  if (found == nullptr) return refuse(Refusal::not_found, "no bus is called so; /api/v1/buses lists them");
  return in_json(bus_json(asked.stores.picture, *found, asked.now.at));
}

Answer axes(const Asked& asked, Query& query) {
  const auto wanted = axes_asked(query, asked.stores.picture);
  query.end();
  std::string out = fmt::format(R"({{"at":"{}","joined":{},"axes":[)", utc_text(asked.now.at, asked.now),
                                asked.stores.picture.joined(asked.now.at));
  for (const auto& [number, axis] : asked.stores.picture.axes()) {
    if (wanted && !wanted->contains(number)) continue;
    out += out.back() == '[' ? "" : ",";
    out +=
        axis_json(asked.stores.picture, axis, asked.now).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    if (out.size() > kMaxJson)
      return refuse(Refusal::large_answer,
                    fmt::format("the answer would have more than {} bytes: name fewer with axes=1,2,3", kMaxJson));
  }
  return text_answer(out + "]}");
}

Answer axis(const Asked& asked, Query& query) {
  query.end();
  const auto number = whole_number(asked.name, 1, kMaxAxisNumber);
  const AxisPicture* found = number ? asked.stores.picture.find(static_cast<std::uint16_t>(*number)) : nullptr;
  if (found == nullptr) return refuse(Refusal::not_found, "there is no such axis; /api/v1/axes lists them");
  return in_json(axis_json(asked.stores.picture, *found, asked.now));
}

EventKind kind_asked(const std::string& name) {
  if (const auto kind = event_kind_named(name)) return *kind;
  std::vector<std::string_view> kinds;
  for (std::size_t i = 0; i < kEventKinds; ++i) kinds.push_back(text(static_cast<EventKind>(i)));
  throw ParameterFault{fmt::format("kind: '{}' is none; there are: {}", name, fmt::join(kinds, ", "))};
}

Answer events(const Asked& asked, Query& query) {
  EventFilter filter;
  if (const auto after = query.text("after")) {
    const auto number = event_number(*after, asked.stores.picture);
    if (!number) throw ParameterFault{"after: it is an event's number or id: 17 or 42.17"};
    filter.after = *number;
  }
  filter.limit = static_cast<std::size_t>(query.number("limit", 1, kMostEvents).value_or(filter.limit));
  filter.axis = axis_asked(query, asked.stores.picture, 0);
  if (const auto kind = query.text("kind")) filter.kind = kind_asked(*kind);
  query.end();
  return in_json(events_json(asked.stores.picture, filter, asked.now));
}

Answer all_words(const Asked&, Query& query) {
  query.end();
  return in_json(words_json());
}

Answer explain(const Asked& asked, Query& query) {
  constexpr std::size_t kLongest = 100;
  const auto typed = query.text("q");
  query.end();
  if (!typed || typed->empty() || typed->size() > kLongest)
    throw ParameterFault{fmt::format("q: a word or number of 1 to {} bytes: stop_latched, result 9, 0x3130", kLongest)};
  return in_json(explain_json(*typed, asked.stores.picture));
}

Answer map(const Asked& asked, Query& query) {
  const auto of_axis = axis_asked(query, asked.stores.picture, 1);
  const std::string format = query.text("format").value_or("json");
  query.end();
  if (format == "csv") {
    Answer out{json_response(map_csv(asked.stores.picture, of_axis))};
    std::get<Response>(out.what).type = "text/csv; charset=utf-8";
    return out;
  }
  if (format != "json") throw ParameterFault{fmt::format("format: '{}' is none; there are: json, csv", format)};
  return text_answer(map_json(asked.stores.picture, of_axis));
}

Answer health(const Asked& asked, Query& query) {
  query.end();
  constexpr unsigned kGood = 200, kNotThere = 503;
  const bool joined = asked.stores.picture.joined(asked.now.at), alive = asked.stores.picture.alive(asked.now.at);
  return text_answer(fmt::format(R"({{"joined":{},"alive":{}}})", joined, alive), joined && alive ? kGood : kNotThere);
}

/// What a scraper asks for beside its job is refused as anywhere.
Answer metrics(const Asked& asked, Query& query) {
  query.end();
  std::string text = metrics_text(asked.stores.picture, asked.served, asked.now.at);
  if (text.size() > kMaxMetrics) return refuse(Refusal::large_answer);
  Answer out{json_response(std::move(text))};
  std::get<Response>(out.what).type = kMetricsType;
  return out;
}

Answer openapi(const Asked&, Query& query) {
  query.end();
  return {Response{.type = kJson, .fixed = openapi_text()}};
}

Answer stream(const Asked& asked, Query& query) {
  StreamRequest out;
  out.period_ms = query.number("period_ms", kLeastPeriodMs, kMostPeriodMs).value_or(out.period_ms);
  out.axes = axes_asked(query, asked.stores.picture);
  out.series = series_asked(query, asked.stores.picture);
  query.end();
  if (!asked.request.last_event_id.empty()) out.after = event_number(asked.request.last_event_id, asked.stores.picture);
  return {out};
}

struct Route {
  std::string_view path;  ///< one that ends with '/' has a name behind it
  Answer (*answer)(const Asked&, Query&);
};

constexpr std::array kRoutes{
    Route{"/api/v1/gateway", gateway},
    Route{"/api/v1/buses", buses},
    Route{"/api/v1/buses/", bus},
    Route{"/api/v1/axes", axes},
    Route{"/api/v1/axes/", axis},
    Route{"/api/v1/events", events},
    Route{"/api/v1/words", all_words},
    Route{"/api/v1/explain", explain},
    Route{"/api/v1/map", map},
    Route{"/api/v1/health", health},
    Route{"/api/v1/stream", stream},
    Route{"/api/v1/openapi.json", openapi},
    Route{"/api/v1/history", history_answer},
    Route{"/api/v1/history.csv", history_csv_answer},
    Route{"/api/v1/captures", captures_answer},
    Route{"/api/v1/captures/", capture_answer},
    Route{"/metrics", metrics},
};

const Route* route_of(std::string_view path) {
  for (const Route& route : kRoutes)
    if (route.path.ends_with('/') ? path.starts_with(route.path) && path != route.path : path == route.path)
      return &route;
  return nullptr;
}

Answer file_answer(const File& file, const Request& request) {
  constexpr unsigned kNotModified = 304;
  Response out;
  out.cache = "no-cache";
  out.fields = fmt::format("ETag: {}\r\nVary: Accept-Encoding\r\n", file.etag);
  if (request.if_none_match == "*" || request.if_none_match.find(file.etag) != std::string::npos) {
    out.status = kNotModified;
    return {std::move(out)};
  }
  out.type = file.type;
  const bool gzip = request.takes_gzip && !file.gzip.empty();
  out.fixed = gzip ? file.gzip : file.plain;
  if (gzip) out.fields += "Content-Encoding: gzip\r\n";
  return {std::move(out)};
}

}  // namespace

Answer answer(const Request& request, const Stores& stores, const Served& served, const Now& now) {
  const std::string_view target(request.target);
  const std::size_t mark = target.find('?');
  const auto path = percent_decoded(target.substr(0, mark), false);
  if (!path) return refuse(Refusal::not_found);
  try {
    Query query(mark == std::string_view::npos ? std::string_view() : target.substr(mark + 1));
    if (const Route* route = route_of(*path)) {
      Asked asked{request, stores, served, now};
      if (route->path.ends_with('/')) asked.name = path->substr(route->path.size());
      return route->answer(asked, query);
    }
    const File* file = find_file(*path);
    if (file == nullptr) return refuse(Refusal::not_found);
    return file_answer(*file, request);
  } catch (const ParameterFault& fault) {
    return refuse(Refusal::parameter, fault.text);
  }
}

}  // namespace axisgate::web
