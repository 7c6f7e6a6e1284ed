// Resolves shipped and test profiles in tests, with one axis and what it needs.
// Promises a model, or a failed test that shows every fault.
// Never reads a configuration.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "gateway/drive/profile_loader.hpp"
#include "tests/stage/profile_once.hpp"

namespace axisgate::drive {

inline std::string shipped(const std::string& name) { return AXISGATE_SOURCE_DIR "/schemas/drives/" + name + ".json"; }
inline std::string valid_file(const std::string& name) {
  return AXISGATE_SOURCE_DIR "/tests/profiles/valid/" + name + ".json";
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

inline DriveModel resolved(const LoadedProfile& loaded, const ResolveInput& input) {
  EXPECT_EQ(text(loaded.faults), "");
  auto result = resolve(loaded, input);
  if (const auto* faults = std::get_if<std::vector<Fault>>(&result)) {
    ADD_FAILURE() << text(*faults);
    return {};
  }
  return std::get<DriveModel>(std::move(result));
}

/// Of a profile in the source folder.
inline DriveModel resolved(const std::string& path, const ResolveInput& input) {
  return resolved(test::profile_once(path), input);
}

inline std::vector<Fault> refused(const std::string& path, const ResolveInput& input) {
  auto result = resolve(test::profile_once(path), input);
  const auto* faults = std::get_if<std::vector<Fault>>(&result);
  EXPECT_NE(faults, nullptr) << "was resolved";
  return faults == nullptr ? std::vector<Fault>{} : *faults;
}

inline const Binding& binding(const DriveModel& model, Quantity quantity) {
  const Binding* found = model.axes.at(0).binding(quantity);
  if (found == nullptr) throw std::runtime_error("quantity not supported");
  return *found;
}

/// What a write of this register value sends to the drive.
inline std::optional<std::int64_t> sent(const DriveModel& model, Quantity quantity, std::int64_t value) {
  const Binding& bound = binding(model, quantity);
  return bound.to_raw(value, model.object(bound.object));
}

}  // namespace axisgate::drive
