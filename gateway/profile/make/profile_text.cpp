// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/make/profile_text.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

namespace axisgate::profile {
namespace {

using nlohmann::json;

constexpr std::size_t kLineLength = 130;

/// Keys that are not listed come after them, by the alphabet.
constexpr std::array kOrder = std::to_array<std::string_view>({"profile",      "name",
                                                               "extends",      "base_only",
                                                               "title",        "source",
                                                               "tried",        "nvm",
                                                               "identity",     "vendor",
                                                               "product",      "revision",
                                                               "ask",          "of",
                                                               "axes",         "constants",
                                                               "units",        "base",
                                                               "mul",          "div",
                                                               "protocols",    "worst_reply_ms",
                                                               "word_order",   "max_registers",
                                                               "runs",         "resynchronisation",
                                                               "heartbeat_ms", "guard",
                                                               "by",           "loss",
                                                               "tpdo",         "n",
                                                               "map",          "inhibit_us",
                                                               "event_ms",     "unused_tpdos",
                                                               "each_axis",    "objects",
                                                               "type",         "access",
                                                               "at",           "unit",
                                                               "range",        "object",
                                                               "bits",         "poll",
                                                               "quantities",   "state",
                                                               "model",        "enabled",
                                                               "fault",        "moving",
                                                               "modes",        "homing",
                                                               "methods",      "commands",
                                                               "enable",       "disable",
                                                               "quick_stop",   "halt",
                                                               "fault_reset",  "move_absolute",
                                                               "write",        "wait",
                                                               "require",      "mask",
                                                               "equals",       "not_equals",
                                                               "first",        "if",
                                                               "value",        "ms",
                                                               "steps",        "setup",
                                                               "checks",       "alarms",
                                                               "words",        "codes",
                                                               "counts",       "text",
                                                               "where",        "before"});

std::size_t rank(std::string_view key) {
  return static_cast<std::size_t>(std::ranges::find(kOrder, key) - kOrder.begin());
}

std::vector<std::string> ordered_keys(const json& node) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : node.items()) keys.push_back(key);
  std::ranges::stable_sort(keys, {}, [](const std::string& key) { return rank(key); });
  return keys;
}

std::string quoted(const std::string& text) { return json(text).dump(); }

std::string on_one_line(const json& node) {
  std::string out;
  if (node.is_object()) {
    for (const std::string& key : ordered_keys(node))
      out += (out.empty() ? "" : ", ") + quoted(key) + ": " + on_one_line(node[key]);
    return "{" + out + "}";
  }
  if (!node.is_array()) return node.dump(-1, ' ', false, json::error_handler_t::replace);
  for (const json& entry : node) out += (out.empty() ? "" : ", ") + on_one_line(entry);
  return "[" + out + "]";
}

/// `taken`: characters that stand before it on its line.
std::string laid_out(const json& node, std::size_t indent, std::size_t taken) {
  const std::string line = on_one_line(node);
  const bool top = indent == 0;
  if (!top && (!node.is_structured() || taken + line.size() <= kLineLength)) return line;
  if (!node.is_structured()) return line;
  const std::string margin(indent + 2, ' ');
  std::string out;
  const auto add = [&](const std::string& key, const json& value) {
    const std::string begin = margin + key;
    out += (out.empty() ? "" : ",\n") + begin + laid_out(value, indent + 2, begin.size() + 1);
  };
  if (node.is_object())
    for (const std::string& key : ordered_keys(node)) add(quoted(key) + ": ", node[key]);
  else
    for (const json& entry : node) add("", entry);
  const auto [open, close] = node.is_object() ? std::pair{"{", "}"} : std::pair{"[", "]"};
  return std::string(open) + "\n" + out + "\n" + std::string(indent, ' ') + close;
}

bool is_utf8(std::string_view text) {
  try {
    static_cast<void>(json(std::string(text)).dump());
    return true;
  } catch (const json::exception&) {
    return false;
  }
}

}  // namespace

std::string profile_text(const json& document) { return laid_out(document, 0, 0) + "\n"; }

json difference(const json& base, const json& wanted) {
  json out = json::object();
  for (const auto& [key, value] : base.items())
    if (!wanted.contains(key)) out[key] = nullptr;
  for (const auto& [key, value] : wanted.items()) {
    const auto known = base.find(key);
    if (known == base.end()) {
      out[key] = value;
    } else if (*known != value) {
      const bool both = known->is_object() && value.is_object();
      out[key] = both ? difference(*known, value) : value;
    }
  }
  return out;
}

std::string plain_text(std::string_view text, std::size_t most) {
  constexpr unsigned kDelete = 0x7F, kLatin = 0x80;
  const bool utf8 = is_utf8(text);
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < ' ' || byte == kDelete) continue;
    if (byte < kLatin || utf8) {
      out += c;
    } else {
      out += static_cast<char>(0xC0U | static_cast<unsigned>(byte) >> 6U);
      out += static_cast<char>(kLatin | (byte & 0x3FU));
    }
  }
  out.erase(0, std::min(out.find_first_not_of(' '), out.size()));
  while (out.size() > most || out.ends_with(' ') || !is_utf8(out)) out.pop_back();
  return out;
}

std::string profile_name(std::string_view text) {
  constexpr std::size_t kLongest = 48;
  std::string out;
  for (const char c : text) {
    const bool large = c >= 'A' && c <= 'Z';
    const bool taken = large || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (taken)
      out += large ? static_cast<char>(c - 'A' + 'a') : c;
    else if (!out.empty() && out.back() != '-')
      out += '-';
  }
  out = out.substr(0, kLongest);
  while (out.ends_with('-')) out.pop_back();
  return out.empty() ? "drive" : out;
}

}  // namespace axisgate::profile
