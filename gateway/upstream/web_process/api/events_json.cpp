// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/events_json.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "gateway/core/words.hpp"
#include "gateway/upstream/web_process/api/fault_json.hpp"
#include "gateway/upstream/web_process/http/query.hpp"

namespace axisgate::web {
namespace {

constexpr std::uint64_t kAnyNumber = std::numeric_limits<std::uint64_t>::max();

struct Advice {
  std::string cause;
  std::string remedy;
};

/// `code` is of another table for each kind.
Advice advice_for(const Picture& picture, const EventRecord& event) {
  const auto kind = static_cast<EventKind>(event.kind);
  const AxisPicture* axis = picture.find(event.axis);
  if (kind == EventKind::fault && event.code != 0) {
    const FaultText fault = fault_text(picture, axis == nullptr ? std::string() : axis->info.profile, event.code);
    return {fault.cause.empty() ? fault.text : fault.cause, fault.remedy};
  }
  if (kind != EventKind::link || axis == nullptr) return {};
  const Word* word = find_word(WordKind::link_state, event.code);
  if (word == nullptr) return {};
  return {std::string(word->causes), std::string(word->remedy)};
}

}  // namespace

std::optional<EventKind> event_kind_named(std::string_view name) {
  for (std::size_t i = 0; i < kEventKinds; ++i)
    if (text(static_cast<EventKind>(i)) == name) return static_cast<EventKind>(i);
  return std::nullopt;
}

std::optional<std::uint64_t> event_number(std::string_view id, const Picture& picture) {
  const std::size_t point = id.find('.');
  if (point == std::string_view::npos) return whole_number(id, 0, kAnyNumber);
  const auto boot = whole_number(id.substr(0, point), 0, kAnyNumber);
  const auto number = whole_number(id.substr(point + 1), 0, kAnyNumber);
  if (!boot || !number) return std::nullopt;
  return *boot == picture.hello().boot ? *number : 0;
}

std::string event_id(const Picture& picture, std::uint64_t number) {
  return std::to_string(picture.hello().boot) + "." + std::to_string(number);
}

nlohmann::ordered_json event_json(const Picture& picture, const EventRecord& event, const Now& now) {
  const AxisPicture* axis = picture.find(event.axis);
  const Advice advice = advice_for(picture, event);
  nlohmann::ordered_json out;
  out["id"] = event_id(picture, event.number);
  out["number"] = event.number;
  out["at"] = utc_text(event.at, now);
  out["axis"] = event.axis == 0 ? nlohmann::ordered_json() : nlohmann::ordered_json(event.axis);
  out["axis_name"] = axis == nullptr ? "" : axis->info.name;
  out["kind"] = text(static_cast<EventKind>(std::min<std::size_t>(event.kind, kEventKinds - 1)));
  out["code"] = event.code;
  out["text"] = event.text;
  out["cause"] = advice.cause;
  out["remedy"] = advice.remedy;
  return out;
}

nlohmann::ordered_json events_json(const Picture& picture, const EventFilter& filter, const Now& now) {
  std::vector<const EventRecord*> chosen;
  for (auto event = picture.events().rbegin(); event != picture.events().rend(); ++event) {
    if (event->number <= filter.after || chosen.size() >= filter.limit) break;
    const bool of_axis = !filter.axis || *filter.axis == event->axis;
    const bool of_kind = !filter.kind || static_cast<std::uint8_t>(*filter.kind) == event->kind;
    if (of_axis && of_kind) chosen.push_back(&*event);
  }
  nlohmann::ordered_json out;
  out["events"] = nlohmann::ordered_json::array();
  for (auto event = chosen.rbegin(); event != chosen.rend(); ++event)
    out["events"].push_back(event_json(picture, **event, now));
  return out;
}

}  // namespace axisgate::web
