// SPDX-License-Identifier: Apache-2.0
// A drive at the end on purpose: what is asked of it, what is told, and who is called.
#include "gateway/drive/device/drive_end.hpp"

#include <gtest/gtest.h>

namespace axisgate::drive {
namespace {

/// One motor and one entry that makes its drive miss the gateway, as the setup list has it.
struct Ending {
  model::DriveModel model = [] {
    model::DriveModel out;
    out.objects.resize(2);
    out.objects[0].address = {0x6041, 0};
    out.objects[1].address = {0x1016, 1};
    for (model::ObjectDef& object : out.objects) object.size = 2;
    model::AxisModel axis;
    axis.statusword = 0;
    axis.state_sources = {0};
    out.axes.push_back(axis);
    out.setup = {{1, 500, ""}};
    out.loss_objects = {1};
    return out;
  }();
  ObjectStore store{model.objects};
  DriveEnd end{model};
  int called = 0;

  bool begin(Closing why, Known known = Known::whole) {
    store.read(0, 0x250, {});
    store.read(1, 500, {});
    return end.begin(why, known, store, [this] { ++called; });
  }
  /// Each request is answered as a drive with a motor without torque does; what was written.
  std::vector<std::int64_t> play() {
    std::vector<std::int64_t> written;
    for (auto next = end.next(); next && written.size() < 10; next = end.next()) {
      if (next->write) written.push_back(next->number);
      if (!next->write) store.read(next->object, 0x250, {});
      end.on_result({}, true, store);
    }
    return written;
  }
};

TEST(DriveEnd, ADriveOfWhichNothingIsKnownIsAskedNothingAndToldOf) {
  Ending it;
  EXPECT_FALSE(it.begin(Closing::gateway_ends, Known::nothing));
  EXPECT_TRUE(it.end.begun());
  EXPECT_FALSE(it.end.next());
  EXPECT_EQ(it.end.outcome(), Disarming::Outcome::unknown);
  EXPECT_NE(it.end.event_text(), "");
}

// It is to be taken away if no motor has torque: that nobody can tell of a drive in its bring-up.
TEST(DriveEnd, OneThatIsBroughtUpIsDisarmedAndNotLookedAt) {
  Ending look;
  EXPECT_FALSE(look.begin(Closing::look, Known::in_part));
  EXPECT_EQ(look.end.outcome(), Disarming::Outcome::unknown);
  Ending it;
  EXPECT_TRUE(it.begin(Closing::gateway_ends, Known::in_part));
}

TEST(DriveEnd, WhatTheLogSaysIsTheEndOfTheGatewayAlone) {
  for (const Closing why : {Closing::gateway_ends, Closing::taken_away}) {
    Ending it;
    ASSERT_TRUE(it.begin(why));
    EXPECT_EQ(it.play(), std::vector<std::int64_t>{0});
    EXPECT_EQ(it.end.outcome(), Disarming::Outcome::disarmed);
    EXPECT_EQ(it.end.event_text().empty(), why == Closing::taken_away) << it.end.event_text();
  }
}

TEST(DriveEnd, ALookWritesNothingAndLeavesNothingToPutBack) {
  Ending it;
  ASSERT_TRUE(it.begin(Closing::look));
  EXPECT_TRUE(it.play().empty());
  EXPECT_EQ(it.end.outcome(), Disarming::Outcome::disabled);
  EXPECT_FALSE(it.end.take_back());
  EXPECT_FALSE(it.end.begun());
}

TEST(DriveEnd, WhoWasToBeTakenAwayAndStaysMayHaveLostItsWatch) {
  Ending it;
  ASSERT_TRUE(it.begin(Closing::taken_away));
  it.play();
  EXPECT_TRUE(it.end.take_back());
  EXPECT_FALSE(it.end.take_closed()) << "nobody waits for its end any more";
}

TEST(DriveEnd, ItsEndIsToldOnce) {
  Ending it;
  EXPECT_FALSE(it.end.take_closed());
  ASSERT_TRUE(it.begin(Closing::gateway_ends));
  const auto closed = it.end.take_closed();
  ASSERT_TRUE(closed);
  closed();
  EXPECT_EQ(it.called, 1);
  EXPECT_FALSE(it.end.take_closed());
}

}  // namespace
}  // namespace axisgate::drive
