// SPDX-License-Identifier: Apache-2.0
// One answer of the drive holds values of both motors: it is asked for once, and each value goes its own way.
#include <gmock/gmock.h>

#include <map>

#include "gateway/drive/device/poll_plan.hpp"
#include "gateway/drive/device/read_blocks.hpp"
#include "gateway/drive/device/resync.hpp"
#include "tests/stage_drive/keya_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

class KeyaReads : public testing::TestWithParam<Speech> {};
INSTANTIATE_TEST_SUITE_P(Speeches, KeyaReads, testing::Values(Speech::single, Speech::composed),
                         [](const auto& p) { return p.param == Speech::single ? "single" : "composed"; });

TEST_P(KeyaReads, OneQueryShowsTheValuesOfBothAxes) {
  KeyaRig rig({.speech = GetParam()});
  rig.online();
  rig.motor(0).faults = 0x0010;
  rig.motor(1).faults = 0x0800;
  rig.mark();
  ASSERT_TRUE(
      rig.run_until([&] { return rig.stored("A.fault").number == 0x0011 && rig.stored("B.fault").number == 0x0801; }));
  EXPECT_LE(rig.reads_of(kFaultQuery), 2U);
  // This model has no alarm table: a fault that nothing names is shown after half a second.
  EXPECT_TRUE(rig.run_until([&] { return rig.axis(0).has(AxisInput::fault) && rig.axis(1).has(AxisInput::fault); }));
}

TEST_P(KeyaReads, EachQueryIsPolledOnceInItsPeriodHoweverManyAxesWantIt) {
  KeyaRig rig({.speech = GetParam()});
  rig.online();
  rig.run(100ms);
  rig.mark();
  rig.run(2s);
  EXPECT_NEAR(static_cast<double>(rig.reads_of(kFaultQuery)), 100, 3) << "20 ms";
  EXPECT_NEAR(static_cast<double>(rig.reads_of(kSpeedQuery)), 100, 3);
  EXPECT_LE(rig.reads_of(kTemperatureQuery), 3U) << "three values of class slow, one request a second";
  EXPECT_GE(rig.reads_of(kTemperatureQuery), 2U);
}

TEST_P(KeyaReads, ThePlanCountsAQueryOnceInItsFastestClass) {
  model::DriveModel model = keya_model({.speech = GetParam()});
  for (auto& axis : model.axes)
    for (auto& binding : axis.bindings)
      if (binding.quantity == Quantity::motor_temperature && axis.number == 2) binding.poll = model::PollClass::normal;
  std::map<std::pair<std::uint16_t, std::uint8_t>, int> seen;
  for (const auto& read : drive::planned_reads(model)) {
    ++seen[{read.exchange.object.index, read.exchange.object.sub}];
    if (read.exchange.object.index == kTemperatureQuery) {
      EXPECT_EQ(read.poll_class, model::PollClass::normal);
      EXPECT_EQ(read.exchange.more.size(), 2U) << "the drive's own and both motors'";
    }
  }
  for (const auto& [query, times] : seen) EXPECT_EQ(times, 1) << std::hex << query.first;
  EXPECT_EQ(seen.size(), GetParam() == Speech::single ? 5U : 4U);
}

TEST(KeyaReading, ValuesOfAnAnswerComeInTheOrderOfTheirBytesWhicheverIsAskedFor) {
  const model::DriveModel model = keya_model({});
  const drive::ReadBlocks blocks(model);
  for (const std::uint8_t byte : {std::uint8_t{0}, std::uint8_t{2}}) {
    bus::Exchange exchange{1, bus::Access::read, {kFaultQuery, 1, byte}, 2, 0};
    blocks.widen(exchange, [](model::ObjectId) { return false; });
    EXPECT_EQ(exchange.object.byte, 0);
    ASSERT_EQ(exchange.more.size(), 1U);
    EXPECT_EQ(exchange.more.front().object.byte, 2);
  }
}

TEST(KeyaReading, AMotorThatIsNoAxisIsReadAlongAndHurtsNobody) {
  KeyaRig rig({.axes = 1});
  rig.online();
  rig.run(100ms);
  EXPECT_TRUE(rig.axis(0)[Quantity::velocity_actual].valid);
}

TEST(KeyaReading, AFieldOfAnotherWidthIsItsOwnProblemAlone) {
  KeyaRig rig;
  rig.wire->widths[{kTemperatureQuery, 1, 2}] = 2;
  rig.online();
  rig.run(2s);
  EXPECT_EQ(rig.axis(0).supported & bit(Quantity::motor_temperature), 0U);
  EXPECT_TRUE(rig.axis(0)[Quantity::drive_temperature].valid);
  EXPECT_TRUE(rig.axis(1)[Quantity::motor_temperature].valid);
}

TEST(KeyaReading, AMailboxReadInAWidthOfItsOwnSpoilsNoValue) {
  KeyaRig rig;
  rig.online();
  rig.motor(1).faults = 0x0020;
  const BatchResult read = rig.mailbox(0, false, kFaultQuery, 1, 4);
  EXPECT_EQ(KeyaRig::code(read), Errc::ok);
  EXPECT_EQ(read.object_size, 4);
  rig.run(600ms);
  EXPECT_TRUE(rig.axis(0)[Quantity::statusword].valid);
  EXPECT_TRUE(rig.axis(1).has(AxisInput::fault));
}

