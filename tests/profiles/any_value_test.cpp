// SPDX-License-Identifier: Apache-2.0
// Whatever stands in a profile, reading it ends in faults or in a profile: never in an exception or a crash.
#include "tests/places.hpp"
#include "tests/profiles/mistakes.hpp"
#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

/// Every place of the document, the root first.
void places(const json& node, const json::json_pointer& here, std::vector<json::json_pointer>& out) {
  out.push_back(here);
  if (node.is_object())
    for (const auto& [key, value] : node.items()) places(value, here / key, out);
  if (node.is_array())
    for (std::size_t i = 0; i < node.size(); ++i) places(node[i], here / i, out);
}

void read_with(json document, const json::json_pointer& place, const json& value, const std::string& file,
               const std::string& protocol) {
  document[place] = value;
  std::ofstream(file) << document;
  const LoadedProfile loaded = load_profile(file, {test::source_path("tests/profiles/valid")});
  if (loaded.faults.empty()) {
    static_cast<void>(resolve(loaded, one_axis(protocol)));
    return;
  }
  for (const Fault& fault : loaded.faults) EXPECT_FALSE(fault.message.empty());
}

void expect_no_throw(const std::string& profile, const std::string& protocol, const std::vector<json>& values,
                     std::size_t least = 150) {
  const json document = json::parse(test::content(valid_file(profile)));
  std::vector<json::json_pointer> all;
  places(document, json::json_pointer(), all);
  EXPECT_GE(all.size(), least);
  const test::OwnFolder folder;
  const std::string file = folder.path() / (profile + ".json");
  for (const json::json_pointer& place : all)
    for (const json& value : values)
      ASSERT_NO_THROW(read_with(document, place, value, file, protocol)) << place << " = " << value;
}

TEST(AnyValue, AtAnyPlaceOfAProfileNeverThrows) {
  expect_no_throw("minimal", "kinco-serial",
                  {nullptr, -1, "0x1FFFFFFFF", "A.x", json::array({1}), json::object({{"object", 7}})});
}

TEST(AnyValue, AtAnyPlaceOfAVirtualDrivesProfileNeverThrows) {
  expect_no_throw("virtual", "modbus-rtu", {-1, "lines", json::array({"x"})});
}

TEST(AnyValue, AtAnyPlaceOfAProfileThatExtendsAnotherNeverThrows) {
  const std::vector<json> values{nullptr, -1, "$axis", json::array({"x"}), json::object({{"A", 7}})};
  expect_no_throw("derived", "kinco-serial", values, 50);
  expect_no_throw("each-axis", "modbus-rtu", values, 20);
}

}  // namespace
}  // namespace axisgate::profile
