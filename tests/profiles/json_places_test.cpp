// SPDX-License-Identifier: Apache-2.0
// Where something stands in a JSON text, and what is said of a text that is none.
#include "gateway/profile/json/json_places.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "gateway/profile/json/json_fault.hpp"

namespace axisgate::profile {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// "LINE:COLUMN" of a pointer; "none".
std::string place(std::string_view text, const std::string& pointer) {
  const JsonPlace found = places_of(text, {pointer}).at(0);
  return found.line == 0 ? "none" : std::to_string(found.line) + ":" + std::to_string(found.column);
}

TEST(JsonPlaces, AreThoseOfKeysAndOfEntries) {
  constexpr std::string_view kText =
      "{\n  \"a\": 1,\n  \"buses\": [{\"node\": 1}, {\n    \"node\": -2.5e1}, 7, [8 , true,\"x\"]]\n}";
  EXPECT_EQ(place(kText, "/a"), "2:3");
  EXPECT_EQ(place(kText, "/buses"), "3:3");
  EXPECT_EQ(place(kText, "/buses/0"), "3:13");
  EXPECT_EQ(place(kText, "/buses/0/node"), "3:14");
  EXPECT_EQ(place(kText, "/buses/1"), "3:26");
  EXPECT_EQ(place(kText, "/buses/1/node"), "4:5");
  EXPECT_EQ(place(kText, "/buses/2"), "4:22");
  EXPECT_EQ(place(kText, "/buses/3/0"), "4:26");
  EXPECT_EQ(place(kText, "/buses/3/1"), "4:30");
  EXPECT_EQ(place(kText, "/buses/3/2"), "4:35");
}

TEST(JsonPlaces, OfWhatIsNotThereAreThoseAroundIt) {
  constexpr std::string_view kText = R"({"buses": [{"name": "a"}]})";
  EXPECT_EQ(place(kText, "/buses/0/drives/3/node"), "1:12");
  EXPECT_EQ(place(kText, "/buses/1"), "1:2");
  EXPECT_EQ(place(kText, "/dds/domain"), "none");
  EXPECT_EQ(place(kText, ""), "none");
  EXPECT_EQ(place(kText, "no pointer"), "none");
}

TEST(JsonPlaces, CountCharactersAndLinesAsEditorsDo) {
  EXPECT_EQ(place("{\"\xC3\xA4\xE2\x82\xAC\": 1, \"b\": 2}", "/b"), "1:11") << "two letters of several bytes";
  EXPECT_EQ(place("{\r\n\t\t\"b\": 2}", "/b"), "2:3") << "Windows, and tabs";
  EXPECT_EQ(place("\xEF\xBB\xBF{\"b\": 2}", "/b"), "1:2") << "the byte order mark is no character";
  EXPECT_EQ(place("{ // \"b\": 1\n /* \"b\": 2,\n */ \"b\": 3}", "/b"), "3:5");
}

TEST(JsonPlaces, ReadKeysAsTheyAreMeant) {
  constexpr std::string_view kText = R"({"\u0062\"\\": {"a/b": 1, "m~n": 2}, "\\": 3, "c": 4})";
  EXPECT_EQ(place(kText, "/b\"\\"), "1:2");
  EXPECT_EQ(place(kText, "/b\"\\/a~1b"), "1:17");
  EXPECT_EQ(place(kText, "/b\"\\/m~0n"), "1:27");
  EXPECT_EQ(place(kText, "/\\"), "1:38");
  EXPECT_EQ(place(kText, "/c"), "1:47");
}

TEST(JsonPlaces, AreFoundForManyAtOnceInTheirOrder) {
  EXPECT_THAT(places_of("{\"a\": [\n1,\n2]}", {"/a/1", "/a", "", "/a/0", "/a/1"}),
              ElementsAre(JsonPlace{3, 1}, JsonPlace{1, 2}, JsonPlace{}, JsonPlace{2, 1}, JsonPlace{3, 1}));
}

