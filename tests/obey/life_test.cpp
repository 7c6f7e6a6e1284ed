// SPDX-License-Identifier: Apache-2.0
// 3.5 Signs of life, and who takes over.
#include <gtest/gtest.h>

#include "tests/obey/dds_writers.hpp"
#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

class Life : public testing::TestWithParam<Subject> {
 protected:
  /// Its motor runs, its connection ends, and there is another one of it.
  void comes_back(Plant& plant) {
    plant.ready();
    ASSERT_TRUE(plant.start_endless(plant.a));
    plant.a.disconnect();
    plant.run(800ms);
    plant.a.connect();
  }
  /// A PLC's block that asks for nothing it has not asked for before.
  Write scanned(Plant& plant) { return block(row::target_position, 45, plant.endless_target()); }
  void stops_by_its_lease(Plant& plant) {
    EXPECT_TRUE(plant.comes_to_stand(2500ms)) << plant.velocity();
    EXPECT_EQ(plant.b.word(shown::axis_state), kStopLatched);
  }
};

TEST_P(Life, IsNotShownByReadsWhileTheAxisIsDisabled) {
  Plant plant(GetParam(), with_leases());
  plant.ready_but_disabled();
  ASSERT_EQ(plant.set_endless(plant.a), kOk);
  ASSERT_EQ(plant.b.word(shown::owner), kAnother);
  for (int i = 0; i < 25; ++i) {
    (void)plant.a.word(shown::position);
    plant.run(100ms);
  }
  EXPECT_EQ(plant.b.word(shown::owner), kNobody);
}

TEST_P(Life, IsNotShownByAnIdleScannersBlockWhileTheAxisIsDisabled) {
  Plant plant(GetParam(), with_leases());
  plant.ready_but_disabled();
  const Write block = scanned(plant);
  ASSERT_EQ(plant.a.write(block), kOk);
  ASSERT_EQ(plant.b.word(shown::owner), kAnother);
  plant.scan(plant.a, block, 2500ms);
  EXPECT_EQ(plant.b.word(shown::owner), kNobody);
}

TEST_P(Life, IsShownByWhatAsksWhileTheAxisIsDisabled) {
  Plant plant(GetParam(), with_leases());
  plant.ready_but_disabled();
  for (int i = 0; i < 25; ++i) {
    ASSERT_EQ(plant.set_endless(plant.a), kOk);  // a single write always asks
    plant.run(100ms);
  }
  EXPECT_EQ(plant.b.word(shown::owner), kAnother);
}

TEST_P(Life, IsShownByReadsWhileTheAxisIsEnabled) {
  Plant plant(GetParam(), with_leases());
  plant.ready();
  ASSERT_TRUE(plant.start_endless(plant.a));
  for (int i = 0; i < 30; ++i) {
    (void)plant.a.word(shown::position);
    plant.run(100ms);
  }
  EXPECT_TRUE(plant.velocity() != 0);
  EXPECT_EQ(plant.b.word(shown::owner), kAnother);
}

TEST_P(Life, OfAnAddressIsNotShownByReads) {
  Plant plant(GetParam(), with_leases(true));
  plant.ready();
  ASSERT_TRUE(plant.start_endless(plant.a));
  const auto monitor = plant.connection_from(Plant::kHostOfA);
  for (int i = 0; i < 40; ++i) {
    (void)monitor->word(shown::position);
    plant.run(100ms);
  }
  EXPECT_EQ(plant.velocity(), 0);
  EXPECT_EQ(plant.b.word(shown::axis_state), kStopLatched);
}

TEST_P(Life, OfAnAddressIsNotShownByObjectsThatAreRead) {
  constexpr std::uint16_t kDeviceName = 0x1008;
  Plant plant(GetParam(), with_leases(true));
  plant.ready();
  ASSERT_TRUE(plant.start_endless(plant.a));
  for (int i = 0; i < 5; ++i) {
    plant.run(500ms);
    plant.a.ask_for_object(kDeviceName, 0);
  }
  stops_by_its_lease(plant);
}

