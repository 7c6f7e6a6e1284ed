// SPDX-License-Identifier: Apache-2.0
// Resolves shipped and test profiles in tests, with one axis and what it needs.
// Promises a model, or a failed test that shows every fault.
// Never reads a configuration.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "gateway/profile/resolve/profile_resolve.hpp"
#include "tests/places.hpp"
#include "tests/stage/profile_once.hpp"

namespace axisgate::profile {

inline std::string shipped(const std::string& name) { return test::source_path("schemas/drives/") + name + ".json"; }
inline std::string valid_file(const std::string& name) {
  return test::source_path("tests/profiles/valid/") + name + ".json";
}

inline std::string text(const std::vector<Fault>& faults) {
  std::string out;
  for (const Fault& fault : faults) out += text(fault) + "\n";
  return out;
}

inline ResolveInput one_axis(const std::string& protocol = "kinco-serial") {
  ResolveInput input;
  input.protocol = protocol;
  input.axes.emplace_back();
  input.axes[0].number = 7;
  input.axes[0].name = "lift";
  return input;
}

inline ResolveInput kinco_axis() {
  ResolveInput input = one_axis();
  input.constants["peak_current_a"] = Rational(275, 10);
  return input;
}

inline model::DriveModel resolved(const LoadedProfile& loaded, const ResolveInput& input) {
  EXPECT_EQ(text(loaded.faults), "");
  auto result = resolve(loaded, input);
  if (const auto* faults = std::get_if<std::vector<Fault>>(&result)) {
    ADD_FAILURE() << text(*faults);
    return {};
  }
  return std::get<model::DriveModel>(std::move(result));
}

/// Of a profile in the source folder.
inline model::DriveModel resolved(const std::string& path, const ResolveInput& input) {
  return resolved(test::profile_once(path), input);
}

inline std::vector<Fault> refused(const std::string& path, const ResolveInput& input) {
  auto result = resolve(test::profile_once(path), input);
  const auto* faults = std::get_if<std::vector<Fault>>(&result);
  EXPECT_NE(faults, nullptr) << "was resolved";
  return faults == nullptr ? std::vector<Fault>{} : *faults;
}

inline const model::Binding& binding(const model::DriveModel& model, Quantity quantity) {
  const model::Binding* found = model.axes.at(0).binding(quantity);
  if (found == nullptr) throw std::runtime_error("quantity not supported");
  return *found;
}

inline std::vector<std::string> names(const model::DriveModel& model, const std::vector<model::ObjectId>& ids) {
  std::vector<std::string> out;
  for (const model::ObjectId id : ids) out.push_back(model.object(id).name);
  return out;
}

/// The tables of a drive's manual.
inline nlohmann::json manual(const std::string& drive) {
  std::ifstream file(test::source_path("tests/vectors/") + drive + ".json");
  return nlohmann::json::parse(file);
}

inline std::int64_t hex(const nlohmann::json& text) { return std::stoll(text.get<std::string>(), nullptr, 16); }

/// Width, sign and access of an object are those of its row in the manual, where that gives them.
inline void check_row(const Object& object, const nlohmann::json& row) {
  if (row["bits"].is_number()) {
    EXPECT_EQ(object.size * 8, row["bits"].get<int>());
  }
  const std::string type = row["type"].is_string() ? row["type"].get<std::string>() : "";
  if (!type.ends_with('?') && (type.starts_with("int") || type.starts_with("uint"))) {
    EXPECT_EQ(object.is_signed, type.starts_with("int")) << type;
  }
  const std::string access = row["access"].is_string() ? row["access"].get<std::string>() : "";
  if (access.starts_with("RO") || (access.starts_with("R") && access.find('W') == std::string::npos)) {
    EXPECT_FALSE(object.writable) << access;
  } else if (access.starts_with("RW")) {
    EXPECT_TRUE(object.readable && object.writable) << access;
  }
}

inline std::string text(const model::DriveModel& model, const model::Condition& condition) {
  std::string out = model.object(condition.object).name;
  if (condition.mask != 0) out += "&" + std::to_string(condition.mask);
  out += condition.test == model::Condition::Test::equals ? "==" : "!=";
  for (const std::int64_t value : condition.values) out += std::to_string(value);
  return out;
}

/// "A.on=1, wait A.fault&1==0": a "?" where a wait may run out, "must" where it is a require.
inline std::string text(const model::DriveModel& model, const model::Steps& steps) {
  std::string out;
  for (const model::Step& step : steps) {
    out += out.empty() ? "" : ", ";
    const std::string until = step.verb == model::Step::Verb::write ? "" : text(model, step.until);
    if (step.verb == model::Step::Verb::wait)
      out += "wait " + until + (step.optional ? "?" : "");
    else if (step.verb == model::Step::Verb::require)
      out += "must " + until;
    else if (step.source == model::Step::Source::quantity)
      out += model.object(step.object).name + "=" + std::string(row(step.quantity).name);
    else
      out += model.object(step.object).name + "=" + std::to_string(step.literal);
  }
  return out;
}

/// What a write of this register value sends to the drive.
inline std::optional<std::int64_t> sent(const model::DriveModel& model, Quantity quantity, std::int64_t value) {
  const model::Binding& bound = binding(model, quantity);
  return bound.to_raw(value, model.object(bound.object));
}

}  // namespace axisgate::profile
