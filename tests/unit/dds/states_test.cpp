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

// A fault, its code and the drive's own word are one sample: nobody has to guess which of the next ones belongs to it.
TEST(DdsStates, ShowAFaultWithItsCauseInOneSample) {
  constexpr std::uint16_t kFault = 1U << 3, kSupplyTooHigh = 0x0020, kFollowingError = 0x0200;
  DdsRig rig;
  const auto writer = rig.writer(1);
  for (const std::uint16_t cause : {kSupplyTooHigh, kFollowingError, kSupplyTooHigh}) {
    rig.samples.clear();
    rig.stage.drive(0).inject_fault(1, cause);
    rig.stage.drive(0).clear_fault_cause(1, cause);
    ASSERT_TRUE(rig.run_until([&] { return (rig.state().statusword & kFault) != 0; }));
    EXPECT_EQ(rig.state().error_code, cause == kSupplyTooHigh ? 0x3210 : 0x8611);
    EXPECT_EQ(rig.state().vendor_error, cause);
    ASSERT_EQ(rig.ask(writer, 5).result, kDone);
    ASSERT_TRUE(rig.run_until([&] { return rig.state().vendor_error == 0; }));
    bool faulted = false;
    for (const dds::StateRecord& sample : rig.samples) {
      if (sample.axis != kServo || (sample.statusword & kFault) == 0) continue;
      faulted = true;
      EXPECT_EQ(sample.error_code, cause == kSupplyTooHigh ? 0x3210 : 0x8611);
      EXPECT_EQ(sample.vendor_error, cause);
    }
    EXPECT_TRUE(faulted);
  }
}

}  // namespace
}  // namespace axisgate::test