TEST_P(Life, OfAnAddressIsShownByWrites) {
  Plant plant(GetParam(), with_leases(true));
  plant.ready();
  ASSERT_TRUE(plant.start_endless(plant.a));
  plant.scan(plant.a, scanned(plant), 4s);
  EXPECT_TRUE(plant.velocity() != 0);
  EXPECT_EQ(plant.a.word(shown::owner), kMe);
}

TEST_P(Life, OfASilentOwnerIsNotEndedByAnotherConnectionOfItsAddress) {
  Plant plant(GetParam(), with_leases());
  plant.ready();
  ASSERT_TRUE(plant.start_endless(plant.a));
  const auto other = plant.connection_from(Plant::kHostOfA);
  plant.run(1500ms);  // more than half of the timeout
  EXPECT_EQ(plant.set_endless(*other), kNotNow);
  EXPECT_EQ(other->result(), kNotOwner);
  EXPECT_EQ(other->word(shown::owner), kAnother);
  EXPECT_NE(plant.velocity(), 0);
  plant.run(600ms);
  stops_by_its_lease(plant);
}

TEST_P(Life, OfAnOrphanGoesOnWithAnyWriteOfItsAddressAndRole) {
  Plant plant(GetParam(), with_leases());
  comes_back(plant);
  // It asks for nothing: command 0.
  const Write idle = block(row::command, row::command_id, {});
  EXPECT_EQ(plant.a.write(idle), kOk);
  EXPECT_EQ(plant.a.word(shown::owner), kMe);
  plant.scan(plant.a, idle, 3s);
  EXPECT_NE(plant.velocity(), 0);
  EXPECT_EQ(plant.b.word(shown::owner), kAnother);
}

TEST_P(Life, OfAnOrphanGoesOnWithAChangedHeartbeat) {
  Plant plant(GetParam(), with_leases());
  comes_back(plant);
  EXPECT_EQ(plant.a.row(row::heartbeat, 1), kOk);
  EXPECT_EQ(plant.a.word(shown::owner), kMe);
  plant.run(1500ms);
  EXPECT_NE(plant.velocity(), 0);
}

// Design 3.5 Signs of life: "on a connection opened after the owner's last request".
TEST_P(Life, OfAnOrphanIsNotTakenByAProgramOfItsAddressThatWasThereBefore) {
  Plant plant(GetParam(), with_leases());
  plant.ready();
  const auto before = plant.connection_from(Plant::kHostOfA);
  before->connect();
  plant.run(100ms);
  ASSERT_TRUE(plant.start_endless(plant.a));
  plant.a.disconnect();
  plant.run(300ms);
  EXPECT_EQ(before->row(row::heartbeat, 1), kOk) << "what asks for nothing is refused to nobody";
  EXPECT_EQ(before->word(shown::owner), kAnother);
  EXPECT_EQ(plant.set_endless(*before), kNotNow);
  EXPECT_EQ(before->word(shown::owner), kAnother);
  plant.run(1000ms);
  stops_by_its_lease(plant);
}

// "Register 8 and writes elsewhere renew what is owned and take over nothing."
TEST_P(Life, OfAnOrphanIsNotTakenByTheGatewaysHeartbeat) {
  Plant plant(GetParam(), with_leases());
  plant.ready();
  ASSERT_TRUE(plant.start_endless(plant.a));
  plant.a.disconnect();
  const auto monitor = plant.connection_from(Plant::kHostOfA);
  monitor->connect();
  for (std::uint8_t beat = 1; beat <= 25; ++beat) {
    monitor->say({0, beat, 0, 0, 0, 6, 1, 6, 0, 8, 0, beat});
    plant.run(100ms);
  }
  EXPECT_GT(monitor->replies(), 0U);
  EXPECT_EQ(plant.velocity(), 0);
  EXPECT_EQ(plant.b.word(shown::axis_state), kStopLatched);
}

TEST_P(Life, OfAnOrphanGoesOnWithTheFirstBlockOfItsReturnThoughThatIsOnlyRemembered) {
  Plant plant(GetParam(), with_leases());
  comes_back(plant);
  EXPECT_EQ(plant.a.command(plant.endless_command(), 7), kOk) << "an id that is the first of its address";
  EXPECT_EQ(plant.a.word(shown::owner), kMe);
  plant.run(1500ms);
  EXPECT_NE(plant.velocity(), 0);
}

