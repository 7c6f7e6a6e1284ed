// SPDX-License-Identifier: Apache-2.0
// What a person hears of two texts of a configuration that differ.
#include "gateway/compose/changed_keys.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace axisgate::compose {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::vector<std::string> changed(const char* before, const char* after) {
  return changed_keys(json::parse(before), json::parse(after));
}

TEST(ChangedKeys, EachIsNamedWithItsOldAndItsNewValue) {
  EXPECT_THAT(changed(R"({"drives": [{"node": 1, "axes": [{"limits": {"velocity": 3000000}}]}]})",
                      R"({"drives": [{"node": 1, "axes": [{"limits": {"velocity": 1500000}}]}]})"),
              ElementsAre("drives/0/axes/0/limits/velocity 3000000 -> 1500000"));
  EXPECT_THAT(changed(R"({"a": "x", "b": [1, 2]})", R"({"a": null, "b": [1, 3]})"),
              ElementsAre(R"(a "x" -> null)", "b/1 2 -> 3"));
}

TEST(ChangedKeys, WhatIsNotThereIsNotGiven) {
  EXPECT_THAT(changed(R"({"lease": {"timeout_ms": 9}})", R"({"name": "lift"})"),
              ElementsAre(R"(lease {"timeout_ms":9} -> (not given))", R"(name (not given) -> "lift")"));
}

TEST(ChangedKeys, AnEntryThatIsPutBeforeOthersChangesNoneOfThem) {
  EXPECT_THAT(changed(R"([{"node": 1}, {"node": 2}])", R"([{"node": 9}, {"node": 1}, {"node": 2}])"),
              ElementsAre(R"(0 (not given) -> {"node":9})"));
  EXPECT_THAT(changed("[1, 2, 3]", "[1, 3]"), ElementsAre("1 2 -> (not given)"));
  EXPECT_THAT(changed("[1, 1]", "[1]"), ElementsAre("1 1 -> (not given)")) << "each is counted once";
}

TEST(ChangedKeys, TheSameIsSilent) {
  EXPECT_THAT(changed(R"({"a": [1, {"b": 2}]})", R"({"a": [1, {"b": 2}]})"), IsEmpty());
}

TEST(ChangedKeys, ALongValueAndManyKeysAreCut) {
  const std::string umlauts = "\"" + std::string("x") + [] {
    std::string out;
    for (int i = 0; i < 40; ++i) out += "ä";
    return out;
  }() + "\"";
  const auto lines = changed_keys(json::parse("0"), json::parse(umlauts));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_THAT(lines[0], HasSubstr("ä..."));
  EXPECT_LE(lines[0].size(), kLongestShownValue + std::string("all 0 -> ...").size());

  json many = json::object();
  for (int i = 0; i < 23; ++i) many["k" + std::to_string(i)] = i;
  const auto shown = bounded(changed_keys(json::object(), many));
  EXPECT_EQ(shown.size(), kMostChangedKeys + 1);
  EXPECT_EQ(shown.back(), "and 3 more");
  EXPECT_EQ(bounded(std::vector<std::string>(kMostChangedKeys, "k")).size(), kMostChangedKeys);
}

TEST(ChangedKeys, WhatNamesACertificateOrASecretIsNotShown) {
  for (const char* key : {"certificate", "private_key", "password", "api_token"}) {
    const auto lines = changed_keys({{key, "old"}}, {{key, "new"}});
    EXPECT_THAT(lines, ElementsAre(std::string(key) + " is another one (not shown)"));
  }
  const auto whole = changed_keys({{"roles", json::array()}}, {{"roles", {{{"certificate", "mine.pem"}}}}});
  EXPECT_THAT(whole.front(), Not(HasSubstr("mine.pem"))) << "in what is new as a whole";
}

// Whoever made the text may have put anything into it.
TEST(ChangedKeys, ATerminalIsNotSpoiled) {
  const auto lines = changed_keys({{"a\x1B[2J", 1}}, {{"a\x1B[2J", "\x1B[31m\xFF"}});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].find('\x1B'), std::string::npos);
}

}  // namespace
}  // namespace axisgate::compose
