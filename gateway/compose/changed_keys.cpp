// SPDX-License-Identifier: Apache-2.0
#include "gateway/compose/changed_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

namespace axisgate::compose {
namespace {

using nlohmann::json;

/// As it stands in a JSON text: control characters are escaped.
std::string written(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

bool is_secret(std::string_view key) {
  constexpr std::string_view kWords[] = {"certificate", "private", "password", "secret", "token"};
  return std::ranges::any_of(kWords, [&](std::string_view word) { return key.find(word) != std::string_view::npos; });
}

void hide_secrets(json& value) {
  if (!value.is_structured()) return;
  for (const auto& [key, inner] : value.items()) {
    if (value.is_object() && is_secret(key))
      inner = "(not shown)";
    else
      hide_secrets(inner);
  }
}

std::string shown(const json* value) {
  if (value == nullptr) return "(not given)";
  json safe = *value;
  hide_secrets(safe);
  std::string text = written(safe);
  if (text.size() <= kLongestShownValue) return text;
  std::size_t cut = kLongestShownValue;
  const auto continues = [&](std::size_t at) { return (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U; };
  while (cut > 0 && continues(cut)) --cut;
  return text.substr(0, cut) + "...";
}

std::string key_text(const std::string& key) {
  const std::string quoted = written(key);
  return quoted.substr(1, quoted.size() - 2);
}

class Comparison {
 public:
  /// Null: it is not there.
  void compare(const std::string& at, const json* before, const json* after) {
    if (before != nullptr && after != nullptr) {
      if (*before == *after) return;
      if (before->is_object() && after->is_object()) return compare_objects(at, *before, *after);
      if (before->is_array() && after->is_array()) return compare_lists(at, *before, *after);
    }
    lines.push_back(is_secret(at.substr(at.rfind('/') + 1))
                        ? fmt::format("{} is another one (not shown)", at)
                        : fmt::format("{} {} -> {}", at.empty() ? "all" : at, shown(before), shown(after)));
  }
  std::vector<std::string> lines;

 private:
  static std::string under(const std::string& at, const std::string& key) { return at.empty() ? key : at + "/" + key; }

  void compare_objects(const std::string& at, const json& before, const json& after) {
    for (const auto& [key, value] : before.items()) {
      const auto now = after.find(key);
      compare(under(at, key_text(key)), &value, now == after.end() ? nullptr : &*now);
    }
    for (const auto& [key, value] : after.items())
      if (!before.contains(key)) compare(under(at, key_text(key)), nullptr, &value);
  }

  /// What is the same at both ends is left out, so that one that was put in or taken out is that one alone.
  void compare_lists(const std::string& at, const json& before, const json& after) {
    std::size_t first = 0;
    while (first < std::min(before.size(), after.size()) && before[first] == after[first]) ++first;
    std::size_t before_end = before.size();
    std::size_t after_end = after.size();
    while (before_end > first && after_end > first && before[before_end - 1] == after[after_end - 1]) {
      --before_end;
      --after_end;
    }
    for (std::size_t i = first; i < std::max(before_end, after_end); ++i)
      compare(under(at, std::to_string(i)), i < before_end ? &before[i] : nullptr, i < after_end ? &after[i] : nullptr);
  }
};

}  // namespace

std::vector<std::string> changed_keys(const json& before, const json& after) {
  Comparison comparison;
  comparison.compare("", &before, &after);
  return std::move(comparison.lines);
}

std::vector<std::string> bounded(std::vector<std::string> keys) {
  if (keys.size() <= kMostChangedKeys) return keys;
  const std::size_t more = keys.size() - kMostChangedKeys;
  keys.resize(kMostChangedKeys);
  keys.push_back(fmt::format("and {} more", more));
  return keys;
}

}  // namespace axisgate::compose
