// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/json/json_schema.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "gateway/profile/json/json_node.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

JsonSchema schema() {
  return JsonSchema(R"({
    "type": "object", "additionalProperties": false, "required": ["name"],
    "definitions": {"entry": {"type": "object", "required": ["size"], "additionalProperties": false,
                              "properties": {"size": {"type": "integer", "minimum": 1, "maximum": 4}}}},
    "properties": {
      "name": {"type": "string", "pattern": "^[a-z]+$", "expects": "a name of small letters"},
      "class": {"enum": ["fast", "slow"]},
      "entries": {"type": "array", "maxItems": 2, "items": {"$ref": "#/definitions/entry"}},
      "a/b": {"type": "boolean"}
    }})");
}

std::vector<SchemaFault> faults(const char* document) { return schema().faults_in(json::parse(document)); }

TEST(JsonSchema, ADocumentThatFitsHasNoFaults) {
  EXPECT_THAT(faults(R"({"name": "x", "class": "fast", "entries": [{"size": 4}], "a/b": true})"), IsEmpty());
}

TEST(JsonSchema, EveryFaultIsToldOnceWithoutItsParents) {
  EXPECT_THAT(faults(R"({"name": "X1", "class": "fats", "entries": [{"size": 5}, {"size": "1"}], "a/b": 0})"),
              testing::UnorderedElementsAre(
                  SchemaFault{"/name", "\"X1\" is not a name of small letters"},
                  SchemaFault{"/class", "\"fats\" is none of: fast, slow; did you mean \"fast\"?"},
                  SchemaFault{"/entries/0/size", "must be at most 4, is 5"},
                  SchemaFault{"/entries/1/size", "must be integer, is string: write 1, without quotes"},
                  SchemaFault{"/a~1b", "must be boolean, is number: write true or false, without quotes"}));
}

TEST(JsonSchema, MissingAndUnknownKeysAreNamedAllOfThem) {
  EXPECT_THAT(
      faults(R"({"entires": [], "clas": "fast"})"),
      testing::UnorderedElementsAre(SchemaFault{"", "key \"name\" is missing"},
                                    SchemaFault{"/clas", "unknown key \"clas\"; did you mean \"class\"?"},
                                    SchemaFault{"/entires", "unknown key \"entires\"; did you mean \"entries\"?"}));
}

TEST(JsonSchema, WhatSurelyWasMeantIsTold) {
  const JsonSchema lease(R"({"properties": {
      "lease": {"type": ["object", "null"], "instead": {"number": "{\"timeout_ms\": $}"}},
      "listen": {"type": "string"}, "count": {"type": "integer"}, "names": {"type": "array"}, "on": {"type": "boolean"}}})");
  const auto told = [&](const char* document) { return lease.faults_in(json::parse(document)).at(0).message; };
  EXPECT_EQ(told(R"({"lease": 2000})"), "must be object or null, is number: write {\"timeout_ms\": 2000}");
  EXPECT_EQ(told(R"({"lease": "off"})"), "must be object or null, is string");
  EXPECT_EQ(told(R"({"listen": 1502})"), "must be string, is number: write \"1502\", in quotes");
  EXPECT_EQ(told(R"({"count": "-1"})"), "must be integer, is string: write -1, without quotes");
  EXPECT_EQ(told(R"({"count": "1-"})"), "must be integer, is string");
  EXPECT_EQ(told(R"({"count": 1.5})"), "must be a whole number, is 1.5");
  EXPECT_EQ(told(R"({"count": "2 pieces"})"), "must be integer, is string: a number stands alone, without quotes");
  EXPECT_EQ(told(R"({"names": "a"})"), "must be array, is string: write [\"a\"], a list even of one");
  EXPECT_EQ(told(R"({"names": {"a": 1}})"), "must be array, is object: write [{...}], a list even of one");
  EXPECT_EQ(told(R"({"names": null})"), "must be array, is null");
  EXPECT_EQ(told(R"({"on": "yes"})"), "must be boolean, is string: write true or false, without quotes");
}

