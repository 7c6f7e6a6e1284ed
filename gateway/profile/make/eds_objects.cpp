// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/make/eds_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "gateway/model/object_def.hpp"
#include "gateway/profile/json/json_node.hpp"
#include "gateway/profile/make/take_out.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

std::string type_text(const EdsWidth& width) { return model::type_name(width.size, width.is_signed, width.is_real); }

bool is_real(const EdsObject& object) {
  const std::optional<EdsWidth> width = width_of(object.type);
  return width && width->is_real;
}

struct Numbers {
  std::int64_t least = 0, most = 0;
};

Numbers numbers_of(const EdsWidth& width) {
  const std::int64_t span = std::int64_t{1} << (8 * width.size);
  return width.is_signed ? Numbers{-span / 2, span / 2 - 1} : Numbers{0, span - 1};
}

/// Whether a command, a set-up or a stop writes it.
bool is_written(const json& node, const std::string& object) {
  if (!node.is_structured()) return false;
  if (node.is_object() && node.contains("write") && node["write"] == object) return true;
  return std::any_of(node.begin(), node.end(), [&](const json& part) { return is_written(part, object); });
}

/// Whether a condition or a wait reads it.
bool is_awaited(const json& node, const std::string& object) {
  if (!node.is_structured()) return false;
  if (node.is_object())
    for (const char* const key : {"wait", "require", "object"})
      if (node.contains(key) && node[key] == object) return true;
  return std::any_of(node.begin(), node.end(), [&](const json& part) { return is_awaited(part, object); });
}

/// Set-points, the mode and the homing method are nothing where nobody can write them.
bool is_commanded(const json& document, const std::string& object) {
  for (const auto& [quantity, entry] : document["quantities"].items()) {
    const bool commands = quantity.starts_with("target_") || quantity == "mode" || quantity == "controlword" ||
                          quantity == "homing_method";
    if (commands && entry.value("object", json()) == object) return true;
  }
  for (const char* const section : {"commands", "setup"})
    if (document.contains(section) && is_written(document[section], object)) return true;
  const json state = document.value("state", json::object());
  const json zeros = state.value("zero_before_enable", json::array());
  return std::ranges::find(zeros, json(object)) != zeros.end();
}

/// Brings one object to what the EDS says; false: the drive has none that can be used.
class Fitting {
 public:
  Fitting(json& document, std::string name, const EdsObject& known)
      : document_(document), name_(std::move(name)), known_(known) {}

  bool fit() {
    const bool real = known_.unclear.empty() && is_real(known_) && takes_real();
    if (!real && !why_not_usable(known_).empty()) return false;
    const EdsWidth width = *width_of(known_.type);
    const bool any_width = object().value("any_width", json(false)) == json(true);
    if (!any_width && object()["type"] != type_text(width)) object()["type"] = type_text(width);
    if (!fit_access()) return false;
    fit_range(width);
    return true;
  }

 private:
  json& object() { return document_["objects"][name_]; }

  /// It is an amount, and no position: what is a code, or compared, is a whole number.
  bool takes_real() {
    const json unit = document_.value("units", json::object()).value(object().value("unit", ""), json::object());
    return unit.contains("base") && unit["base"] != "rev";
  }

  bool fit_access() {
    const std::string access = object().value("access", "ro");
    const bool reads = access != "wo" && eds_reads(known_);
    const bool writes = access != "ro" && eds_writes(known_);
    if (access != "ro" && !writes && is_commanded(document_, name_)) return false;
    if (access != "wo" && !reads && !lose_reading()) return false;
    if (!reads && !writes) return false;
    const std::string now = !writes ? "ro" : !reads ? "wo" : "rw";
    if (now != access) object()["access"] = now;
    return true;
  }

  /// It is only written from now on; false: somebody waits for what it holds.
  bool lose_reading() {
    json others = document_;
    others.erase("objects");
    others.erase("quantities");
    if (is_awaited(others, name_)) return false;
    json& canopen = document_["protocols"]["canopen"];
    for (const char* const key : {"resynchronisation", "tpdo"}) {
      if (!canopen.contains(key)) continue;
      json only = {{"objects", json::object()}, {"protocols", {{"canopen", {{key, canopen[key]}}}}}};
      take_out_uses(only, name_);
      canopen[key] = only["protocols"]["canopen"].value(key, json::array());
    }
    return true;
  }

