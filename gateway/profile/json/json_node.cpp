// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/json/json_node.hpp"

#include <charconv>
#include <nlohmann/json.hpp>

#include "gateway/profile/json/json_schema.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

/// What stands where nothing is written.
const json& absent() {
  static const json value(json::value_t::discarded);
  return value;
}

}  // namespace

std::string JsonNode::pointer(std::string_view key) const { return pointer_to(pointer_, key); }

std::string JsonNode::key() const { return json::json_pointer(pointer_).back(); }

std::string JsonNode::dump() const { return json_->dump(); }

JsonNode::operator bool() const { return !json_->is_discarded(); }

bool JsonNode::has(std::string_view key) const { return json_->is_object() && json_->contains(key); }

bool JsonNode::is_null() const { return json_->is_null(); }

bool JsonNode::is_object() const { return json_->is_object(); }

bool JsonNode::is_array() const { return json_->is_array(); }

bool JsonNode::is_string() const { return json_->is_string(); }

JsonNode JsonNode::operator[](std::string_view key) const {
  return {has(key) ? *json_->find(key) : absent(), pointer(key)};
}

JsonNode JsonNode::operator[](std::size_t index) const {
  const bool there = json_->is_array() && index < json_->size();
  return {there ? (*json_)[index] : absent(), pointer_to(pointer_, index)};
}

std::vector<JsonNode> JsonNode::items() const {
  std::vector<JsonNode> nodes;
  if (!json_->is_structured()) return nodes;
  for (const auto& [name, value] : json_->items()) nodes.emplace_back(value, pointer(name));
  return nodes;
}

std::vector<JsonNode> JsonNode::elements() const { return json_->is_array() ? items() : std::vector<JsonNode>{}; }

std::vector<JsonNode> JsonNode::members() const { return json_->is_object() ? items() : std::vector<JsonNode>{}; }

std::optional<std::int64_t> JsonNode::integer() const {
  // Beyond 64 bits is beyond every range of the schemas as well.
  if (!json_->is_number_integer() || (json_->is_number_unsigned() && json_->get<std::uint64_t>() > INT64_MAX))
    return std::nullopt;
  return json_->get<std::int64_t>();
}

std::optional<std::int64_t> JsonNode::integer(std::string_view key) const { return (*this)[key].integer(); }

std::optional<std::int64_t> JsonNode::whole() const { return is_string() ? whole_number(text()) : integer(); }

std::int64_t JsonNode::whole(std::string_view key, std::int64_t otherwise) const {
  return (*this)[key].whole().value_or(otherwise);
}

std::string JsonNode::text() const { return is_string() ? json_->get<std::string>() : std::string(); }

std::string JsonNode::text(std::string_view key) const { return (*this)[key].text(); }

std::optional<std::string> JsonNode::string(std::string_view key) const {
  const JsonNode node = (*this)[key];
  return node.is_string() ? std::optional(node.text()) : std::nullopt;
}

std::vector<JsonNode> JsonNode::one_or_each() const { return is_array() ? items() : std::vector<JsonNode>{*this}; }

std::vector<std::string> JsonNode::names(std::string_view key) const {
  std::vector<std::string> out;
  for (const JsonNode& name : (*this)[key].one_or_each())
    if (name.is_string()) out.push_back(name.text());
  return out;
}

std::vector<std::int64_t> JsonNode::wholes(std::string_view key) const {
  std::vector<std::int64_t> out;
  for (const JsonNode& entry : (*this)[key].one_or_each())
    if (const std::optional<std::int64_t> one = entry.whole()) out.push_back(*one);
  return out;
}

bool JsonNode::flag(std::string_view key, bool otherwise) const {
  const JsonNode node = (*this)[key];
  return node.json_->is_boolean() ? node.json_->get<bool>() : otherwise;
}

Duration JsonNode::milliseconds(std::string_view key, Duration otherwise) const {
  // The bound keeps a value that the schema has refused from overflowing nanoseconds.
  constexpr std::int64_t kLongest = 86'400'000;  // a day
  const auto value = integer(key);
  return value && *value >= 0 && *value <= kLongest ? std::chrono::milliseconds(*value) : otherwise;
}

std::optional<Rational> JsonNode::rational() const {
  if (const std::optional<std::int64_t> number = whole()) return Rational(*number);
  // dump() prints the shortest text that gives this number again: the digits that were written.
  return is_string() || json_->is_number() ? Rational::parse(is_string() ? text() : dump()) : std::nullopt;
}

std::optional<std::int64_t> whole_number(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const bool hex = text.starts_with("0x");
  if (hex) text.remove_prefix(2);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, hex ? 16 : 10);
  if (error != std::errc{} || end != text.data() + text.size() || value < 0) return std::nullopt;
  return negative ? -value : value;
}

}  // namespace axisgate::profile
