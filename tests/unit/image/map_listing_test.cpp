// SPDX-License-Identifier: Apache-2.0
#include "gateway/listing/map_listing.hpp"
#include "gateway/listing/row_meanings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

namespace axisgate {
namespace {

listing::ListedMap two_axes() {
  listing::ListedMap map;
  map.buses = {"lift-serial", "a \"quoted\", name"};
  listing::ListedAxis one;
  one.number = 1;
  one.name = "lift";
  one.bus = "lift-serial";
  one.supported = ~0U & ~bit(Quantity::motor_temperature);
  one.writable = one.supported & ~bit(Quantity::max_torque);
  one.supported_commands = 0x0FFE & ~(1U << 11);
  listing::ListedAxis five = one;
  five.number = 5;
  five.position_unit = listing::position_unit(360, 1);
  map.axes = {one, five};
  return map;
}

const listing::MapEntry* find(const std::vector<listing::MapEntry>& entries, std::string_view table, int address) {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const listing::MapEntry& e) { return e.table == table && e.address == address; });
  return found == entries.end() ? nullptr : &*found;
}

TEST(MapListing, PrintsTheEntryOfTheContractsExample) {
  const std::string json = listing::map_text(two_axes(), listing::MapFormat::json);
  EXPECT_NE(json.find(R"({"table":"holding","address":102,"count":2,"axis":1,"bus":null,"name":"position_actual",)"
                      R"("type":"i32","unit":"1/10000 rev","access":"r","supported":true})"),
            std::string::npos)
      << json.substr(0, 2000);
}

TEST(MapListing, JsonCarriesVersionWordOrderAndEveryEntry) {
  listing::ListedMap map = two_axes();
  auto json = nlohmann::json::parse(listing::map_text(map, listing::MapFormat::json));
  EXPECT_EQ(json["map_version"], 1);
  EXPECT_EQ(json["word_order"], "high-first");
  EXPECT_EQ(json["entries"].size(), listing::map_entries(map).size());
  map.low_word_first = true;
  EXPECT_EQ(nlohmann::json::parse(listing::map_text(map, listing::MapFormat::json))["word_order"], "low-first");
}

TEST(MapListing, CountsEveryRowOfEveryBlock) {
  // gateway 9; per axis 65 registers, 8 of the overview, 10 coils, 13 inputs; per bus 15.
  EXPECT_EQ(listing::map_entries(two_axes()).size(), 9U + 2U * (65 + 8 + 10 + 13) + 2U * 15);
}

TEST(MapListing, IsSortedByTableAndAddressAndNamesNoAddressTwice) {
  const auto entries = listing::map_entries(two_axes());
  std::set<std::pair<std::string_view, int>> seen;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (int part = 0; part < entries[i].count; ++part)
      EXPECT_TRUE(seen.emplace(entries[i].table, entries[i].address + part).second) << entries[i].name;
    if (i > 0 && entries[i].table == entries[i - 1].table) {
      EXPECT_GT(entries[i].address, entries[i - 1].address);
    }
  }
}

TEST(MapListing, AxisAndNameTogetherAreOneAddressOfATable) {
  std::set<std::string> seen;
  for (const listing::MapEntry& entry : listing::map_entries(two_axes())) {
    if (!entry.axis) continue;
    EXPECT_TRUE(seen.insert(std::string(entry.table) + std::to_string(*entry.axis) + entry.name).second) << entry.name;
  }
}

TEST(MapListing, SaysWhatTheDriveHasAndWhatCanBeWritten) {
  const auto entries = listing::map_entries(two_axes());
  EXPECT_FALSE(find(entries, "holding", 116)->supported) << "motor_temperature";
  EXPECT_TRUE(find(entries, "holding", 142)->supported);
  EXPECT_EQ(find(entries, "holding", 142)->access, "rw");
  EXPECT_EQ(find(entries, "holding", 147)->access, "r") << "max_torque, on this drive";
  EXPECT_EQ(find(entries, "holding", 100)->access, "r");
  EXPECT_TRUE(find(entries, "holding", 158)->supported) << "jog_velocity";
  EXPECT_FALSE(find(entries, "holding", 178)->supported) << "set_position_value, without the command";
  EXPECT_TRUE(find(entries, "coil", 106)->supported);
  EXPECT_TRUE(find(entries, "coil", 108)->supported) << "jog_forward";
  EXPECT_TRUE(find(entries, "discrete", 511)->supported);
  listing::ListedMap without_velocity = two_axes();
  without_velocity.axes[0].supported_commands &= ~(1U << 8);
  const auto others = listing::map_entries(without_velocity);
  EXPECT_FALSE(find(others, "holding", 158)->supported) << "jogging is running at a velocity";
  EXPECT_FALSE(find(others, "coil", 109)->supported);
}