  /// The narrower of both; of codes the numbers themselves say what they are.
  void fit_range(const EdsWidth& width) {
    if (width.is_real) {
      object().erase("range");
      return;
    }
    const bool is_amount = object().contains("unit") && object().value("access", "ro") != "ro";
    if (!is_amount && !object().contains("range")) return;
    const Numbers all = numbers_of(width);
    Numbers own = all;
    if (object().contains("range")) {
      const JsonNode range(object()["range"], "");
      own = {std::max(own.least, range[0].whole().value_or(own.least)),
             std::min(own.most, range[1].whole().value_or(own.most))};
    }
    own = {std::max(own.least, known_.low.value_or(own.least)), std::min(own.most, known_.high.value_or(own.most))};
    const bool must_take_zero = is_commanded(document_, name_);
    const bool holds = own.least < own.most && (!must_take_zero || (own.least <= 0 && own.most >= 0));
    const bool all_of_it = own.least == all.least && own.most == all.most;
    if (!holds || all_of_it)
      object().erase("range");
    else if (!object().contains("range") || object()["range"] != json({own.least, own.most}))
      object()["range"] = {own.least, own.most};
  }

  json& document_;
  std::string name_;
  const EdsObject& known_;
};

std::optional<std::int64_t> from_hex(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// A record where one value should be: its sub-index 0 only counts the others.
bool is_several(const Eds& eds, ObjectAddress address) {
  return address.sub == 0 && eds.find({address.index, 1}) != nullptr;
}

}  // namespace

void fit_objects(const Eds& eds, json& wanted, std::vector<std::string>& notes) {
  std::vector<std::string> names;
  for (const auto& [name, object] : wanted["objects"].items()) names.push_back(name);
  for (const std::string& name : names) {
    const auto address = canopen_address(wanted["objects"][name]);
    if (!address) continue;
    const EdsObject* const known = eds.find(*address);
    const bool one = !is_several(eds, *address);
    if (one && known != nullptr && Fitting(wanted, name, *known).fit()) continue;
    take_out_object(wanted, name);
    notes.push_back(fmt::format("without {} ({}): {}", name, address_text(*address), why_missing(eds, *address)));
  }
}

std::optional<ObjectAddress> canopen_address(const json& object) {
  const json at = object.value("at", json::object()).value("canopen", json());
  const json place = at.is_object() ? at.value("address", json()) : at;
  if (!place.is_string()) return std::nullopt;
  const std::string text = place.get<std::string>();
  constexpr std::size_t kIndex = 4;
  if (text.size() < kIndex + 2 || text[kIndex] != '.') return std::nullopt;
  const auto index = from_hex(std::string_view(text).substr(0, kIndex));
  const auto sub = from_hex(std::string_view(text).substr(kIndex + 1));
  if (!index || !sub || *sub > 0xFF) return std::nullopt;
  return ObjectAddress{static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*sub)};
}

std::string why_not_usable(const EdsObject& object) {
  if (!object.unclear.empty()) return object.unclear;
  if (object.type == 0) return "has no DataType in the EDS";
  if (!width_of(object.type) || is_real(object)) return "is " + eds_type_name(object.type) + " in the EDS";
  return {};
}

std::string why_missing(const Eds& eds, ObjectAddress address) {
  const EdsObject* const object = eds.find(address);
  if (is_several(eds, address)) return "has sub-indexes in the EDS, perhaps one for each of several motors";
  if (object == nullptr) return "not in the EDS";
  const std::string why = why_not_usable(*object);
  return why.empty() ? "is " + object->access + " in the EDS" : why;
}

std::string address_text(ObjectAddress address) {
  return address.sub == 0 ? fmt::format("{:04X}h", address.index)
                          : fmt::format("{:04X}h:{:02X}", address.index, address.sub);
}

std::optional<int> eds_mode(std::string_view key) {
  constexpr std::int64_t kLast = 16;
  const auto mode = whole_number(key);
  return mode && *mode >= 1 && *mode <= kLast ? std::optional(static_cast<int>(*mode)) : std::nullopt;
}

bool eds_reads(const EdsObject& object) { return object.access != "wo"; }

bool eds_writes(const EdsObject& object) {
  return object.access.empty() || object.access.starts_with("rw") || object.access == "wo";
}

}  // namespace axisgate::profile
