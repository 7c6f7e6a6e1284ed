// SPDX-License-Identifier: Apache-2.0
#include "gateway/config/bus_budget.hpp"

#include <gmock/gmock.h>

#include "gateway/config/config_sections.hpp"

namespace axisgate::config {
namespace {

using model::PollClass;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A drive of one axis with as many objects in each class.
model::DriveModel model_with(int fast, int normal, int slow, int once = 0) {
  model::DriveModel model;
  model::AxisModel axis;
  axis.binding_of.fill(-1);
  const auto add = [&](int count, PollClass poll) {
    for (int i = 0; i < count; ++i) {
      model::Binding binding;
      binding.quantity = static_cast<Quantity>(axis.bindings.size());
      binding.object = static_cast<model::ObjectId>(model.objects.size());
      binding.poll = poll;
      axis.binding_of[axis.bindings.size()] = static_cast<std::int16_t>(axis.bindings.size());
      axis.bindings.push_back(binding);
      model.objects.push_back({});
    }
  };
  add(fast, PollClass::fast);
  add(normal, PollClass::normal);
  add(slow, PollClass::slow);
  add(once, PollClass::once);
  model.axes.push_back(axis);
  return model;
}

BusTiming kinco_timing() {
  return {microseconds(5208),
          Duration{},
          milliseconds(10),
          milliseconds(100),
          {milliseconds(100), milliseconds(500), milliseconds(5000)}};
}

TEST(BusBudget, AddsUpWhatThePollsTakeOfTheLine) {
  const BusBudget budget = plan_bus(kinco_timing(), {model_with(3, 5, 10)});
  EXPECT_EQ(budget.classes[0].reads, 3);
  EXPECT_EQ(budget.classes[1].reads, 5);
  EXPECT_EQ(budget.classes[2].reads, 10);
  // 30 + 10 + 2 = 42 exchanges a second of 5.208 ms, or of 10.208 ms.
  EXPECT_EQ(budget.load_on_wire, 219);
  EXPECT_EQ(budget.load_answered, 429);
  EXPECT_FALSE(budget.overloaded());
  EXPECT_EQ(budget.cycle, milliseconds(100));
}

TEST(BusBudget, CountsAllDrivesOfTheBus) {
  const BusBudget one = plan_bus(kinco_timing(), {model_with(2, 0, 0)});
  const BusBudget two = plan_bus(kinco_timing(), {model_with(2, 0, 0), model_with(2, 0, 0)});
  EXPECT_EQ(two.classes[0].reads, 2 * one.classes[0].reads);
  EXPECT_EQ(two.load_answered, 409);  // 40 exchanges a second of 10.208 ms, rounded up
}

TEST(BusBudget, LeavesOutWhatIsReadOnceOnly) {
  EXPECT_EQ(plan_bus(kinco_timing(), {model_with(0, 0, 0, 20)}).load_answered, 0);
}

TEST(BusBudget, AGapIsTimeOfTheLineToo) {
  BusTiming timing = kinco_timing();
  timing.min_gap = milliseconds(2);
  const BusBudget budget = plan_bus(timing, {model_with(1, 0, 0)});
  EXPECT_EQ(budget.load_on_wire, 73);  // 10 exchanges a second of 7.208 ms
  EXPECT_EQ(budget.stop_wait, microseconds(12208));
}

TEST(BusBudget, WaitsAreCountedInExchanges) {
  const BusBudget budget = plan_bus(kinco_timing(), {model_with(1, 1, 1)});
  EXPECT_EQ(budget.exchange, microseconds(10208));
  EXPECT_EQ(budget.stop_wait, microseconds(10208));
  EXPECT_EQ(budget.command_wait, microseconds(20416));
  EXPECT_EQ(budget.stop_wait_unresponsive, milliseconds(110));
  EXPECT_EQ(budget.command_wait_unresponsive, microseconds(120208));
}

TEST(BusBudget, AnOverloadedBusStretchesItsCycleAndNamesPeriodsThatFit) {
  BusTiming timing = kinco_timing();
  timing.poll = {milliseconds(20), milliseconds(100), milliseconds(1000)};
  const std::vector<model::DriveModel> drives{model_with(3, 6, 10)};
  const BusBudget budget = plan_bus(timing, drives);
  EXPECT_TRUE(budget.overloaded());
  EXPECT_EQ(budget.load_answered, 2246);  // 150 + 60 + 10 exchanges a second
  EXPECT_EQ(budget.cycle, microseconds(44920));

  timing.poll = comfortable_periods(budget);
  EXPECT_EQ(timing.poll[0], milliseconds(60));
  const BusBudget mended = plan_bus(timing, drives);
  EXPECT_LE(mended.load_answered, kComfortablePermille);
}

TEST(BusBudget, PeriodsThatFitAreLeftAsTheyAre) {
  const BusBudget budget = plan_bus(kinco_timing(), {model_with(1, 1, 1)});
  EXPECT_EQ(comfortable_periods(budget), kinco_timing().poll);
}

TEST(BusBudget, PeriodsThatFitLeaveThePollsSomethingWhereConfirmingTakesTheLine) {
  BusBudget budget = plan_bus(kinco_timing(), {model_with(1, 0, 0)});
  budget.confirmed.period = milliseconds(1000);
  budget.confirmed.answered = milliseconds(900);
  budget.load_answered = 1500;
  EXPECT_EQ(comfortable_periods(budget)[0], milliseconds(1200)) << "twelve times as long";
}

TEST(BusBudget, OfTwoKeepAlivesTheOneThatIsDueMoreOftenIsPlannedWith) {
  const auto kept = [](Duration every) {
    model::DriveModel model = model_with(1, 0, 0);
    model.keep_alive = every;
    model.axes[0].keep_alive.emplace_back(3, 0);
    return model;
  };
  for (const auto& [one, other] : {std::pair(200, 300), std::pair(300, 200)})
    EXPECT_EQ(plan_bus(kinco_timing(), {kept(milliseconds(one)), kept(milliseconds(other))}).kept_alive.period,
              milliseconds(200));
}

TEST(Timeout, IsTheSlowestDrivesBehindTheWiresTimeAndNoneIsAsShortAsThat) {
  BusConfig bus;
  bus.timeout = {};
  std::vector<model::DriveModel> drives(2);
  drives[0].timeout = milliseconds(40);
  drives[1].timeout = milliseconds(20);
  ConfigFaults faults("gateway.json");
  const auto settle = [&] { settle_timeout(bus, drives, milliseconds(5), "an exchange", faults); };
  settle();
  EXPECT_EQ(bus.timeout, milliseconds(45));
  bus.timeout = milliseconds(6);
  settle();
  EXPECT_THAT(faults.faults(), IsEmpty());
  bus.timeout = milliseconds(5);
  settle();
  EXPECT_THAT(faults.faults(), SizeIs(1));
}

TEST(BusBudget, ExactlyFullIsNotOverloaded) {
  BusTiming timing = kinco_timing();
  timing.on_wire = milliseconds(5);
  timing.poll.fill(milliseconds(10));
  const BusBudget full = plan_bus(timing, {model_with(1, 0, 0)});
  EXPECT_EQ(full.load_answered, 1000);
  EXPECT_FALSE(full.overloaded());
  timing.min_gap = microseconds(1);
  EXPECT_TRUE(plan_bus(timing, {model_with(1, 0, 0)}).overloaded());
}

}  // namespace
}  // namespace axisgate::config