TEST(MapListing, PrintsPositionsInTheAxissOwnUnit) {
  const auto entries = listing::map_entries(two_axes());
  EXPECT_EQ(find(entries, "holding", 502)->unit, "1/360 rev");
  EXPECT_EQ(find(entries, "holding", 578)->unit, "1/360 rev");
  EXPECT_EQ(find(entries, "holding", 60052)->unit, "1/360 rev");
  EXPECT_EQ(find(entries, "holding", 104)->unit, "0.001 rpm");
  EXPECT_EQ(listing::position_unit(60000, 37), "37/60000 rev");
}

TEST(MapListing, OfAListenerWithFloatsNamesTheirTypeAndUnit) {
  listing::ListedMap map = two_axes();
  EXPECT_EQ(listing::map_text(map, listing::MapFormat::json).find("numbers"), std::string::npos);
  map.float_numbers = true;
  const auto entries = listing::map_entries(map);
  const auto told = [&](int address) {
    const listing::MapEntry* const entry = find(entries, "holding", address);
    return std::string(entry->type) + " " + entry->unit;
  };
  EXPECT_EQ(told(502), "f32 rev");
  EXPECT_EQ(told(104), "f32 rpm");
  EXPECT_EQ(told(150), "f32 rpm/s");
  EXPECT_EQ(told(158), "f32 rpm");
  EXPECT_EQ(told(60052), "f32 rev");
  EXPECT_EQ(told(146), "i16 0.1 %");
  EXPECT_EQ(told(194), "u32 0.001 rpm");
  EXPECT_EQ(told(120), "u32 ");
  // The rows of design 3.1 Panels, and no others.
  std::set<int> floats;
  for (const listing::MapEntry& entry : entries)
    if (entry.type == "f32" && entry.address < 200) floats.insert(entry.address - 100);
  EXPECT_EQ(floats, (std::set<int>{2, 4, 8, 42, 44, 48, 50, 52, 58, 62, 64, 66, 68, 70, 72, 74, 76, 78}));
  EXPECT_EQ(nlohmann::json::parse(listing::map_text(map, listing::MapFormat::json))["numbers"], "float");
  EXPECT_NE(listing::map_text(map, listing::MapFormat::table).find("f32: IEEE 754"), std::string::npos);
}

TEST(MapListing, NamesTheBusOfBusRowsAndNoAxis) {
  const auto entries = listing::map_entries(two_axes());
  const listing::MapEntry* entry = find(entries, "holding", 50104);
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(entry->name, "requests");
  EXPECT_EQ(entry->bus, "a \"quoted\", name");
  EXPECT_FALSE(entry->axis.has_value());
}

TEST(MapListing, CsvHasTheColumnsOfTheContractAndQuotesWhatNeedsIt) {
  const std::string csv = listing::map_text(two_axes(), listing::MapFormat::csv);
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "table,address,count,axis,bus,name,type,unit,access,supported,reference,meaning");
  EXPECT_NE(csv.find("holding,102,2,1,,position_actual,i32,1/10000 rev,r,true,40103,where the motor is\n"),
            std::string::npos);
  EXPECT_NE(csv.find("holding,50100,1,,\"a \"\"quoted\"\", name\",link,u16,,r,true,450101,whether the bus is up\n"),
            std::string::npos);
}

