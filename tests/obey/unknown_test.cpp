// SPDX-License-Identifier: Apache-2.0
// 3.2 Unknown: what is out of sight is unknown, not "disabled, standing": a motor whose cable is cut may be running.
#include <gtest/gtest.h>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kUnknownState = 7;
constexpr std::uint8_t kNotSent = 0x0A;

class Unknown : public testing::TestWithParam<Subject> {
 protected:
  Unknown() { b_.be(Role::engineer, 5); }
  /// Owned by a, disabled, and then out of sight.
  void lost_while_disabled() {
    plant_.ready_but_disabled();
    ASSERT_EQ(a_.command(kDisable), kOk);
    ASSERT_EQ(plant_.set_endless(a_), kOk);
    ASSERT_EQ(a_.word(shown::owner), kMe);
    b_.disconnect();
    b_.connect();
    plant_.unplug();
    plant_.run(100ms);
  }
  Plant plant_{GetParam(), with_leases()};
  Client& a_ = plant_.a;
  Client& b_ = plant_.b;
};

TEST_P(Unknown, IsShownUntilTheDriveIsSeenAgain) {
  plant_.ready();
  ASSERT_NE(a_.word(shown::axis_state), kUnknownState);
  plant_.unplug();
  plant_.run(500ms);
  EXPECT_EQ(a_.word(shown::axis_state), kUnknownState);
  EXPECT_EQ(a_.word(shown::statusword), 0);
  plant_.plug();
  plant_.run(10s);
  EXPECT_NE(a_.word(shown::axis_state), kUnknownState);
  plant_.crash_gateway();
  plant_.cut_wire();
  plant_.start_gateway();
  a_.connect();
  plant_.run(1s);
  EXPECT_EQ(a_.word(shown::axis_state), kUnknownState) << "never seen";
}

TEST_P(Unknown, IsTakenOverAfterAHaltAlone) {
  lost_while_disabled();
  EXPECT_EQ(b_.command(kTakeOver), kNotSent);
  EXPECT_EQ(b_.word(shown::owner), kAnother);
}

TEST_P(Unknown, IsNotReleasedWithoutALeaseThatRunsOut) {
  lost_while_disabled();
  EXPECT_EQ(a_.command(kRelease), kOk);
  EXPECT_EQ(a_.word(shown::owner), kNobody);
  EXPECT_GT(a_.word(shown::lease_remaining), 0);
  plant_.run(3s);
  EXPECT_TRUE(plant_.logged("nobody has taken over"));
}

INSTANTIATE_TEST_SUITE_P(Every, Unknown, testing::ValuesIn(kSubjects), named);

}  // namespace
}  // namespace axisgate::test::obey
