// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/stream/feed.hpp"

#include <nlohmann/json.hpp>

#include "gateway/upstream/web_process/api/axis_json.hpp"

namespace axisgate::web {
namespace {

/// What is between the braces, without `at`: of an object that says nothing else that is new nothing is sent.
std::string without_at(nlohmann::ordered_json object) {
  object.erase("at");
  const std::string text = object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return text.substr(1, text.size() - 2);
}

}  // namespace

void Feed::update_whole(WholeObject& object, std::string text) const {
  if (object.text == text) return;
  object = {std::move(text), version_};
}

void Feed::update_axes(const Picture& picture, bool all, const Now& now) {
  for (const auto& [number, axis] : picture.axes()) {
    std::uint64_t& revision = revisions_[number];
    const auto made = axes_.find(number);
    if (made != axes_.end() && !all && revision == axis.revision) continue;
    revision = axis.revision;
    if (made != axes_.end())
      made->second.update(axis_now_json(picture, axis, now), version_);
    else
      axes_.emplace(number, MemberChanges({"values", "last", "limits"}))
          .first->second.update(axis_json(picture, axis, now), version_);
  }
}

void Feed::update(const Picture& picture, const Served& served, const Now& now) {
  ++version_;
  if (generation_ != picture.generation()) {
    generation_ = picture.generation();
    axes_.clear();
    revisions_.clear();
    buses_ = gateway_ = {};
  }
  const bool joined = picture.joined(now.at);
  const bool all = joined != joined_ || now.at - renewed_ >= kRenewed;
  joined_ = joined;
  update_axes(picture, all, now);
  if (!all && gateway_.version != 0) return;
  renewed_ = now.at;
  update_whole(buses_, without_at(buses_json(picture, now)));
  update_whole(gateway_, without_at(gateway_json(picture, served, now)));
}

}  // namespace axisgate::web
