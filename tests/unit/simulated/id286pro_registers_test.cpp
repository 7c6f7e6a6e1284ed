// The iD286pro's registers and frames against its sheet (iD286pro 3, 4, 10).
#include <gmock/gmock.h>

#include <charconv>

#include "tests/unit/simulated/rtu_bench.hpp"

namespace axisgate::simulated {
namespace {

using testing::ElementsAre;

// Every reply of the sheet comes out, byte for byte, when the drive holds what it tells; the one whose printed CRC is
// wrong, as corrected.
TEST(Id286proFrames, EveryFrameOfTheSheetIsAnsweredAsPrinted) {
  int pairs = 0;
  const auto rows = sheet_of("id286pro", "vectors");
  Bytes request;
  for (const auto& vector : rows) {
    const std::string id = vector.at("id").get<std::string>();
    SCOPED_TRACE(id);
    const bool bad = vector.at("checksum_ok").is_boolean() && !vector.at("checksum_ok").get<bool>();
    const Bytes bytes = from_hex(vector.at(bad ? "hex_corrected" : "hex").get<std::string>());
    if (vector.at("direction") == "request") {
      request = bytes;
      if (id != "derived-broadcast-decel-stop-req") continue;
    }
    RtuBench bench(Id286proOptions{});
    Id286pro& drive = bench.id286pro();
    drive.poke(302, 1000);
    if (id == "ex2-read-304x2-rsp") {
      drive.poke(304, 10000);
      drive.poke(305, 0);
    }
    if (id == "derived-read-position-rsp") {
      drive.poke(321, -12345);
      drive.poke(323, 8);
      drive.poke(323, 0);
    }
    const Bytes expected = vector.at("direction") == "request" ? Bytes{} : bytes;
    EXPECT_EQ(bench.exchange(request), expected);
    ++pairs;
  }
  EXPECT_EQ(pairs, 18);
}

struct Limits {
  std::int64_t lowest;
  std::int64_t highest;
};

// "1-5000", "-5000-5000", "-2000000000..2000000000 (...)", "0-1 printed; 0-3 described": the widest that is printed.
std::optional<Limits> limits_in(const nlohmann::json& range) {
  if (range.is_null() || range.get<std::string>().empty()) return std::nullopt;
  std::string text = range.get<std::string>();
  if (text == "0-1 printed; 0-3 described") text = "0-3";
  Limits limits{};
  const auto first = std::from_chars(text.data(), text.data() + text.size(), limits.lowest);
  const char* second = first.ptr + (std::string_view(first.ptr).starts_with("..") ? 2 : 1);
  (void)std::from_chars(second, text.data() + text.size(), limits.highest);
  return limits;
}

int write_row(RtuBench& bench, std::uint16_t number, int words, std::int64_t value) {
  return words == 2 ? bench.write_pair(number, value) : bench.write(number, value);
}

TEST(Id286proRegisters, EveryRowOfTheSheetReadsAndTakesItsRange) {
  int rows = 0;
  const auto objects = sheet_of("id286pro", "objects");
  for (const auto& row : objects) {
    SCOPED_TRACE(row.dump());
    RtuBench bench(Id286proOptions{});
    const auto number = row.at("address").get<std::uint16_t>();
    const int words = row.at("words").get<int>();
    ++rows;
    ASSERT_EQ(bench.read(number, static_cast<std::uint16_t>(words)).size(), static_cast<std::size_t>(words));
    if (row.at("access") == "R") {
      EXPECT_EQ(write_row(bench, number, words, 1), 2);
      continue;
    }
    // As delivered but for the run mode, which a commissioned drive has changed.
    if (row.at("default").is_number() && number != 296) {
      EXPECT_EQ(*bench.id286pro().peek(number), row.at("default").get<std::int64_t>());
    }
    const auto limits = limits_in(row.at("range"));
    if (!limits) continue;
    EXPECT_EQ(write_row(bench, number, words, limits->lowest), 0);
    EXPECT_EQ(*bench.id286pro().peek(number), limits->lowest);
    EXPECT_EQ(write_row(bench, number, words, limits->highest), 0);
    EXPECT_EQ(*bench.id286pro().peek(number), limits->highest);
    EXPECT_EQ(write_row(bench, number, words, limits->highest + 1), 3);
    EXPECT_EQ(write_row(bench, number, words, limits->lowest - 1), 3);
    EXPECT_EQ(*bench.id286pro().peek(number), limits->highest);
  }
  EXPECT_EQ(rows, 49);
  EXPECT_EQ(id286pro_rows().size(), 49U);
}

TEST(Id286proRegisters, TheRunsOfTheSheetReadAtOnceAndLowWordFirst) {
  RtuBench bench(Id286proOptions{});
  for (const auto& [from, to] : std::vector<std::pair<int, int>>{{100, 101},
                                                                 {104, 106},
                                                                 {108, 111},
                                                                 {117, 119},
                                                                 {241, 245},
                                                                 {298, 323},
                                                                 {400, 402},
                                                                 {410, 412},
                                                                 {428, 430}}) {
    const auto count = static_cast<std::uint16_t>(to - from + 1);
    EXPECT_EQ(bench.read(static_cast<std::uint16_t>(from), count).size(), count) << from;
    EXPECT_TRUE(bench.read(static_cast<std::uint16_t>(from - 1), count).empty()) << from;
    EXPECT_TRUE(bench.read(static_cast<std::uint16_t>(from), static_cast<std::uint16_t>(count + 1)).empty()) << from;
  }
  // The check of the numbering that the sheet proposes for bring-up.
  EXPECT_THAT(bench.read(301, 7), ElementsAre(100, 100, 500, 500, 0, 1000, 1000));
  EXPECT_THAT(bench.read(317, 4), ElementsAre(0x9400, 0x7735, 0x6C00, 0x88CA));
}

TEST(Id286proRegisters, AHoleIsRefusedOrReadsAsZeros) {
  RtuBench refusing(Id286proOptions{});
  EXPECT_EQ(*refusing.ask(read_pdu(106, 3)), (Bytes{0x83, 2}));
  EXPECT_EQ(*refusing.ask(read_pdu(500, 1)), (Bytes{0x83, 2}));
  EXPECT_EQ(*refusing.ask(read_pdu(0xFFFF, 2)), (Bytes{0x83, 2}));
  Id286proOptions options;
  options.holes_read_zero = true;
  RtuBench zeros(options);
  EXPECT_THAT(zeros.read(106, 3), ElementsAre(1, 0, 0));
  EXPECT_THAT(zeros.read(500, 2), ElementsAre(0, 0));
  EXPECT_EQ(zeros.write(107, 1), 2);  // a write into a hole is refused either way
}

TEST(Id286proRegisters, OtherFunctionsAndImpossibleCountsAreRefused) {
  RtuBench bench(Id286proOptions{});
  EXPECT_EQ(*bench.ask({0x04, 0, 100, 0, 1}), (Bytes{0x84, 1}));
  EXPECT_EQ(*bench.ask({0x2B, 0x0E, 1, 0, 0}), (Bytes{0xAB, 1}));
  EXPECT_EQ(*bench.ask(read_pdu(301, 0)), (Bytes{0x83, 3}));
  EXPECT_EQ(*bench.ask(read_pdu(301, 126)), (Bytes{0x83, 3}));
  EXPECT_EQ(*bench.ask({0x10, 1, 45, 0, 2, 2, 0, 1}), (Bytes{0x90, 3}));
  Id286proOptions options;
  options.most_registers = 2;
  RtuBench small(options);
  EXPECT_EQ(small.read(301, 2).size(), 2U);
  EXPECT_TRUE(small.read(301, 3).empty());
}

TEST(Id286proRegisters, SeveralRegistersAreWrittenTogetherOrNotAtAll) {
  RtuBench bench(Id286proOptions{});
  EXPECT_EQ(bench.write_several(301, {200, 300, 600, 700, 1, 1500}), 0);
  EXPECT_THAT(bench.read(301, 6), ElementsAre(200, 300, 600, 700, 1, 1500));
  EXPECT_EQ(bench.write_several(301, {210, 310, 4, 710, 1, 1500}), 3);          // 0303 below its range
  EXPECT_EQ(bench.write_several(108, {0, 0}), 2);                               // read-only
  EXPECT_EQ(bench.write_several(302, std::vector<std::uint16_t>(30, 100)), 2);  // into the hole behind 0323
  EXPECT_THAT(bench.read(301, 6), ElementsAre(200, 300, 600, 700, 1, 1500));
  EXPECT_EQ(bench.id286pro().registers().writes(301), 1U);
}

TEST(Id286proRegisters, HalfOfAPairLeavesTheOtherHalf) {
  RtuBench bench(Id286proOptions{});
  bench.write_pair(313, -100000);
  EXPECT_EQ(bench.write(313, 0x1234), 0);
  EXPECT_THAT(bench.read(313, 2), ElementsAre(0x1234, 0xFFFE));
  EXPECT_EQ(bench.write(314, 0x7FFF), 3);  // would be beyond 2000000000
  EXPECT_THAT(bench.read(314, 1), ElementsAre(0xFFFE));
}

TEST(Id286proRegisters, TheSegmentAreaHoldsPlainRegisters) {
  RtuBench bench(Id286proOptions{});
  EXPECT_EQ(bench.write_several(1024, {1, 2, 3}), 0);
  EXPECT_EQ(bench.write(1535, 0xFFFF), 0);
  EXPECT_THAT(bench.read(1024, 3), ElementsAre(1, 2, 3));
  EXPECT_EQ(bench.word(1535), 0xFFFF);
  EXPECT_TRUE(bench.read(1536).empty());
  EXPECT_TRUE(bench.read(1023).empty());
}

TEST(Id286proRegisters, StatusMirrorsTheSettings) {
  RtuBench bench(Id286proOptions{});
  bench.write_pair(242, 51200);
  bench.write(244, 2);
  EXPECT_EQ(bench.pair(104), 51200);
  EXPECT_EQ(bench.word(106), 2);
  EXPECT_EQ(bench.word(101), 4800);
  EXPECT_EQ(bench.id286pro().poke(101, 2399), RtuException::none);
  EXPECT_EQ(bench.word(101), 2399);
  EXPECT_EQ(bench.id286pro().poke(109, 1), RtuException::address);
}

TEST(Id286proRegisters, TheCurrentFallsToTheStandstillRatioAfterItsDelay) {
  RtuBench bench(Id286proOptions{});
  bench.pass(std::chrono::seconds(1));
  EXPECT_EQ(bench.word(100), 1500);  // half of 3 A
  bench.write(323, 4);
  bench.pass(milliseconds(50));
  EXPECT_EQ(bench.word(100), 3000);
  bench.write(323, 7);
  bench.pass(milliseconds(400));
  EXPECT_EQ(bench.word(100), 3000);
  bench.pass(milliseconds(200));
  EXPECT_EQ(bench.word(100), 1500);
  bench.id286pro().set_enable_switch(false);
  EXPECT_EQ(bench.word(100), 0);
}

TEST(Id286proAddress, TheGlobalAddressIs255AndTheStandards0IsAnOption) {
  RtuBench bench(Id286proOptions{});
  EXPECT_TRUE(bench.exchange(seal_rtu(255, write_pdu(301, 77))).empty());
  EXPECT_EQ(bench.word(301), 77);
  EXPECT_TRUE(bench.exchange(seal_rtu(0, write_pdu(301, 78))).empty());
  EXPECT_EQ(bench.word(301), 77);
  Id286proOptions options;
  options.obeys_address_zero = true;
  RtuBench standard(options);
  EXPECT_TRUE(standard.exchange(seal_rtu(0, write_pdu(301, 78))).empty());
  EXPECT_EQ(standard.word(301), 78);
}

TEST(Id286proAddress, Register298CountsWhenAllSwitchesAreOffAndAfterARestart) {
  RtuBench by_switches(Id286proOptions{});
  EXPECT_EQ(by_switches.write(298, 9), 0);
  by_switches.line().restart(0, by_switches.now);
  by_switches.pass(std::chrono::seconds(2));
  EXPECT_EQ(by_switches.read(301, 1, 1).size(), 1U);
  Id286proOptions options;
  options.switches_off = true;
  RtuBench by_register(options);
  EXPECT_EQ(by_register.write(298, 9), 0);
  EXPECT_EQ(by_register.read(301, 1, 1).size(), 1U);
  by_register.line().restart(0, by_register.now);
  by_register.pass(std::chrono::seconds(2));
  EXPECT_TRUE(by_register.read(301, 1, 1).empty());
  EXPECT_EQ(by_register.read(301, 1, 9).size(), 1U);
}

}  // namespace
}  // namespace axisgate::simulated