TEST(KeyaReading, AQueryThatTheDriveRefusesIsGivenUpWithAllItsValuesAndTheOthersStay) {
  KeyaRig rig;
  rig.wire->fate = [](const bus::Exchange& e) {
    return e.object.index == kTemperatureQuery ? Fate::refused : Fate::answered;
  };
  rig.online();
  rig.mark();
  rig.run(3s);
  EXPECT_EQ(rig.reads_of(kTemperatureQuery), 0U);
  for (const AxisSlot slot : {AxisSlot{0}, AxisSlot{1}}) {
    EXPECT_EQ(rig.axis(slot).supported & bit(Quantity::motor_temperature), 0U);
    EXPECT_EQ(rig.axis(slot).supported & bit(Quantity::drive_temperature), 0U);
    EXPECT_TRUE(rig.axis(slot)[Quantity::velocity_actual].valid);
  }
}

TEST(KeyaReading, AQueryThatIsNotAnsweredIsAskedForWholeAgain) {
  KeyaRig rig;
  rig.online();
  int mutes = 3;
  rig.wire->fate = [&](const bus::Exchange& e) {
    return e.object.index == kTemperatureQuery && mutes-- > 0 ? Fate::muted : Fate::answered;
  };
  rig.mark();
  rig.run(6s);
  for (const Sent& s : rig.since_mark()) {
    if (s.exchange.object.index == kTemperatureQuery) {
      EXPECT_EQ(s.exchange.more.size(), 2U);
    }
  }
  EXPECT_TRUE(rig.axis(1)[Quantity::motor_temperature].valid);
}

TEST(KeyaResync, ALostQueryOfOneMotorIsNotResolvedByTheSameQueryOfTheOther) {
  const model::DriveModel model = keya_model({});
  model::ResyncProperties facts;
  const auto find = [&](const std::string& name) {
    const auto at =
        std::find_if(model.objects.begin(), model.objects.end(), [&](const auto& o) { return o.name == name; });
    return static_cast<model::ObjectId>(at - model.objects.begin());
  };
  facts.candidates = {{find("A.fault"), 0}, {find("B.speed"), 0}};
  drive::Resync resync(facts, model.objects);
  resync.lost({1, bus::Access::read, {kFaultQuery, 1, 2}, 2, 0}, Instant{} + 1h);
  ASSERT_TRUE(resync.candidate());
  EXPECT_EQ(resync.candidate()->object, find("B.speed")) << "the reply to A.fault could be the one that was lost";
  resync.lost({1, bus::Access::read, {kSpeedQuery, 1, 0}, 2, 0}, Instant{} + 1h);
  EXPECT_FALSE(resync.candidate());
}

// --- Unasked values --------------------------------------------------------------------------------------------------

bus::UnsolicitedEvent values(std::initializer_list<bus::ReplyField> fields) {
  bus::UnsolicitedEvent unsolicited{.kind = bus::UnsolicitedEvent::Kind::values, .node = 1};
  for (const auto& field : fields) unsolicited.fields.push_back(field);
  return unsolicited;
}

TEST(KeyaUnasked, WhatComesInAKnownBeatIsNeverPolledButTheStateIs) {
  KeyaRig rig({.unsolicited_every = 1s, .unsolicited = true});
  rig.online();
  const auto items = drive::poll_items(rig.drive->model());
  const auto polled = [&](const std::string& name) {
    return std::any_of(items.begin(), items.end(), [&](const auto& i) { return i.object == rig.id(name); });
  };
  EXPECT_FALSE(polled("A.angle")) << "nothing asks for it";
  EXPECT_FALSE(polled("B.temperature"));
  EXPECT_TRUE(polled("A.fault")) << "the state is never slower than class fast";
  EXPECT_TRUE(polled("temperature"));
}

TEST(KeyaUnasked, ReceptionConfirmsAValueAndItsAbsenceMakesItStale) {
  KeyaRig rig({.unsolicited_every = 1s, .unsolicited = true});
  rig.online();
  rig.wire->tell(values({{{0x0700, 1}, 1, 55}}));
  rig.run(2500ms);
  EXPECT_TRUE(rig.axis(0)[Quantity::motor_temperature].valid) << "three beats";
  EXPECT_EQ(rig.axis(0)[Quantity::motor_temperature].value, 550);
  rig.run(1s);
  EXPECT_FALSE(rig.axis(0)[Quantity::motor_temperature].valid);
}

TEST(KeyaUnasked, InAnUnknownBeatValuesAreTakenAsTheyComeAndPolledAllTheSame) {
  KeyaRig rig({.unsolicited = true});
  rig.online();
  const auto items = drive::poll_items(rig.drive->model());
  EXPECT_TRUE(
      std::any_of(items.begin(), items.end(), [&](const auto& i) { return i.object == rig.id("B.temperature"); }));
  rig.wire->tell(values({{{kTemperatureQuery, 1, 3}, 1, 77}}));
  rig.run(1ms);
  EXPECT_EQ(rig.axis(1)[Quantity::motor_temperature].value, 770);
}

TEST(KeyaUnasked, ASignOfLifeBringsTheProbeOfAnOfflineDriveForward) {
  KeyaRig rig;
  rig.online();
  rig.wire->fate = [](const bus::Exchange&) { return Fate::muted; };
  ASSERT_TRUE(rig.run_until([&] { return rig.axis(0).link_state == LinkState::offline; }));
  rig.run(20s);
  rig.wire->fate = {};
  rig.mark();
  rig.wire->tell({.kind = bus::UnsolicitedEvent::Kind::present, .node = 1});
  rig.run(50ms);
  EXPECT_TRUE(rig.axis(0).reachable()) << "not after its next back-off step";
}

}  // namespace
}  // namespace axisgate::test
