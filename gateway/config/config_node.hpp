// SPDX-License-Identifier: Apache-2.0
// One place in a configuration file: a JSON value together with its pointer, for messages.
// Promises an answer for every question: a key that is absent or of another type gives the default, since the schema
// has already named the mistake and the reading goes on to find all others. Never changes the file's content.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/clock.hpp"
#include "gateway/core/rational.hpp"

namespace axisgate::config {

class ConfigNode {
 public:
  /// `json` must outlive the node.
  ConfigNode(const nlohmann::json& json, std::string pointer) : json_(&json), pointer_(std::move(pointer)) {}

  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] std::string pointer(std::string_view key) const;

  [[nodiscard]] bool has(std::string_view key) const;
  [[nodiscard]] bool is_null() const;
  [[nodiscard]] bool is_object() const;
  [[nodiscard]] std::optional<ConfigNode> child(std::string_view key) const;
  /// The elements of an array, or the values of an object; none of anything else.
  [[nodiscard]] std::vector<ConfigNode> items() const;
  [[nodiscard]] std::vector<ConfigNode> items(std::string_view key) const;
  /// The last step of the pointer: the key or position of this value.
  [[nodiscard]] std::string key() const;

  [[nodiscard]] std::optional<std::int64_t> integer() const;
  [[nodiscard]] std::optional<std::int64_t> integer(std::string_view key) const;
  [[nodiscard]] std::optional<std::string> string() const;
  [[nodiscard]] std::optional<std::string> string(std::string_view key) const;
  [[nodiscard]] bool flag(std::string_view key, bool otherwise) const;
  [[nodiscard]] Duration milliseconds(std::string_view key, Duration otherwise) const;
  /// A number or a decimal string, exactly as it is written.
  [[nodiscard]] std::optional<Rational> rational() const;

 private:
  const nlohmann::json* json_;
  std::string pointer_;
};

}  // namespace axisgate::config