TEST(JsonPlaces, AreNotLookedForWithoutEnd) {
  EXPECT_EQ(place(std::string(1'000'000, '['), "/0/0"), "1:3") << "what is no JSON ends the looking";
  std::string long_text = "[";
  std::vector<std::string> pointers;
  for (std::size_t i = 0; i < 100'000; ++i) {
    long_text += "1,\n";
    pointers.push_back("/" + std::to_string(i));
  }
  EXPECT_EQ(places_of(long_text + "1]", pointers).back(), (JsonPlace{100'000, 1}));
}

TEST(JsonFaults, SayFileLineColumnAndPointer) {
  EXPECT_EQ(text(Fault{"a.json", "/buses/0", "is wrong", {3, 14}}), "a.json:3:14: /buses/0: is wrong");
  EXPECT_EQ(text(Fault{"a.json", "", "is no JSON", {3, 14}}), "a.json:3:14: is no JSON");
  EXPECT_EQ(text(Fault{"a.json", "/buses/0", "is wrong"}), "a.json: /buses/0: is wrong");
  std::vector<Fault> faults{
      {"b.json", "/b", "1"}, {"a.json", "/b", "2"}, {"c.json", "/b", "3"}, {"a.json", "", "4", {7, 7}}};
  locate(faults, {{"a.json", "{\"a\": 1,\n\"b\": 2}"}, {"b.json", "{\"b\": 2}"}, {"c.json"}});
  EXPECT_EQ(faults[0].place, (JsonPlace{1, 2}));
  EXPECT_EQ(faults[1].place, (JsonPlace{2, 1}));
  EXPECT_EQ(faults[2].place, JsonPlace{}) << "it was not read";
  EXPECT_EQ(faults[3].place, (JsonPlace{7, 7})) << "it was known";
}

/// "LINE:COLUMN: message"
std::string said_of(std::string_view text) {
  const auto parsed = parse_json(text);
  const auto* fault = std::get_if<SchemaFault>(&parsed);
  return fault == nullptr ? "accepted" : profile::text(Fault{"", "", fault->message, fault->place}).substr(1);
}

TEST(NoJson, CommasTooManyOrTooFew) {
  EXPECT_EQ(said_of("{\"a\": 1,\n \"b\": 27, // last\n}"), "2:9: nothing follows this comma but }: remove the comma");
  EXPECT_EQ(said_of("{\"a\": [1, 2,\n ] }"), "1:12: nothing follows this comma but ]: remove the comma");
  EXPECT_EQ(said_of("{\"a\": [1,, 2]}"), "1:10: two commas, and nothing between them: remove one");
  EXPECT_EQ(said_of("{\"a\": 1\n  \"b\": 2}"), "1:8: a comma is missing here");
  EXPECT_EQ(said_of("{\"a\": \"x\" // why\n  \"b\": 2}"), "1:10: a comma is missing here");
  EXPECT_EQ(said_of("{\"a\": 1 // one, two\n  \"b\": 2}"), "1:8: a comma is missing here");
  EXPECT_EQ(said_of("{\"a\": 1 /* one, two */ \"b\": 2}"), "1:8: a comma is missing here");
  EXPECT_EQ(said_of("[{\"a\": 1}\n {\"a\": 2}]"), "1:10: a comma is missing here");
  EXPECT_EQ(said_of("[1 2]"), "1:3: a comma is missing here");
  EXPECT_EQ(said_of("{\"a\": true\n \"b\": 1}"), "1:11: a comma is missing here");
  EXPECT_EQ(said_of("{\"a\" 1}"), "1:5: a colon is missing between a key and its value");
  EXPECT_EQ(said_of("{\"a\" = 1}"), "1:6: a colon stands between a key and its value: write : for =");
  EXPECT_EQ(said_of("{\"a\": }"), "1:7: a value is missing behind the colon");
  EXPECT_EQ(said_of("[\"a\": 1]"), "1:5: a list has no keys: put { } around key and value");
}

TEST(NoJson, QuotesOfAnotherKindAndNone) {
  EXPECT_EQ(said_of("{'a': 1}"), "1:2: keys and texts stand in double quotes: write \" for '");
  EXPECT_EQ(said_of("{\"\xC3\xA4\": 'x'}"), "1:7: keys and texts stand in double quotes: write \" for '");
  EXPECT_THAT(said_of("{\xE2\x80\x9C"
                      "a\xE2\x80\x9D: 1}"),
              HasSubstr("1:2: a typographic quote"));
  EXPECT_EQ(said_of("{\n  buses: []}"), "2:3: keys and texts stand in double quotes: write \"buses\"");
  EXPECT_EQ(said_of("{$schema: 1}"), "1:2: keys and texts stand in double quotes: write \"$schema\"");
  EXPECT_EQ(said_of("{\"a\": kinco-jd}"), "1:7: keys and texts stand in double quotes: write \"kinco-jd\"");
  EXPECT_EQ(said_of("{\"a\": never}"), "1:7: keys and texts stand in double quotes: write \"never\"");
  EXPECT_EQ(said_of("{\"a\": tru}"), "1:7: keys and texts stand in double quotes: write \"tru\"");
  EXPECT_EQ(said_of("{\"a\": True}"), "1:7: write true, in small letters");
  EXPECT_EQ(said_of("{\"a\": None}"), "1:7: write null for None");
  EXPECT_EQ(said_of("{\"a\": ~}"), "1:7: write null for ~");
  EXPECT_EQ(said_of("{\"a\": yes}"), "1:7: write true for yes");
  EXPECT_EQ(said_of("{\"a\": No, \"b\": 1}"), "1:7: write false for No");
  EXPECT_EQ(said_of("{\"a\": on\n}"), "1:7: write true for on, or \"on\" in quotes where the key takes this word");
  EXPECT_EQ(said_of("{\"a\": OFF}"), "1:7: write false for OFF, or \"off\" in quotes where the key takes this word");
  EXPECT_EQ(said_of("{\"a\": none}"), "1:7: keys and texts stand in double quotes: write \"none\"");
  EXPECT_EQ(said_of("{on: 1}"), "1:2: keys and texts stand in double quotes: write \"on\"");
  EXPECT_EQ(said_of("{\"a\": \"x,\n \"b\": 1}"), "1:7: this text has no end on its line: a \" is missing");
  EXPECT_EQ(said_of("{\"a\": \"x"), "1:7: this text has no end on its line: a \" is missing");
  EXPECT_EQ(said_of(R"({"a": "C:\dev"})"), "1:10: a backslash within a text is written twice: \\\\");
  EXPECT_EQ(said_of("{\"a\": \"x\ty\"}"), "1:9: a tab within a text is written \\t");
}

TEST(NoJson, NumbersOfAnotherKind) {
  EXPECT_EQ(said_of("{\"a\": 27,5}"), "1:7: a number has a decimal point: write 27.5");
  EXPECT_EQ(said_of("{\"a\": 0x1F}"), "1:7: numbers are written in decimal, without 0x");
  EXPECT_EQ(said_of("{\"a\": 500k}"), "1:10: a number stands alone: write it without \"k\", in the unit of its key");
  EXPECT_EQ(said_of("{\"a\": 3_000_000}"), "1:7: a number has no _ in it: write 3000000");
  EXPECT_EQ(said_of("{\"a\": [-1_000.5]}"), "1:8: a number has no _ in it: write -1000.5");
  EXPECT_EQ(said_of("{\"a\": 3_rpm}"), "1:8: a number stands alone: write it without \"_rpm\", in the unit of its key");
  EXPECT_EQ(said_of("{\"a\": 007}"), "1:7: a number has no zeros before it: remove them");
  EXPECT_THAT(said_of("{\"a\": 1e999}"), HasSubstr("number overflow"));
}

TEST(NoJson, CommentsOfAnotherKind) {
  EXPECT_EQ(said_of("# the lift\n{}"), "1:1: a comment begins with // or stands between /* and */: write // for #");
  EXPECT_EQ(said_of("{\"a\": 1, # one\n\"b\": 2}"),
            "1:10: a comment begins with // or stands between /* and */: write // for #");
  EXPECT_EQ(said_of("{\"a\": 1 / one\n}"), "1:9: a comment begins with // or stands between /* and */");
  EXPECT_EQ(said_of("{\"a\": 1\n /* one }"), "2:2: this comment has no end: add */");
}

TEST(NoJson, BracketsThatAreNotClosed) {
  EXPECT_EQ(said_of("{\n \"buses\": [{\"a\": 1}"),
            "2:20: the file ends, and the [ of line 2, column 11 is still open: ] is missing");
  EXPECT_EQ(said_of("{\"a\": {\"b\": 1}\n"),
            "2:1: the file ends, and the { of line 1, column 1 is still open: } is missing");
  EXPECT_EQ(said_of("{\"a\": 12"), "1:9: the file ends, and the { of line 1, column 1 is still open: } is missing");
  EXPECT_EQ(said_of("{\"a\": [1}"), "1:9: would close the [ of line 1, column 7: write ] for }");
  EXPECT_EQ(said_of("{\"a\": 1}}"),
            "1:9: the first bracket of the file is closed before this: remove a bracket above, or what follows here");
  EXPECT_EQ(said_of("\"a\": 1"), "1:1: a { is missing before the first key");
  EXPECT_EQ(said_of(" \n"), "2:1: has no JSON in it: it begins with {");
  EXPECT_EQ(said_of(""), "1:1: has no JSON in it: it begins with {");
  EXPECT_EQ(said_of(std::string(1'000'000, '[')),
            "1:1000001: the file ends, and the [ of line 1, column 1000000 is still open: ] is missing");
}

TEST(NoJson, WhatJsonAllowsAndNobodyMeansHasItsPlaceToo) {
  EXPECT_EQ(said_of("{\"a\": {\"b\": 1,\n \"b\": 2}}"), "2:2: key \"b\" is given twice under /a");
  EXPECT_EQ(said_of("{\"a\":\n  \"" + std::string(5000, 'x') + "\"}"), "2:3: a text of more than 4096 characters");
  EXPECT_EQ(said_of(std::string(40, '[') + std::string(40, ']')).substr(0, 5), "1:34:");
}

TEST(NoJson, FilesOfAnotherKind) {
  EXPECT_THAT(said_of("# the lift\n\nmodbus_tcp:\n  - listen: x\n"), HasSubstr("3:1: is YAML, and JSON is wanted: "));
  EXPECT_THAT(said_of("---\r\nbuses: []\r\n"), HasSubstr("1:1: is YAML"));
  EXPECT_THAT(said_of("- 1\n- 2\n"), HasSubstr("1:1: is YAML"));
  EXPECT_THAT(said_of("// no YAML: this is JSON\n{\"a\" 1}"), HasSubstr("2:5: a colon is missing"));
  EXPECT_THAT(said_of("{\"a\": \"\xFC\"}"), HasSubstr("1:8: is no UTF-8: save the file as UTF-8"));
  EXPECT_THAT(said_of("{\xC2\xA0\"a\": 1}"), HasSubstr("1:2: looks like a space and is none (U+00A0)"));
  EXPECT_THAT(said_of("{}\xEF\xBB\xBF"), HasSubstr("1:3: a byte-order mark (U+FEFF)"));
}

}  // namespace
}  // namespace axisgate::profile