TEST(MapListing, MarkdownCarriesTheRows) {
  listing::ListedMap piped = two_axes();
  piped.buses[1] = "a|b";
  const std::string markdown = listing::map_text(piped, listing::MapFormat::markdown);
  EXPECT_NE(markdown.find("| a\\|b |"), std::string::npos) << "a bar in a cell ends no cell";
  EXPECT_NE(
      markdown.find(
          "| holding | 102 | 2 | 1 |  | position_actual | i32 | 1/10000 rev | r | true | 40103 | where the motor is |"),
      std::string::npos);
  const auto rows = static_cast<std::ptrdiff_t>(listing::map_entries(two_axes()).size());
  EXPECT_EQ(std::count(markdown.begin(), markdown.end(), '\n'), rows + 2);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(MapListing, TheTableIsReadableAtEightyColumnsAndHasEachRowOnce) {
  const listing::ListedMap map = two_axes();
  const std::string table = listing::map_text(map, listing::MapFormat::table);
  EXPECT_NE(table.find("axis 1: lift, on lift-serial\n"), std::string::npos);
  EXPECT_NE(table.find("\naxis 1 lift: registers\naddress     ref  type     name "), std::string::npos);
  EXPECT_NE(table.find("\n    102   40103  i32  r   position_actual "), std::string::npos);
  EXPECT_NE(table.find("where the motor is, "), std::string::npos);
  EXPECT_NE(
      std::regex_replace(table, std::regex("\\s+"), " ").find("temperature of the motor, 0.1 degC (not on this drive)"),
      std::string::npos);
  for (const char* block :
       {"gateway", "axis 1 lift: overview", "axis 5 lift: coils", "axis 5 lift: discrete inputs", "bus 0 lift-serial"})
    EXPECT_NE(table.find("\n" + std::string(block) + "\n"), std::string::npos) << block;
  std::size_t rows = 0;
  for (const std::string& line : lines_of(table)) {
    EXPECT_LE(line.size(), 80U) << line;
    rows += std::regex_search(line, std::regex("^ +[0-9]+ +[0-9]{5,6}  ")) ? 1U : 0U;
  }
  EXPECT_EQ(rows, listing::map_entries(map).size());
  for (const std::string& line : lines_of(listing::map_text(map, listing::MapFormat::table, 200)))
    EXPECT_FALSE(line.starts_with(std::string(40, ' '))) << "a wide terminal has room for all of it: " << line;
}

TEST(MapListing, CountsAsModiconDoes) {
  const auto entries = listing::map_entries(two_axes());
  const auto reference = [&](std::string_view table, int address) {
    return listing::reference_of(*find(entries, table, address));
  };
  EXPECT_EQ(reference("holding", 0), "40001");
  EXPECT_EQ(reference("holding", 102), "40103");
  EXPECT_EQ(reference("coil", 100), "00101");
  EXPECT_EQ(reference("discrete", 112), "10113");
  EXPECT_EQ(reference("holding", 50000), "450001");
  listing::MapEntry entry;
  entry.table = "holding";
  entry.address = 9998;
  EXPECT_EQ(listing::reference_of(entry), "49999");
  entry.address = 9999;
  EXPECT_EQ(listing::reference_of(entry), "410000") << "with five digits it would be the input 10000";
  entry.table = "coil";
  EXPECT_EQ(listing::reference_of(entry), "010000");
}

TEST(MapListing, SaysOfEachRowWhatItIsInAFewWords) {
  for (const listing::MapEntry& entry : listing::map_entries(two_axes())) {
    EXPECT_FALSE(entry.meaning.empty()) << entry.name;
    EXPECT_LE(entry.meaning.size(), listing::kLongestMeaning) << entry.name;
  }
  EXPECT_EQ(listing::register_meaning(Block::axis, "no_such_row"), "");
}

// Each line is one that the grammar of IEC 61131-3 allows, no identifier is there twice (they have no cases), and no
// two variables share a register.
TEST(MapListing, AsStructuredTextDeclaresEachRowOnceAtItsRegisters) {
  listing::ListedMap map = two_axes();
  map.buses[1] = "a (* bus *) called\nso";
  map.float_numbers = true;
  const std::string kName = "([a-z][a-z0-9]*(?:_[a-z0-9]+)*)";
  const std::regex constant("  " + kName + " : UINT := ([0-9]+);");
  const std::regex variable("  " + kName + R"( AT %(MW|MD)([0-9]+) : (INT|UINT|DINT|UDINT|REAL);  \(\* .* \*\))");
  const std::regex whole_comment(R"(\(\* .* \*\))");
  std::set<std::string> names;
  std::set<int> registers;
  std::istringstream text(listing::map_text(map, listing::MapFormat::structured_text));
  for (std::string line; std::getline(text, line);) {
    std::smatch found;
    const auto at = line.find("(* ");
    EXPECT_TRUE(at == std::string::npos || line.find("*)") == line.size() - 2) << line;
    if (std::regex_match(line, found, constant)) {
      EXPECT_TRUE(names.insert(found[1]).second) << line;
      EXPECT_LE(std::stoi(found[2]), 65535);
    } else if (std::regex_match(line, found, variable)) {
      EXPECT_TRUE(names.insert(found[1]).second) << line;
      const bool pair = found[2] == "MD";
      const bool wide = found[4] == "DINT" || found[4] == "UDINT" || found[4] == "REAL";
      EXPECT_EQ(pair, wide) << line;
      const int first = std::stoi(found[3]) * (pair ? 2 : 1);
      for (int part = 0; part < (pair ? 2 : 1); ++part) EXPECT_TRUE(registers.insert(first + part).second) << line;
    } else {
      EXPECT_TRUE(line.empty() || line == "VAR_GLOBAL" || line == "VAR_GLOBAL CONSTANT" || line == "END_VAR" ||
                  std::regex_match(line, whole_comment))
          << line;
    }
  }
  std::size_t holding = 0;
  for (const listing::MapEntry& entry : listing::map_entries(map)) holding += entry.table == "holding" ? 1U : 0U;
  EXPECT_EQ(names.size(), listing::map_entries(map).size() + holding);
}

TEST(MapListing, AsStructuredTextSaysWhatARowIs) {
  listing::ListedMap map = two_axes();
  const std::string st = listing::map_text(map, listing::MapFormat::structured_text);
  EXPECT_NE(st.find("(* axis1: lift, on lift-serial *)\n"), std::string::npos);
  EXPECT_NE(st.find("  axis1_position_actual_adr : UINT := 102;\n"), std::string::npos);
  EXPECT_NE(st.find("  axis1_coil_start_absolute_adr : UINT := 104;\n"), std::string::npos);
  EXPECT_NE(st.find("  axis5_position_actual AT %MD251 : DINT;  (* 40503, r, 1/360 rev: where the motor is *)\n"),
            std::string::npos);
  EXPECT_NE(st.find("  axis1_target_torque AT %MW146 : INT;  (* 40147, rw, 0.1 %: "), std::string::npos);
  EXPECT_NE(
      st.find(
          "  axis1_owner AT %MW128 : UINT;  (* 40129, r: who has the axis; 0 nobody, 1 this client, 2 another *)\n"),
      std::string::npos);
  EXPECT_NE(st.find("  axis1_motor_temperature AT %MW116 : INT;  (* 40117, r, not on this drive, 0.1 degC: "),
            std::string::npos);
  EXPECT_NE(st.find("  bus1_link AT %MW50100 : UINT;"), std::string::npos);
  map.float_numbers = true;
  EXPECT_NE(listing::map_text(map, listing::MapFormat::structured_text)
                .find("  axis1_target_position AT %MD71 : REAL;  (* 40143, rw, rev: "),
            std::string::npos);
}

TEST(MapListing, KnowsItsFormatsByName) {
  EXPECT_EQ(listing::map_format_named("json"), listing::MapFormat::json);
  EXPECT_EQ(listing::map_format_named("csv"), listing::MapFormat::csv);
  EXPECT_EQ(listing::map_format_named("md"), listing::MapFormat::markdown);
  EXPECT_EQ(listing::map_format_named("table"), listing::MapFormat::table);
  EXPECT_EQ(listing::map_format_named("st"), listing::MapFormat::structured_text);
  EXPECT_FALSE(listing::map_format_named("xml").has_value());
}

}  // namespace
}  // namespace axisgate