TEST_P(Life, OfAnOrphanIsNotTakenByAnotherAddress) {
  Plant plant(GetParam(), with_leases());
  plant.ready();
  ASSERT_TRUE(plant.start_endless(plant.a));
  plant.a.disconnect();
  plant.run(500ms);
  EXPECT_EQ(plant.set_endless(plant.b), kNotNow);
  EXPECT_EQ(plant.b.word(shown::owner), kAnother);
  plant.run(1500ms);
  stops_by_its_lease(plant);
}

TEST_P(Life, OfAnotherConnectionOfTheAddressEndsByCommandFourteenWithoutRank) {
  Plant plant(GetParam(), with_leases());
  plant.ready();
  ASSERT_TRUE(plant.start_endless(plant.a));
  const auto other = plant.connection_from(Plant::kHostOfA);
  EXPECT_EQ(other->command(kTakeOver), kOk);
  EXPECT_EQ(other->word(shown::owner), kMe);
  EXPECT_EQ(plant.a.word(shown::owner), kAnother);
  EXPECT_TRUE(plant.comes_to_stand()) << plant.velocity();  // 3.5: "after a halt"
}

TEST_P(Life, OfAnotherAddressDoesNotEndByCommandFourteenWithoutRank) {
  Plant plant(GetParam(), with_leases());
  plant.ready();
  ASSERT_TRUE(plant.start_endless(plant.a));
  EXPECT_EQ(plant.b.command(kTakeOver), kNotNow);
  EXPECT_EQ(plant.b.word(shown::owner), kAnother);
  EXPECT_NE(plant.velocity(), 0);
}

// 3.3 Not new: "so that no tool prints success for nothing": where a lease's halt has latched an axis that stays
// enabled, a held enable was answered as if all were well.
TEST_P(Life, ThatHasRunOutWithAHaltAsksForAZeroBeforeTheNextEnable) {
  PlantOptions options = with_leases();
  options.lease->on_expiry = LeaseAction::halt;
  for (const bool by_coil : {true, false}) {
    Plant plant(GetParam(), options);
    plant.ready();
    const auto enable = [&](bool on) {
      return by_coil ? plant.a.coil(coil::enable, on) : plant.a.command(on ? kEnable : 0);
    };
    ASSERT_EQ(enable(false), kOk);
    ASSERT_EQ(enable(true), kOk);
    plant.run(4s);
    ASSERT_EQ(plant.b.word(shown::axis_state), kStopLatched);
    EXPECT_EQ(enable(true), kNotNow) << by_coil;
    EXPECT_EQ(plant.a.result(), kNotNew);
    EXPECT_EQ(enable(false), kOk);
    EXPECT_EQ(enable(true), kOk);
    EXPECT_EQ(plant.a.word(shown::axis_state), kStandstill);
  }
}

// Design 4, signs of life: "the lease is the smaller of lease_ms and the configured one": also of a program that beats
// before it commands, and dies right after its first command.
TEST_P(Life, OfADdsWriterIsAsShortAsItsHeartbeatHasSaidBeforeItsFirstCommand) {
  Plant plant(GetParam(), with_leases());
  plant.ready();
  DdsWriters writer(plant.stage, 1);
  writer.beat(0, true, 300);
  plant.run(1s);
  Rows sample = plant.endless_target();
  sample[row::command] = plant.endless_command();
  const std::uint64_t start = writer.begin({.function = fc::sample, .sample = sample});
  ASSERT_TRUE(plant.stage.run_until([&] { return writer.result_of(start).has_value(); }, 1s));
  ASSERT_EQ(writer.result_of(start), 2);
  ASSERT_TRUE(plant.turns_within(1s));
  EXPECT_TRUE(plant.stage.run_until([&] { return plant.b.word(shown::axis_state) == kStopLatched; }, 1s));
  EXPECT_TRUE(plant.comes_to_stand());
}

INSTANTIATE_TEST_SUITE_P(Every, Life, testing::ValuesIn(kSubjects), named);

}  // namespace
}  // namespace axisgate::test::obey
