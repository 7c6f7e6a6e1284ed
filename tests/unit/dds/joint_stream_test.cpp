// SPDX-License-Identifier: Apache-2.0
// Which targets of a ROS 2 stream are asked of an axis.
#include "gateway/upstream/dds/joint_stream.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/dds/samples.hpp"

namespace axisgate::dds {
namespace {

constexpr ClientId kMe = 7, kAnother = 8;

class Stream : public ::testing::Test {
 protected:
  Stream() {
    axis.ready = true;
    axis.position = 5;
    axis.tolerance = 0.01;
    axis.client = kMe;
  }

  /// Positions in units of which a thousand are one.
  std::optional<JointTarget> at(double position, std::uint8_t writer = 1) {
    return stream.on_sample(test::guid(writer), {false, static_cast<std::int64_t>(position * 1000)}, position, axis);
  }
  std::optional<JointTarget> runs(std::int64_t velocity) {
    return stream.on_sample(test::guid(1), {true, velocity}, 0, axis);
  }
  std::optional<JointTarget> ends(Errc code = Errc::ok) { return stream.on_result(code, axis); }
  void in_step() {
    ASSERT_TRUE(at(5));
    ASSERT_FALSE(ends());
  }

  JointView axis;
  JointStream stream;
};

TEST_F(Stream, ThatStartsWithZeroMovesNothing) {
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(at(0));
}

TEST_F(Stream, ActsOnceItWasWhereTheAxisIs) {
  EXPECT_FALSE(at(0));
  EXPECT_FALSE(at(4.98));
  EXPECT_EQ(at(4.995), (JointTarget{false, 4995}));
  EXPECT_FALSE(ends());
  EXPECT_EQ(at(9), (JointTarget{false, 9000}));
}

TEST_F(Stream, ActsOnNothingWhileNobodyKnowsWhereTheAxisIs) {
  axis.position = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(at(5));
}

TEST_F(Stream, IsToldOnceThatItIsAstray) {
  EXPECT_FALSE(at(0));
  EXPECT_TRUE(stream.take_astray());
  EXPECT_FALSE(at(0.5));
  EXPECT_FALSE(stream.take_astray());
  in_step();
  EXPECT_FALSE(stream.take_astray());
  axis.record.stopped(kAnother);
  EXPECT_FALSE(at(0));
  EXPECT_TRUE(stream.take_astray());
}

TEST_F(Stream, IsNotAstrayWhileItsAxisIsDisabled) {
  axis.ready = false;
  EXPECT_FALSE(at(0));
  EXPECT_FALSE(stream.take_astray());
}

TEST_F(Stream, RepeatsNothing) {
  in_step();
  EXPECT_TRUE(at(6));
  EXPECT_FALSE(ends());
  EXPECT_FALSE(at(6));
  EXPECT_TRUE(at(6.5));
}

TEST_F(Stream, LetsTheNewestWinAndOneWait) {
  in_step();
  EXPECT_TRUE(at(6));
  EXPECT_FALSE(at(7));
  EXPECT_FALSE(at(8));
  EXPECT_EQ(ends(), (JointTarget{false, 8000}));
  EXPECT_FALSE(ends());
}

TEST_F(Stream, AsksForNothingMoreWhereTheNewestIsWhatWasAsked) {
  in_step();
  EXPECT_TRUE(at(6));
  EXPECT_FALSE(at(7));
  EXPECT_FALSE(at(6));
  EXPECT_FALSE(ends());
}

TEST_F(Stream, MustBeSeenAtTheAxisAgainAfterAnythingThatEndsMotions) {
  const auto each = [&](auto&& ends_it) {
    axis.position = 5;
    stream = JointStream();
    in_step();
    ASSERT_TRUE(at(6));
    ASSERT_FALSE(ends());
    ends_it();
    EXPECT_FALSE(at(7));
    axis.ready = true;
    EXPECT_FALSE(at(7));
    axis.position = 6.5;
    EXPECT_TRUE(at(6.5));
    ASSERT_FALSE(ends());
    EXPECT_TRUE(at(7));
  };
  each([&] { axis.record.stopped(kMe); });
  each([&] { axis.record.stopped(kAnother); });
  each([&] { axis.record.stopped(0); });  // a lease
  each([&] { axis.record.faulted(); });
  each([&] { axis.record.lost(); });
  each([&] { axis.record.commanded(kAnother, axis.record.accepted()); });
  each([&] { axis.ready = false; });
  each([&] { stream.restart(); });
}

TEST_F(Stream, GoesOnBesideItsOwnCommands) {
  in_step();
  axis.record.commanded(kMe, axis.record.accepted());
  EXPECT_TRUE(at(7));
}

TEST_F(Stream, OfAnotherWriterBeginsAnew) {
  in_step();
  EXPECT_FALSE(at(7, 2));
  EXPECT_TRUE(at(5, 2));
}

TEST_F(Stream, DropsWhatWaitsWhenTheAxisIsStopped) {
  in_step();
  EXPECT_TRUE(at(6));
  EXPECT_FALSE(at(7));
  axis.record.stopped(kAnother);
  EXPECT_FALSE(ends(Errc::stopped_by_other));
}

TEST_F(Stream, DoesNotRepeatWhatTheAxisCannotDo) {
  in_step();
  EXPECT_TRUE(at(600));
  EXPECT_FALSE(ends(Errc::bad_value));
  EXPECT_FALSE(at(600));
  EXPECT_TRUE(at(6));
}

TEST_F(Stream, MustBeSeenAtTheAxisAgainWhereAnotherOwnsIt) {
  in_step();
  EXPECT_TRUE(at(6));
  EXPECT_FALSE(ends(Errc::not_owner));
  EXPECT_FALSE(at(7));
  EXPECT_TRUE(at(5));
}

TEST_F(Stream, AsksAgainForWhatHadNoRoom) {
  in_step();
  EXPECT_TRUE(at(6));
  EXPECT_FALSE(ends(Errc::queue_full));
  EXPECT_TRUE(at(6));
}

TEST_F(Stream, OfVelocitiesActsOnceItWasZero) {
  EXPECT_FALSE(runs(300));
  EXPECT_EQ(runs(0), (JointTarget{true, 0}));
  EXPECT_FALSE(ends());
  EXPECT_EQ(runs(300), (JointTarget{true, 300}));
  EXPECT_FALSE(ends());
  axis.record.stopped(kAnother);
  EXPECT_FALSE(runs(300));
}

TEST_F(Stream, ThatGoesBackToPositionsMustBeSeenAtTheAxis) {
  in_step();
  EXPECT_TRUE(runs(0));
  EXPECT_FALSE(ends());
  EXPECT_TRUE(runs(300));
  EXPECT_FALSE(ends());
  axis.position = 1000;
  EXPECT_FALSE(at(5));
  EXPECT_TRUE(at(1000));
}

}  // namespace
}  // namespace axisgate::dds
