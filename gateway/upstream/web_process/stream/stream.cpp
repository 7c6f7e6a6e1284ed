// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/stream/stream.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/upstream/web_process/api/captures_json.hpp"
#include "gateway/upstream/web_process/api/events_json.hpp"

namespace axisgate::web {
namespace {

std::string frame(std::string_view event, std::string_view data) {
  return fmt::format("event: {}\ndata: {}\n\n", event, data);
}

std::string dumped_frame(std::string_view event, const nlohmann::ordered_json& data) {
  return frame(event, data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

Stream::Stream(StreamRequest request, const Picture& picture, SteadyNs now)
    : request_(std::move(request)),
      event_(request_.after.value_or(picture.newest_event())),
      scope_(request_.series, now - period()),
      said_(now) {}

std::string Stream::bye(std::string_view why) { return dumped_frame("bye", {{"why", why}}); }

SteadyNs Stream::turn_after(SteadyNs now) const { return (now / kGrid + (period() + kGrid - 1) / kGrid) * kGrid; }

void Stream::begin(const Feed& feed, SteadyNs now) {
  generation_ = feed.generation();
  sent_.clear();
  reached_ = 0;
  first_ = true;
  axes_due_ = scope_due_ = whole_due_ = now;
  buses_ = gateway_ = 0;
}

std::string Stream::hello(const Picture& picture) {
  // A browser that has lost the stream comes back after so many ms.
  return "retry: 1000\n" + dumped_frame("hello", {{"boot", std::to_string(picture.hello().boot)},
                                                  {"version", picture.hello().version},
                                                  {"period_ms", request_.period_ms}});
}

std::string Stream::events(const Picture& picture, const Now& now) {
  if (picture.newest_event() < event_) event_ = 0;  // another gateway counts from 1
  std::string out;
  for (const EventRecord& event : picture.events()) {
    if (event.number <= event_) continue;
    if (out.size() > kFrame) break;
    out += fmt::format("id: {}\n", event_id(picture, event.number)) +
           dumped_frame("event", event_json(picture, event, now));
    event_ = event.number;
  }
  return out;
}

/// Those that begin and that are complete from now on.
std::string Stream::captures(const Recorder& recorder) {
  const std::uint64_t sent = capture_.value_or(recorder.newest_change());
  capture_ = recorder.newest_change();
  std::string out;
  for (const Recorder::Change& change : recorder.changes()) {
    if (change.number <= sent) continue;
    nlohmann::ordered_json capture = capture_json(*change.capture);
    capture["complete"] = change.complete;
    out += dumped_frame("capture", capture);
  }
  return out;
}

std::string Stream::axes(const Feed& feed, const Now& now) {
  std::string changed;
  for (auto axis = feed.axes().upper_bound(reached_); axis != feed.axes().end(); ++axis) {
    const auto& [number, members] = *axis;
    reached_ = number;
    if (request_.axes && !request_.axes->contains(number)) continue;
    Version& sent = sent_[number];
    if (members.changed() <= sent) continue;
    const std::string now_changed = members.since(sent);
    // The first is whole, its number with it.
    const std::string number_text = sent == 0 ? std::string() : fmt::format("\"axis\":{},", number);
    changed += fmt::format("{}{{{}{}}}", changed.empty() ? "" : ",", number_text, now_changed);
    sent = feed.version();
    if (changed.size() > kFrame) break;
  }
  if (reached_ == 0 || feed.axes().upper_bound(reached_) == feed.axes().end()) {
    reached_ = 0;
    axes_due_ = turn_after(now.at);
  }
  if (changed.empty() && !first_ && was_joined_ == feed.joined()) return {};
  first_ = false;
  was_joined_ = feed.joined();
  return frame("axes",
               fmt::format(R"({{"at":"{}","joined":{},"axes":[{}]}})", utc_text(now.at, now), feed.joined(), changed));
}

std::string Stream::whole(std::string_view event, const WholeObject& object, Version& sent, const Now& now) {
  if (object.version <= sent) return {};
  sent = object.version;
  return frame(event, fmt::format(R"({{"at":"{}",{}}})", utc_text(now.at, now), object.text));
}

std::string Stream::scope(const Stores& stores, const Now& now) {
  scope_due_ = turn_after(now.at);
  const std::string data = scope_.next(stores, now);
  return data.empty() ? data : frame("scope", data);
}

std::string Stream::next(const Stores& stores, const Feed& feed, const Now& now) {
  const Picture& picture = stores.picture;
  std::string out;
  if (picture.complete() && feed.generation() == picture.generation()) {
    if (generation_ != feed.generation()) {
      begin(feed, now.at);
      out = hello(picture);
    }
    out += events(picture, now) + captures(stores.recorder);
    if (now.at >= axes_due_) out += axes(feed, now);
    if (now.at >= scope_due_) out += scope(stores, now);
    if (now.at >= whole_due_) {
      whole_due_ = now.at + kSecond;
      out += whole("buses", feed.buses(), buses_, now) + whole("gateway", feed.gateway(), gateway_, now);
    }
  }
  if (out.empty() && now.at - said_ >= kSaysSomethingEach) out = ":\n\n";
  if (!out.empty()) said_ = now.at;
  return out;
}

}  // namespace axisgate::web
