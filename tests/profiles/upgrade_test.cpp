// SPDX-License-Identifier: Apache-2.0
// A profile of an earlier axisgate: what has another name gets it, and nothing else is touched.
#include "gateway/profile/make/upgrade.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "gateway/profile/json/json_schema.hpp"
#include "tests/profiles/mistakes.hpp"
#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(ProfileUpgrade, NothingOfAShippedProfileIsTouched) {
  for (const char* const name :
       {"cia402", "id286pro", "kinco-jd", "kinco-md", "keya-kydas4860-2e", "leadshine-ld2-can"}) {
    const json document = std::get<json>(parse_json(test::content(shipped(name))));
    EXPECT_THAT(upgraded(document).changes, IsEmpty()) << name;
    EXPECT_EQ(std::get<json>(parse_json(upgraded(document).text)), document);
  }
}

TEST(ProfileUpgrade, OldNamesBecomeNewOnes) {
  const json old = json::parse(R"({
    "name": "mine", "extends": "cia402",
    "protocols": {"canopen": {"fence": ["error_code", "mode"], "worst_reply_ms": 500}},
    "quantities": {"mode": {"object": "operation"}},
    "commands": {
      "set_position": {"steps": [{"write": "operation", "value": 6}, {"write": "controlword", "value": 15}]},
      "enable": {"steps": [{"write": "operation", "value": 1}]}
    },
    "modes": {"-3": -3}})");
  const Upgraded out = upgraded(old);
  EXPECT_EQ(out.name, "mine");
  EXPECT_THAT(out.changes,
              ElementsAre("/protocols/canopen/fence: is called resynchronisation",
                          "/commands/set_position/steps/0: is left out: the gateway chooses homing mode and "
                          "goes back by itself",
                          "/state/velocity_modes: mode -3 follows a velocity at once: is that so of this drive?"));
  json wanted = old;
  wanted["protocols"]["canopen"] =
      json::parse(R"({"resynchronisation": ["error_code", "mode"], "worst_reply_ms": 500})");
  wanted["commands"]["set_position"]["steps"].erase(0);
  wanted["state"]["velocity_modes"] = {-3};
  EXPECT_EQ(std::get<json>(parse_json(out.text)), wanted);
  EXPECT_THAT(upgraded(wanted).changes, IsEmpty()) << "what is carried over stays";
}

TEST(ProfileUpgrade, WhatIsNoProfileIsSaidToBeNone) {
  EXPECT_EQ(upgraded(json::array()).fault, "is no profile: it has no name");
  EXPECT_EQ(upgraded(json::parse(R"({"name": 5})")).fault, "is no profile: it has no name");
}

}  // namespace
}  // namespace axisgate::profile
