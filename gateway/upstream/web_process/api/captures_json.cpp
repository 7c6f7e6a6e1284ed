// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/captures_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gateway/upstream/web_process/api/events_json.hpp"
#include "gateway/upstream/web_process/http/response.hpp"

namespace axisgate::web {
namespace {

using Json = nlohmann::ordered_json;

std::string axis_name(const Capture& capture, std::uint16_t axis) {
  const AxisInfoRecord* info = capture.find(axis);
  return info == nullptr ? "" : info->name;
}

Json events_of(const Capture& capture, const Picture& picture) {
  const std::string boot = capture.id.substr(0, capture.id.find('.'));
  Json out = Json::array();
  for (const EventRecord& event : capture.events) {
    Json each = event_json(picture, event, day_of(capture));
    each["id"] = boot + "." + std::to_string(event.number);
    each["axis_name"] = axis_name(capture, event.axis);
    out.push_back(std::move(each));
  }
  return out;
}

std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

Now day_of(const Capture& capture) { return {capture.to, capture.to_utc}; }

Span span_of(const Capture& capture) { return {capture.from, std::max(capture.to, capture.from + kMillisecond)}; }

Json capture_json(const Capture& capture) {
  const Now day = day_of(capture);
  const CauseSeen& cause = capture.gravest();
  return {{"id", capture.id},
          {"cause", text(cause.cause)},
          {"axis", cause.axis},
          {"name", axis_name(capture, cause.axis)},
          {"at", utc_text(cause.at, day)},
          {"from", utc_text(capture.from, day)},
          {"to", utc_text(capture.to, day)},
          {"text", capture.text()},
          {"times", capture.times},
          {"samples", capture.samples()},
          {"complete", capture.complete}};
}

Json captures_json(const Recorder& recorder) {
  Json out;
  out["captures"] = Json::array();
  for (const Recorder::Kept& each : recorder.all()) out["captures"].push_back(capture_json(*each));
  return out;
}

std::optional<std::string> whole_capture_json(const Capture& capture, const std::vector<Series>& series,
                                              std::size_t points, const Picture& picture) {
  Json head = capture_json(capture);
  head["cut"] = capture.cut;
  head["axes"] = Json::array();
  for (const AxisInfoRecord& axis : capture.axes) head["axes"].push_back({{"axis", axis.axis}, {"name", axis.name}});
  const EachPoint each = [&](Series one, SteadyNs from, SteadyNs to, const Visit& visit) {
    capture.each(one, from, to, visit);
  };
  const auto lines = series_json(
      each, series, span_of(capture), points, [&](std::uint16_t axis) { return capture.find(axis); }, day_of(capture));
  if (!lines) return std::nullopt;
  std::string out = dumped(head);
  out.pop_back();
  out += ",\"series\":" + *lines + ",\"events\":" + dumped(events_of(capture, picture)) + "}";
  if (out.size() > kMaxJson) return std::nullopt;
  return out;
}

}  // namespace axisgate::web
