// SPDX-License-Identifier: Apache-2.0
// One place in a JSON file: a value together with its pointer, for messages.
// Promises an answer for every question: what is absent or of another type gives the default, since the schema has
// already named the mistake and the reading goes on to find all others. Never changes the file's content.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/clock.hpp"
#include "gateway/core/rational.hpp"

namespace axisgate::profile {

class JsonNode {
 public:
  /// `json` must outlive the node and all that come from it.
  JsonNode(const nlohmann::json& json, std::string pointer) : json_(&json), pointer_(std::move(pointer)) {}

  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] std::string pointer(std::string_view key) const;
  /// The last step of the pointer: the key or position of this value.
  [[nodiscard]] std::string key() const;
  /// As JSON.
  [[nodiscard]] std::string dump() const;

  /// Whether the file has this place at all.
  explicit operator bool() const;
  [[nodiscard]] bool has(std::string_view key) const;
  [[nodiscard]] bool is_null() const;
  [[nodiscard]] bool is_object() const;
  [[nodiscard]] bool is_array() const;
  [[nodiscard]] bool is_string() const;
  /// What is not there is a place as well, with a pointer and without a value.
  [[nodiscard]] JsonNode operator[](std::string_view key) const;
  [[nodiscard]] JsonNode operator[](std::size_t index) const;
  /// What an array and an object hold; nothing of anything else.
  [[nodiscard]] std::vector<JsonNode> items() const;
  /// The same of an array alone, and of an object alone.
  [[nodiscard]] std::vector<JsonNode> elements() const;
  [[nodiscard]] std::vector<JsonNode> members() const;

  [[nodiscard]] std::optional<std::int64_t> integer() const;
  [[nodiscard]] std::optional<std::int64_t> integer(std::string_view key) const;
  /// 47, "47", "0x2F".
  [[nodiscard]] std::optional<std::int64_t> whole() const;
  [[nodiscard]] std::int64_t whole(std::string_view key, std::int64_t otherwise) const;
  /// Empty: it is no text.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] std::string text(std::string_view key) const;
  [[nodiscard]] std::optional<std::string> string(std::string_view key) const;
  /// One text, or those of an array.
  [[nodiscard]] std::vector<std::string> names(std::string_view key) const;
  /// The same of whole numbers.
  [[nodiscard]] std::vector<std::int64_t> wholes(std::string_view key) const;
  [[nodiscard]] bool flag(std::string_view key, bool otherwise) const;
  [[nodiscard]] Duration milliseconds(std::string_view key, Duration otherwise) const;
  /// A whole number, a decimal as it was written (27.5), a decimal string ("1.414"), or a fraction ("10000/60").
  [[nodiscard]] std::optional<Rational> rational() const;

 private:
  [[nodiscard]] std::vector<JsonNode> one_or_each() const;
  const nlohmann::json* json_;
  std::string pointer_;
};

/// "47", "-47", "0x2F"; none: it is no whole number.
[[nodiscard]] std::optional<std::int64_t> whole_number(std::string_view text);

}  // namespace axisgate::profile
