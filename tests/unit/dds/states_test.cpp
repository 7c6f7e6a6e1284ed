// SPDX-License-Identifier: Apache-2.0
// What a subscriber sees of motors that really move.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/unit/dds/dds_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

// A reload takes an axis away: its last sample says that nothing is known, and no other follows.
TEST(DdsStates, SayOnceThatAnAxisIsGone) {
  DdsRig rig;
  ASSERT_TRUE(rig.run_until([&] { return rig.axis().reachable(); }));
  rig.take_away(kServo);
  rig.samples.clear();
  rig.run(3s);
  std::erase_if(rig.samples, [](const auto& each) { return each.axis != kServo; });
  ASSERT_EQ(rig.samples.size(), 1U);
  EXPECT_EQ(rig.samples.front().link_state, 0);
  EXPECT_EQ(rig.samples.front().valid, 0U);
}

// A fault is a sample at once, its cause another one: what is not known yet has no number and is not valid.
TEST(DdsStates, ShowAFaultAtOnceAndItsCauseNext) {
  constexpr std::uint16_t kFault = 1U << 3, kSupplyTooHigh = 0x0020, kFollowingError = 0x0200;
  constexpr std::uint32_t kCauses = bit(Quantity::error_code) | bit(Quantity::vendor_error);
  DdsRig rig;
  const auto writer = rig.writer(1);
  // Slower than samples come.
  rig.stage.link(0).line().faults(0).late_by = 30ms;
  rig.stage.link(0).line().faults(0).set_rate(simulated::DriveFault::late, 1);
  for (const std::uint16_t cause : {kSupplyTooHigh, kFollowingError, kSupplyTooHigh}) {
    rig.samples.clear();
    rig.stage.drive(0).inject_fault(1, cause);
    rig.stage.drive(0).clear_fault_cause(1, cause);
    ASSERT_TRUE(rig.run_until([&] { return (rig.state().statusword & kFault) != 0; }));
    ASSERT_TRUE(rig.run_until([&] { return (rig.state().valid & kCauses) == kCauses; }));
    ASSERT_EQ(rig.ask(writer, 5).result, kDone);
    ASSERT_TRUE(rig.run_until([&] { return rig.state().vendor_error == 0; }));
    std::vector<std::uint16_t> codes;
    for (const dds::StateRecord& sample : rig.samples) {
      if (sample.axis != kServo || (sample.statusword & kFault) == 0) continue;
      const bool known = sample.error_code != 0xFFFF;
      EXPECT_EQ((sample.valid & kCauses) != 0, known);
      EXPECT_EQ(sample.vendor_error, known ? cause : 0xFFFFFFFF);
      if (codes.empty() || codes.back() != sample.error_code) codes.push_back(sample.error_code);
    }
    EXPECT_THAT(codes, testing::ElementsAre(0xFFFF, cause == kSupplyTooHigh ? 0x3210 : 0x8611));
  }
}

}  // namespace
}  // namespace axisgate::test
