// SPDX-License-Identifier: Apache-2.0
// Stops of several clients at once, of a drive whose gate is the gateway's: whatever their order, none undoes another.
#include <gmock/gmock.h>

#include "tests/stage_drive/stepper_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

WriteBatch from(ClientId client, Command command) {
  WriteBatch batch = with_command(command);
  batch.client = client;
  return batch;
}

TEST(RtuStops, AHaltBesideADisableOrAQuickStopNeverEnables) {
  for (const Command other : {Command::disable, Command::quick_stop}) {
    for (const bool halt_first : {true, false}) {
      for (const bool moving : {true, false}) {
        StepperRig rig;
        rig.online();
        rig.enable();
        if (moving) rig.run_at(300'000);
        const Command first = halt_first ? Command::halt : other;
        const auto one = rig.stage.begin(1, from(5, first));
        const auto two = rig.stage.begin(1, from(6, halt_first ? other : Command::halt));
        ASSERT_TRUE(rig.stage.run_until([&] { return one->has_value() && two->has_value(); }));
        const auto enabled = [&] { return rig.axis().has(AxisInput::enabled); };
        EXPECT_FALSE(enabled()) << text(other) << (halt_first ? " after" : " before") << " a halt";
        EXPECT_FALSE(rig.stage.run_until(enabled, 2s));
        EXPECT_TRUE(rig.stands());
      }
    }
  }
}

}  // namespace
}  // namespace axisgate::test
