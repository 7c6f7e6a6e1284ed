// SPDX-License-Identifier: Apache-2.0
#include "gateway/config/config_node.hpp"

#include <nlohmann/json.hpp>

#include "gateway/profile/json/json_schema.hpp"

namespace axisgate::config {
std::string ConfigNode::pointer(std::string_view key) const { return profile::pointer_to(pointer_, key); }

bool ConfigNode::has(std::string_view key) const { return json_->is_object() && json_->contains(key); }

bool ConfigNode::is_null() const { return json_->is_null(); }

bool ConfigNode::is_object() const { return json_->is_object(); }

std::optional<ConfigNode> ConfigNode::child(std::string_view key) const {
  if (!has(key)) return std::nullopt;
  return ConfigNode((*json_)[std::string(key)], pointer(key));
}

std::vector<ConfigNode> ConfigNode::items() const {
  std::vector<ConfigNode> nodes;
  if (!json_->is_structured()) return nodes;
  for (const auto& [name, value] : json_->items()) nodes.emplace_back(value, pointer(name));
  return nodes;
}

std::vector<ConfigNode> ConfigNode::items(std::string_view key) const {
  const auto node = child(key);
  return node ? node->items() : std::vector<ConfigNode>{};
}

std::string ConfigNode::key() const { return pointer_.substr(pointer_.rfind('/') + 1); }

std::optional<std::int64_t> ConfigNode::integer() const {
  // Beyond 64 bits is beyond every range of the schema as well.
  if (!json_->is_number_integer() || (json_->is_number_unsigned() && json_->get<std::uint64_t>() > INT64_MAX)) {
    return std::nullopt;
  }
  return json_->get<std::int64_t>();
}

std::optional<std::int64_t> ConfigNode::integer(std::string_view key) const {
  const auto node = child(key);
  return node ? node->integer() : std::nullopt;
}

std::optional<std::string> ConfigNode::string() const {
  if (!json_->is_string()) return std::nullopt;
  return json_->get<std::string>();
}

std::optional<std::string> ConfigNode::string(std::string_view key) const {
  const auto node = child(key);
  return node ? node->string() : std::nullopt;
}

bool ConfigNode::flag(std::string_view key, bool otherwise) const {
  const auto node = child(key);
  return node && node->json_->is_boolean() ? node->json_->get<bool>() : otherwise;
}

Duration ConfigNode::milliseconds(std::string_view key, Duration otherwise) const {
  // The bound keeps a value that the schema has refused from overflowing nanoseconds.
  constexpr std::int64_t kLongest = 86'400'000;  // a day
  const auto value = integer(key);
  return value && *value >= 0 && *value <= kLongest ? std::chrono::milliseconds(*value) : otherwise;
}

std::optional<Rational> ConfigNode::rational() const { return profile::rational_of(*json_); }

}  // namespace axisgate::config
