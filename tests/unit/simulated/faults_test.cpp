// SPDX-License-Identifier: Apache-2.0
// The fault switches: their names, and that the same seed gives the same run. What each of them does:
// scripts/faults.txt.
#include <set>

#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {
namespace {

// All that arrives in a minute with all faults at once.
std::vector<Bench::Arrival> minute(const char* line, std::uint64_t seed) {
  Bench bench(line, untimed(), seed);
  for (std::size_t i = 0; i < drive_fault_count; ++i) {
    const auto fault = static_cast<DriveFault>(i);
    bench.faults().set_rate(fault, fault == DriveFault::restart ? 0.002 : 0.05);
  }
  const std::map<std::string, Bytes> questions{
      {"jd", ten_bytes(FrameCommand::read, {0x6041, 0})},
      {"rtu:jd", seal_rtu(1, read_pdu(0x3200, 1))},
      {"keya-rs232", from_hex("ED 07 00 00 00 00 00 00 00 00 00 00")},
  };
  for (int i = 0; i < 3000; ++i) {
    if (bench.port.can != nullptr) bench.send(bus_frame(cob::sdo_request + 1, sdo_request(0x40, {0x6041, 0})));
    if (bench.port.can == nullptr) bench.line().from_host(questions.at(line), bench.now);
    bench.pass(milliseconds(20));
  }
  return bench.arrivals;
}

TEST(faults, the_same_seed_gives_the_same_run) {
  for (const char* line : {"jd", "rtu:jd", "keya-rs232", "can:ld2"}) {
    const auto run = minute(line, 7);
    EXPECT_EQ(minute(line, 7), run) << line;
    EXPECT_NE(minute(line, 8), run) << line;
  }
}

TEST(faults, each_has_a_name_that_is_found_again) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < drive_fault_count; ++i) {
    const auto fault = static_cast<DriveFault>(i);
    names.insert(name_of(fault));
    EXPECT_EQ(drive_fault_named(name_of(fault)), fault);
  }
  EXPECT_EQ(names.size(), drive_fault_count);
  EXPECT_EQ(drive_fault_named("deaf"), std::nullopt);
}

// Seeds in logs and scripts stand for the same faults on every machine.
TEST(faults, the_generator_gives_these_numbers_everywhere) {
  EXPECT_EQ(Random(1).next(), 0xB3F2AF6D0FC710C5U);
  EXPECT_EQ(Random(1).below(1000), 0xB3F2AF6D0FC710C5U % 1000);
}

// No read reply, which a gateway could take for one.
TEST(faults, a_babbling_rtu_drive_sends_whole_frames_too) {
  Bench bench("rtu:jd");
  bench.faults().set_rate(DriveFault::babble, 1);
  bench.pass(seconds(2));
  int frames = 0;
  for (const auto& arrival : bench.arrivals) {
    const auto frame = open_rtu(arrival.bytes);
    if (!frame) continue;
    EXPECT_EQ(frame->pdu[0], function::write_one);
    ++frames;
  }
  EXPECT_NEAR(frames, 100, 50);
}

}  // namespace
}  // namespace axisgate::simulated