TEST(JsonSchema, TheUnitIsToldWhereANumberIsNone) {
  const JsonSchema axis(R"({"properties": {
      "velocity": {"type": "integer", "unit": "0.001 rpm", "minimum": 1}, "timeout_ms": {"type": "integer"},
      "travel": {"type": "number", "unit": "turns"}, "node": {"type": "integer", "minimum": 1, "maximum": 4}}})");
  const auto told = [&](const char* document) {
    const auto all = axis.faults_in(json::parse(document));
    EXPECT_EQ(all.size(), 1U) << document;
    return all.at(0).message;
  };
  EXPECT_EQ(told(R"({"velocity": 0.5})"), "must be a whole number of at least 1, in 0.001 rpm, is 0.5");
  EXPECT_EQ(told(R"({"node": 4.5})"), "must be a whole number of 1 to 4, is 4.5");
  EXPECT_EQ(told(R"({"velocity": "3000 rpm"})"),
            "must be integer, is string: a number stands alone, in 0.001 rpm, without quotes");
  EXPECT_EQ(told(R"({"timeout_ms": "2s"})"),
            "must be integer, is string: a number stands alone, in ms, without quotes");
  EXPECT_EQ(told(R"({"travel": "5 %"})"), "must be number, is string: a number stands alone, in turns, without quotes");
  EXPECT_EQ(told(R"({"timeout_ms": "soon"})"), "must be integer, is string");
  EXPECT_EQ(told(R"({"timeout_ms": "1.2.3 s"})"), "must be integer, is string");
}

TEST(JsonSchema, BehindAnUnknownKeyStandsWhatIsKnown) {
  const auto told = [](const std::string& properties, const char* key) {
    const JsonSchema rules(R"({"additionalProperties": false, "properties": {)" + properties + "}}");
    return rules.faults_in(json{{key, 1}}).at(0).message;
  };
  const std::string axis = R"("axis": {}, "timeout_ms": {}, "units_per_rev": {})";
  EXPECT_EQ(told(axis, "timeout"), "unknown key \"timeout\"; did you mean \"timeout_ms\"?");
  EXPECT_EQ(told(axis, "units_per_revolution"),
            "unknown key \"units_per_revolution\"; did you mean \"units_per_rev\"?");
  EXPECT_EQ(told(axis, "gear"), "unknown key \"gear\": the keys here are axis, timeout_ms, units_per_rev");
  EXPECT_EQ(told(axis, "axis_number"),
            "unknown key \"axis_number\": the keys here are axis, timeout_ms, units_per_rev");
  std::string many = R"("a00": {})";
  for (int i = 1; i < 20; ++i) many += R"(, "a)" + std::to_string(i / 10) + std::to_string(i % 10) + R"(": {})";
  const std::string cut = told(many, "station");
  EXPECT_TRUE(cut.ends_with("a14, a15 and 4 more")) << cut;
}

TEST(JsonSchema, AListThatIsTooLongIsAFault) {
  EXPECT_THAT(faults(R"({"name": "x", "entries": [{"size": 1}, {"size": 1}, {"size": 1}]})"),
              ElementsAre(SchemaFault{"/entries", "must have at most 2 entries, has 3"}));
}

TEST(JsonSchema, ADocumentOfAnotherKindIsAFault) {
  EXPECT_THAT(faults("[1]"), ElementsAre(SchemaFault{"", "must be object, is array"}));
}

std::string refusal(std::string_view text) {
  const auto parsed = parse_json(text);
  const auto* fault = std::get_if<SchemaFault>(&parsed);
  return fault == nullptr ? "accepted" : fault->message;
}

TEST(JsonFile, CommentsAreAllowed) { EXPECT_EQ(refusal("{ // why\n \"a\": 1 /* what */ }"), "accepted"); }

