// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/stream/member_changes.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace axisgate::web {
namespace {

std::string dumped(const nlohmann::ordered_json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void append(std::string& out, const std::string& name, const std::string& value) {
  if (!out.empty()) out += ',';
  out += '"' + name + "\":" + value;
}

}  // namespace

void MemberChanges::note(Leaf& leaf, std::string text, Version version) {
  if (leaf.version != 0 && leaf.text == text) return;
  leaf = {std::move(text), version};
  changed_ = version;
}

MemberChanges::Member& MemberChanges::member(const std::string& name) {
  const auto found = std::ranges::find(members_, name, &Member::name);
  if (found != members_.end()) return *found;
  return members_.emplace_back(Member{name, std::ranges::find(nested_, name) != nested_.end()});
}

void MemberChanges::update_inside(Leaves& leaves, const nlohmann::ordered_json& object, Version version) {
  for (auto& [name, leaf] : leaves) {
    if (leaf.gone || object.contains(name)) continue;
    leaf = {"null", version, true};
    changed_ = version;
  }
  for (const auto& [name, value] : object.items()) {
    auto found = std::ranges::find(leaves, name, &Leaves::value_type::first);
    if (found == leaves.end()) found = leaves.emplace(leaves.end(), name, Leaf{});
    note(found->second, dumped(value), version);
  }
}

void MemberChanges::update(const nlohmann::ordered_json& object, Version version) {
  for (const auto& [name, value] : object.items()) {
    Member& into = member(name);
    if (into.nested)
      update_inside(into.inside, value, version);
    else
      note(into.leaf, dumped(value), version);
  }
}

std::string MemberChanges::since(Version since) const {
  std::string out;
  for (const Member& each : members_) {
    if (!each.nested) {
      if (each.leaf.version > since) append(out, each.name, each.leaf.text);
      continue;
    }
    std::string inside;
    for (const auto& [name, leaf] : each.inside)
      if (leaf.version > since && (since != 0 || !leaf.gone)) append(inside, name, leaf.text);
    if (since == 0 || !inside.empty()) append(out, each.name, "{" + inside + "}");
  }
  return out;
}

}  // namespace axisgate::web
