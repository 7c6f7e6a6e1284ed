// SPDX-License-Identifier: Apache-2.0
// Bring-up (design 7, point 6): state first, a running drive is adopted, and nothing is ever enabled by itself.
#include <gmock/gmock.h>

#include "gateway/drive/device/bring_up.hpp"
#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::DriveFault;
using enum Situation;

TEST(BringUp, ReadsTheStateFirstAndWritesNothing) {
  for (const KincoType type : {KincoType::jd, KincoType::md}) {
    Rig rig(type);
    rig.online();
    ASSERT_FALSE(rig.requests().empty());
    EXPECT_EQ(rig.requests().front().index, kStatusword);
    EXPECT_TRUE(rig.writes().empty());
    EXPECT_TRUE(rig.has_event(EventKind::boot, "online"));
  }
}

TEST(BringUp, ADriveFoundRunningIsAdoptedAndLeftAlone) {
  Rig rig(KincoType::md);
  rig.motor().poke({0x6060, 0}, 3);
  rig.motor().poke({0x60FF, 0}, 900'000);
  rig.motor().poke({0x6040, 0}, 0x0F);
  rig.online();
  rig.stage.run(1s);
  EXPECT_TRUE(rig.writes().empty());
  EXPECT_TRUE(rig.turns());
  EXPECT_NE(rig.axis().alarms & bit(AxisAlarm::adopted_running), 0U);
  EXPECT_EQ(rig.axis().axis_state, AxisState::continuous_motion) << "it moves, whoever began it";
  EXPECT_TRUE(rig.has_event(EventKind::boot, "adopted"));
  ASSERT_EQ(rig.command(Command::disable).outcome.code, Errc::ok);
  rig.stage.run(100ms);
  EXPECT_EQ(rig.axis().alarms & bit(AxisAlarm::adopted_running), 0U);
}

TEST(Restart, InEachSituationNeverEndsEnabledAndForgetsTheHoming) {
  for (const KincoType type : {KincoType::jd, KincoType::md}) {
    for (const Situation from : {disabled, enabled, moving, running, homing, halted, latched, faulted}) {
      SCOPED_TRACE(name(type) + " " + name(from));
      Rig rig(type);
      rig.online();
      if (from == enabled) {
        ASSERT_EQ(rig.command(Command::enable).outcome.code, Errc::ok);
        ASSERT_EQ(rig.command(Command::set_position).outcome.code, Errc::ok);
        EXPECT_TRUE(rig.axis().has(AxisInput::homed));
      } else {
        rig.bring_to(from);
      }
      const bool was_latched = rig.axis().has(AxisInput::stop_latched);
      rig.mark();
      rig.stage.link(0).line().restart(0, rig.stage.link(0).time_of(rig.stage.runtime().now()));
      ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().link_state == LinkState::offline; }));
      rig.online();
      rig.stage.run(1s);
      EXPECT_TRUE(rig.writes().empty());
      EXPECT_FALSE(rig.motor_enabled());
      EXPECT_FALSE(rig.axis().has(AxisInput::homed));
      EXPECT_EQ(rig.axis().has(AxisInput::stop_latched), was_latched);
      EXPECT_NE(rig.axis().motion_state, MotionState::active);
      if (from == homing) {
        ASSERT_EQ(rig.command(Command::enable).outcome.code, Errc::ok);
        EXPECT_EQ(rig.command(Command::home).outcome.code, Errc::bad_value) << "the method is needed anew";
      }
    }
  }
}

TEST(Restart, TooQuickToGoOfflineStillLosesTheHoming) {
  RigOptions options;
  options.drive.boot_time = 120ms;
  Rig rig(KincoType::jd, options);
  rig.bring_to(enabled);
  ASSERT_EQ(rig.command(Command::set_position).outcome.code, Errc::ok);
  ASSERT_TRUE(rig.axis().has(AxisInput::homed));
  rig.stage.link(0).line().restart(0, rig.stage.link(0).time_of(rig.stage.runtime().now()));
  rig.stage.run(1s);
  ASSERT_EQ(rig.axis().link_state, LinkState::online);
  EXPECT_FALSE(rig.axis().has(AxisInput::homed));
  EXPECT_FALSE(rig.motor_enabled());
}

// --- The setup list, against a model made here ---------------------------------------------------------------------

struct SetupRun {
  model::DriveModel model;
  drive::ObjectStore store{0};
  std::int64_t held = 0;  ///< what the pretended drive holds
  bool refuse_writes = false, ignore_writes = false;
  std::int64_t statusword = 0x0250;
  std::int64_t statusword_later = 0x0250;  ///< from the second read of it on
  std::vector<std::string> log;

  SetupRun() {
    model.objects.resize(2);
    model.objects[0].name = "statusword";
    model.objects[1].name = "setting";
    model.objects[1].writable = true;
    model.axes.resize(1);
    model.axes[0].statusword = 0;
    model.axes[0].state_sources = {0};
    model.setup.push_back({1, 42, "the test wants it"});
    store = drive::ObjectStore(2);
  }
  drive::BringUp run() {
    drive::BringUp bring_up(model, 100ms);
    bring_up.begin();
    for (int i = 0; i < 20; ++i) {
      const auto next = bring_up.next(store);
      if (!next) break;
      store.begin_exchange();
      log.push_back(std::string(next->write ? "write " : "read ") + model.objects[next->object].name);
      if (next->write) {
        if (!refuse_writes && !ignore_writes) held = next->number;
      } else {
        store.read(next->object, next->object == 0 ? statusword : held, kLongAgo);
        if (next->object == 0) statusword = statusword_later;
      }
      bus::Exchange exchange;
      if (next->write) exchange.access = bus::Access::write;
      bus::ExchangeResult result;
      if (next->write && refuse_writes) result.code = Errc::refused_by_drive;
      bring_up.on_result(exchange, result, store, kLongAgo);
    }
    return bring_up;
  }
};

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Setup, IsReadComparedWrittenAndReadBack) {
  SetupRun run;
  const auto bring_up = run.run();
  EXPECT_THAT(run.log,
              ElementsAre("read statusword", "read setting", "read statusword", "write setting", "read setting"));
  EXPECT_THAT(bring_up.unheld(), IsEmpty());
}

TEST(Setup, WhatTheDriveHoldsIsNotWritten) {
  SetupRun run;
  run.held = 42;
  (void)run.run();
  EXPECT_THAT(run.log, ElementsAre("read statusword", "read setting", "read statusword"));
}

TEST(Setup, WhatTheDriveDoesNotTakeIsNamedAndNotRepeated) {
  for (const bool refuse : {true, false}) {
    SetupRun run;
    run.refuse_writes = refuse;
    run.ignore_writes = !refuse;
    const auto bring_up = run.run();
    EXPECT_EQ(std::ranges::count(run.log, "write setting"), 1);
    EXPECT_THAT(bring_up.unheld(), ElementsAre(1));
  }
}

TEST(Setup, IsNotWrittenToADriveThatWasEnabledMeanwhile) {
  SetupRun run;
  run.statusword_later = 0x0237;
  const auto bring_up = run.run();
  EXPECT_TRUE(bring_up.adopted());
  EXPECT_EQ(std::ranges::count(run.log, "write setting"), 0);
}

}  // namespace
}  // namespace axisgate::test