TEST(JsonFile, ANumberWithoutAFractionIsAnIntegerHoweverItIsWritten) {
  const auto parsed = parse_json(R"({"baud": 38400.0, "speed": 1e3, "ratio": 27.5, "far": 1e300, "none": -0.0})");
  const auto* const document = std::get_if<json>(&parsed);
  ASSERT_NE(document, nullptr);
  EXPECT_TRUE((*document)["baud"].is_number_integer());
  EXPECT_EQ((*document)["baud"], 38400);
  EXPECT_EQ((*document)["speed"], 1000);
  EXPECT_EQ((*document)["none"], 0);
  EXPECT_TRUE((*document)["none"].is_number_integer());
  EXPECT_TRUE((*document)["ratio"].is_number_float());
  EXPECT_TRUE((*document)["far"].is_number_float()) << "no integer that anybody can hold";
}

TEST(JsonFile, Utf16IsNamedAsSuch) {
  using namespace std::string_view_literals;
  for (const std::string_view text : {"\xFF\xFE{\0}\0"sv, "\xFE\xFF\0{\0}"sv, "{\0}\0"sv, "\0{\0}"sv})
    EXPECT_TRUE(refusal(text).starts_with("is UTF-16: save it as UTF-8"));
  EXPECT_EQ(refusal("\xEF\xBB\xBF{}"), "accepted") << "UTF-8 with its mark";
}

TEST(JsonFile, AKeyTwiceIsRefusedAndItsPlaceTold) {
  EXPECT_EQ(refusal(R"({"a": {"b": {"c": 1, "d": {}, "c": 2}}})"), "key \"c\" is given twice under /a/b");
  EXPECT_EQ(refusal(R"({"a": {"c": 1}, "b": {"c": 2}})"), "accepted");
}

TEST(JsonFile, DepthAndTextsAreBounded) {
  EXPECT_EQ(refusal(std::string(100, '[') + std::string(100, ']')), "nested more than 32 levels deep");
  EXPECT_EQ(refusal("\"" + std::string(5000, 'x') + "\""), "a text of more than 4096 characters");
}

TEST(JsonFile, NumbersAreExactAsWritten) {
  const auto rational_of = [](const json& value) { return JsonNode(value, "").rational(); };
  EXPECT_EQ(rational_of(json::parse("27.5")), Rational(55, 2));
  EXPECT_EQ(rational_of(json::parse("0.1")), Rational(1, 10));
  EXPECT_EQ(rational_of(json::parse("\"1.414\"")), Rational(1414, 1000));
  EXPECT_EQ(rational_of(json::parse("65536")), Rational(65536));
  EXPECT_EQ(rational_of(json::parse("\"10000/60\"")), Rational(500, 3));
  EXPECT_EQ(rational_of(json::parse("\"-1.5/0.25\"")), Rational(-6));
  for (const char* none : {"\"1/0\"", "\"1/\"", "\"/3\"", "\"1/2/3\"", "\"999999999999999999/0.0000000000000001\""})
    EXPECT_EQ(rational_of(json::parse(none)), std::nullopt) << none;
  EXPECT_EQ(rational_of(json::parse("\"ten\"")), std::nullopt);
  EXPECT_EQ(rational_of(json::parse("true")), std::nullopt);
}

// What the schema has refused is read on all the same, for the mistakes behind it.
TEST(JsonNode, TakesNoTimeThatOverflows) {
  const json document = json::parse(R"({"day": 86400000, "longer": 9223372036854775807, "negative": -1})");
  const JsonNode node(document, "");
  EXPECT_EQ(node.milliseconds("day", Duration(7)), std::chrono::hours(24));
  EXPECT_EQ(node.milliseconds("longer", Duration(7)), Duration(7));
  EXPECT_EQ(node.milliseconds("negative", Duration(7)), Duration(7));
}

}  // namespace
}  // namespace axisgate::profile
