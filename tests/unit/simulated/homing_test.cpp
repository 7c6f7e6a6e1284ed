// The homing methods of 6098 on simulated switches (JD 6.5, MD 8.5), each from every side.
#include <gtest/gtest.h>

#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {
namespace {

// Limits at -50000 and 50000, home switch from 10000 to 14000, index pulses each 10000 from 2000.
DriveOptions machine() {
  DriveOptions options = a_drive(KincoType::jd);
  options.mechanics.negative_limit = -50000;
  options.mechanics.positive_limit = 50000;
  options.mechanics.home_from = 10000;
  options.mechanics.home_to = 14000;
  options.mechanics.negative_stop = -60000;
  options.mechanics.positive_stop = 60000;
  options.mechanics.index_offset = 2000;
  return options;
}

void move_to(Bench& bench, std::int64_t place) {
  bench.write(0x6060, 0, 1);
  bench.control(0x0F);
  bench.write(0x6081, 0, speed_dec(1000, 10000));
  bench.write(0x607A, 0, place);
  bench.control(0x2F);
  bench.control(0x3F);
  ASSERT_TRUE(bench.wait_for(0x0400));
  bench.control(0x0F);
}

// Where the reference was found, in counts of the machine; nothing on failure.
std::optional<std::int64_t> home(Bench& bench, int method, std::int64_t from) {
  move_to(bench, from);
  bench.write(0x6060, 0, 6);
  bench.write(0x6098, 0, method);
  bench.write(0x6099, 1, speed_dec(200, 10000));
  bench.write(0x6099, 2, speed_dec(20, 10000));
  bench.control(0x1F);
  bench.pass(milliseconds(2));
  for (int ms = 0; ms < 120000; ms += 5, bench.pass(milliseconds(5))) {
    const std::uint16_t word = bench.status();
    if ((word & 0x2000) != 0) return std::nullopt;
    if ((word & 0x8000) != 0) {
      EXPECT_EQ(bench.read(0x6063), 0);
      return counts_of(bench.drive().axis().physical());
    }
  }
  return std::nullopt;
}

struct Expectation {
  int method;
  std::int64_t reference;
  std::vector<std::int64_t> starts;
};

class Homing : public testing::TestWithParam<Expectation> {};

TEST_P(Homing, FindsItsReferenceFromEveryStart) {
  for (const std::int64_t start : GetParam().starts) {
    Bench bench(machine());
    const auto found = home(bench, GetParam().method, start);
    ASSERT_TRUE(found.has_value()) << "from " << start;
    // Switches are seen at millisecond steps: 20 rpm are 3.4 counts each. Index pulses are exact.
    EXPECT_NEAR(static_cast<double>(*found), static_cast<double>(GetParam().reference), 5) << "from " << start;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Homing,
                         testing::Values(Expectation{1, -48000, {0, 20000}}, Expectation{2, 42000, {0, 20000}},
                                         Expectation{17, -50000, {0, 12000}}, Expectation{18, 50000, {0, 12000}},
                                         Expectation{3, 2000, {0, 12000}}, Expectation{19, 10000, {0, 12000}},
                                         Expectation{4, 12000, {0, 12000}}, Expectation{20, 10000, {0, 12000}},
                                         Expectation{21, 14000, {20000, 12000}}, Expectation{22, 14000, {20000, 12000}},
                                         Expectation{7, 2000, {0, 12000, 20000}},
                                         Expectation{23, 10000, {0, 12000, 20000}}, Expectation{24, 10000, {0, 12000}},
                                         Expectation{25, 14000, {0, 12000}}, Expectation{26, 14000, {0, 12000, 20000}},
                                         Expectation{27, 14000, {20000, 12000, 0}},
                                         Expectation{28, 14000, {20000, 12000}}, Expectation{29, 10000, {20000, 12000}},
                                         Expectation{30, 10000, {20000, 12000, 0}},
                                         Expectation{10, 22000, {0, 12000, 20000}},
                                         Expectation{14, 2000, {20000, 12000, 0}}, Expectation{33, 2000, {5000}},
                                         Expectation{34, 12000, {5000}}, Expectation{35, 5000, {5000}},
                                         Expectation{-17, -60000, {0}}, Expectation{-18, 60000, {0}}),
                         [](const auto& expectation) {
                           const int method = expectation.param.method;
                           return method < 0 ? "minus" + std::to_string(-method) : std::to_string(method);
                         });

TEST(HomingFailure, AReservedMethodSetsBit13AtOnce) {
  for (const int method : {0, 15, 16, 31, 32, 36}) {
    Bench bench(machine());
    EXPECT_FALSE(home(bench, method, 100).has_value()) << method;
    EXPECT_EQ(bench.status() & 0xA000, 0x2000);
  }
}

TEST(HomingFailure, WithoutAHomeSwitchBothLimitsEndTheSearch) {
  DriveOptions options = machine();
  options.mechanics.home_from.reset();
  options.mechanics.home_to.reset();
  Bench bench(options);
  EXPECT_FALSE(home(bench, 23, 0).has_value());
  Bench other(options);
  EXPECT_FALSE(home(other, 19, 0).has_value());
}

TEST(HomingFailure, GoesWithTheNextHoming) {
  Bench bench(machine());
  EXPECT_FALSE(home(bench, 15, 0).has_value());
  bench.control(0x0F);
  bench.write(0x6098, 0, 35);
  bench.control(0x1F);
  ASSERT_TRUE(bench.wait_for(0x8000));
  EXPECT_EQ(bench.status() & 0x2000, 0);
}

TEST(HomingOffset, OfAnMdRunsToTheOffsetOrReadsIt) {
  for (const int mode : {0, 1}) {
    Bench bench(a_drive(KincoType::md));
    bench.write(0x6060, 0, 6);
    bench.write(0x6098, 0, 35);
    bench.write(0x607C, 0, 3000);
    bench.write(0x6099, 0x05, mode);
    bench.control(0x0F);
    bench.control(0x1F);
    ASSERT_TRUE(bench.wait_for(0x8000));
    EXPECT_EQ(bench.read(0x6063), mode == 0 ? 0 : -3000);
    EXPECT_EQ(counts_of(bench.drive().axis().physical()), mode == 0 ? 3000 : 0);
  }
}

TEST(HomingAbort, TakingTheStartBitAwayStopsIt) {
  Bench bench(machine());
  bench.write(0x6060, 0, 6);
  bench.write(0x6098, 0, 17);
  bench.control(0x0F);
  bench.control(0x1F);
  bench.pass(milliseconds(200));
  bench.control(0x0F);
  bench.pass(std::chrono::seconds(5));
  EXPECT_EQ(bench.status() & 0xA000, 0);
  EXPECT_EQ(bench.read(0x60F9, 0x19), 0);
}

}  // namespace
}  // namespace axisgate::simulated
