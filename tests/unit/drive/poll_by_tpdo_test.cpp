// SPDX-License-Identifier: Apache-2.0
// What the poll plan makes of values that come by TPDO.
#include <gtest/gtest.h>

#include "gateway/drive/device/poll_plan.hpp"
#include "tests/unit/drive/alone.hpp"

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;

/// One object of class fast (20 ms).
model::DriveModel one_value() {
  model::DriveModel model;
  model.objects.resize(1);
  model.axes.resize(1);
  model::Binding binding;
  binding.object = 0;
  binding.poll = model::PollClass::fast;
  model.axes[0].bindings.push_back(binding);
  return model;
}

TEST(PollByTpdo, AValueThatKeepsComingIsNotAskedFor) {
  const model::DriveModel model = one_value();
  PollPlan plan(model);
  plan.restart(kStart);
  plan.map(0, 100ms, 1s);
  for (Instant now = kStart; now < kStart + 10s; now += 100ms) {
    plan.received(0, now);
    EXPECT_GT(plan.next_due(), now + 100ms);
  }
}

TEST(PollByTpdo, WithoutAnEventTimerItIsReadOnceInConfirm) {
  const model::DriveModel model = one_value();
  PollPlan plan(model);
  plan.restart(kStart);
  plan.map(0, std::nullopt, 1s);
  plan.done(0, kStart);
  EXPECT_EQ(plan.next_due(), kStart + 1s);
  plan.received(0, kStart + 400ms);
  EXPECT_EQ(plan.next_due(), kStart + 1400ms);
  plan.done(0, kStart + 1400ms);
  EXPECT_EQ(plan.next_due(), kStart + 2400ms);
}

TEST(PollByTpdo, ASilenceMayBeShortenedForAWhile) {
  const model::DriveModel model = one_value();
  PollPlan plan(model);
  plan.restart(kStart);
  plan.map(0, std::nullopt, 1s);
  plan.received(0, kStart);
  plan.confirm_within(0, 250ms, kStart + 100ms);
  EXPECT_EQ(plan.next_due(), kStart + 350ms);
  plan.received(0, kStart + 200ms);
  EXPECT_EQ(plan.next_due(), kStart + 450ms);
  plan.done(0, kStart + 450ms);
  EXPECT_EQ(plan.next_due(), kStart + 700ms);
  plan.confirm_within(0, 250ms, kStart + 690ms);
  EXPECT_EQ(plan.next_due(), kStart + 700ms) << "it is so already";
  plan.confirm_within(0, std::nullopt, kStart + 690ms);
  plan.done(0, kStart + 700ms);
  EXPECT_EQ(plan.next_due(), kStart + 1700ms);
}

TEST(PollByTpdo, WithAnEventTimerThreeMissedOnesBringThePollBack) {
  const model::DriveModel model = one_value();
  PollPlan plan(model);
  plan.restart(kStart);
  plan.map(0, 100ms, 1s);
  plan.received(0, kStart);
  EXPECT_EQ(plan.next_due(), kStart + 300ms);
  plan.done(0, kStart + 300ms);
  EXPECT_EQ(plan.next_due(), kStart + 320ms) << "in its own beat, as long as nothing comes";
  plan.received(0, kStart + 310ms);
  EXPECT_EQ(plan.next_due(), kStart + 610ms);
}

TEST(PollByTpdo, OneThatStopsComingForGoodIsPolledAsIfItNeverHad) {
  const model::DriveModel model = one_value();
  PollPlan plan(model);
  plan.restart(kStart);
  plan.map(0, std::nullopt, 1s);
  plan.received(0, kStart);
  plan.unmap_all(kStart + 10ms);
  EXPECT_EQ(plan.next_due(), kStart + 10ms);
  plan.done(0, kStart + 10ms);
  EXPECT_EQ(plan.next_due(), kStart + 30ms);
  plan.received(0, kStart + 20ms);
  EXPECT_EQ(plan.next_due(), kStart + 30ms) << "what is not mapped does not count";
}

TEST(PollByTpdo, WhatTheDriveDoesNotHaveStaysDropped) {
  const model::DriveModel model = one_value();
  PollPlan plan(model);
  plan.restart(kStart);
  plan.map(0, std::nullopt, 1s);
  plan.drop(0);
  plan.received(0, kStart);
  plan.hurry(0, kStart);
  plan.unmap_all(kStart);
  EXPECT_EQ(plan.next_due(), kNever);
}

}  // namespace
}  // namespace axisgate::drive
