// SPDX-License-Identifier: Apache-2.0
// Every frame and register of the iD286pro's sheet against the simulated drive.
#include <charconv>

#include "tests/unit/simulated/script.hpp"
#include "tests/unit/simulated/sheets.hpp"

namespace axisgate::simulated {
namespace {

// Every reply of the sheet comes out, byte for byte, when the drive holds what it tells; the one whose printed CRC is
// wrong, as corrected.
TEST(id286pro_sheet, every_frame_is_answered_as_printed) {
  int pairs = 0;
  Bytes request;
  const auto vectors = sheet_of("id286pro", "vectors");
  for (const auto& vector : vectors) {
    const std::string id = vector.at("id").get<std::string>();
    SCOPED_TRACE(id);
    const bool asks = vector.at("direction") == "request";
    if (asks) request = bytes_in(vector);
    if (asks && id != "derived-broadcast-decel-stop-req") continue;
    Bench bench("rtu:id286pro");
    const std::map<std::string, std::vector<std::pair<std::uint16_t, int>>> holds{
        {"ex2-read-304x2-rsp", {{304, 10000}, {305, 0}}},
        {"derived-read-position-rsp", {{321, -12345}, {323, 8}, {323, 0}}}};
    bench.id286pro()->poke(302, 1000);
    if (const auto found = holds.find(id); found != holds.end()) {
      for (const auto& [row, value] : found->second) bench.id286pro()->poke(row, value);
    }
    EXPECT_EQ(bench.exchange(request), asks ? Bytes{} : bytes_in(vector));
    ++pairs;
  }
  EXPECT_EQ(pairs, 18);
}

// "1-5000", "-5000-5000", "-2000000000..2000000000 (...)", "0-1 printed; 0-3 described": the widest that is printed.
std::pair<std::int64_t, std::int64_t> limits_in(std::string text) {
  if (text == "0-1 printed; 0-3 described") text = "0-3";
  std::pair<std::int64_t, std::int64_t> limits;
  const char* end = text.data() + text.size();
  const char* dash = std::from_chars(text.data(), end, limits.first).ptr;
  (void)std::from_chars(dash + (std::string_view(dash).starts_with("..") ? 2 : 1), end, limits.second);
  return limits;
}

TEST(id286pro_sheet, every_row_is_there_with_its_default_and_range) {
  const auto objects = sheet_of("id286pro", "objects");
  EXPECT_EQ(objects.size(), 49U);
  EXPECT_EQ(id286pro_rows().size(), 49U);
  for (const auto& row : objects) {
    SCOPED_TRACE(row.dump());
    const auto scene = scene_on("rtu:id286pro");
    const std::string number = std::to_string(row.at("address").get<int>());
    const auto held = scene->read(Name(number));
    ASSERT_TRUE(held.has_value());
    if (row.at("access") == "R") {
      EXPECT_EQ(scene->write(Name(number), 1), 2U);
      continue;
    }
    // As delivered but for the run mode, which a commissioned drive has changed.
    const auto delivered = row.at("default");
    EXPECT_TRUE(!delivered.is_number() || number == "296" || *held == delivered.get<std::int64_t>());
    if (row.at("range").is_null() || row.at("range") == "") continue;
    const auto [lowest, highest] = limits_in(row.at("range"));
    for (const auto& [value, code] : {std::pair{lowest, 0U}, {highest, 0U}, {highest + 1, 3U}, {lowest - 1, 3U}}) {
      EXPECT_EQ(scene->write(Name(number), value), code);
      EXPECT_EQ(scene->read(Name(number)), value == lowest ? lowest : highest);
    }
  }
}

}  // namespace
}  // namespace axisgate::simulated
