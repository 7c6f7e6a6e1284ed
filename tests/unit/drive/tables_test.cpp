// SPDX-License-Identifier: Apache-2.0
// The pure deciders alone: CiA 402 tables, resynchronisation read, poll plan, admission.
#include <gmock/gmock.h>

#include "gateway/drive/device/poll_plan.hpp"
#include "gateway/drive/device/resync.hpp"
#include "gateway/drive/plan/admission.hpp"
#include "tests/unit/drive/alone.hpp"

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

TEST(Cia402, EachStatuswordFallsOnOneRowOfTheStandardsTable) {
  struct Row {
    std::uint16_t mask, value;
    model::State402 state;
  };
  // IEC 61800-7-201 table 30, as printed: xxxx xxxx x0xx 0000 and so on.
  const std::vector<Row> table{
      {0x4F, 0x00, model::State402::not_ready_to_switch_on}, {0x4F, 0x40, model::State402::switch_on_disabled},
      {0x6F, 0x21, model::State402::ready_to_switch_on},     {0x6F, 0x23, model::State402::switched_on},
      {0x6F, 0x27, model::State402::operation_enabled},      {0x6F, 0x07, model::State402::quick_stop_active},
      {0x4F, 0x0F, model::State402::fault_reaction_active},  {0x4F, 0x08, model::State402::fault}};
  for (std::uint32_t w = 0; w <= 0xFFFF; ++w) {
    const auto word = static_cast<std::uint16_t>(w);
    std::vector<model::State402> rows;
    for (const Row& row : table)
      if ((word & row.mask) == row.value) rows.push_back(row.state);
    ASSERT_LE(rows.size(), 1U);
    if (!rows.empty()) {
      ASSERT_EQ(model::state_of(word), rows.front()) << std::hex << w;
    } else {
      // Impossible words: a fault bit is a fault, and no torque is ever concluded from the rest.
      ASSERT_EQ(model::state_of(word),
                (word & 8) != 0 ? model::State402::fault : model::State402::not_ready_to_switch_on)
          << std::hex << w;
    }
  }
}

TEST(Cia402, EachControlwordAsksForOneThing) {
  for (std::uint32_t w = 0; w <= 0xFFFF; ++w) {
    const auto word = static_cast<std::uint16_t>(w);
    const model::Request402 request = model::request_of(word);
    ASSERT_EQ(request == model::Request402::disable_voltage, (word & 2) == 0);
    ASSERT_EQ(request == model::Request402::quick_stop, (word & 6) == 2);
    ASSERT_EQ(request == model::Request402::shutdown, (word & 0xF) == 6);
    ASSERT_EQ(request == model::Request402::switch_on, (word & 0xF) == 7);
    ASSERT_EQ(request == model::Request402::enable_operation, (word & 0xF) == 0xF);
    ASSERT_EQ(is_stop(word, false), (word & 2) == 0 || (word & 4) == 0);
    ASSERT_EQ(is_stop(word, true), (word & 2) == 0 || (word & 4) == 0 || (word & 0xF) == 6 || (word & 0xF) == 7);
  }
}

model::DriveModel five_objects() {
  model::DriveModel model;
  for (std::uint16_t i = 0; i < 5; ++i) {
    model::ObjectDef object;
    object.name = "o" + std::to_string(i);
    object.address = {static_cast<std::uint16_t>(0x2000 + i), 0};
    model.objects.push_back(object);
  }
  model.resync.candidates = {{1}, {2}, {3}};
  return model;
}

TEST(Resync, NeverUsesAnObjectWhoseReplyMayStillCome) {
  const model::DriveModel model = five_objects();
  Resync resync(model.resync, model.objects);
  EXPECT_FALSE(resync.suspect());
  resync.lost(reading(0x2001), kStart);
  EXPECT_TRUE(resync.suspect());
  EXPECT_EQ(resync.candidate().value().object, 2);
  resync.resync_sent(*resync.candidate());
  resync.lost(reading(0x2002), kStart + 100ms);
  EXPECT_EQ(resync.candidate().value().object, 3);
  EXPECT_FALSE(resync.exhausted());
  resync.resync_sent(*resync.candidate());
  EXPECT_TRUE(resync.exhausted());
  resync.lost(reading(0x2003), kStart + 200ms);
  EXPECT_FALSE(resync.candidate().has_value());
  EXPECT_EQ(resync.silent_until(), kStart + 200ms + model.resync.worst_reply);
  resync.waited_out();
  EXPECT_FALSE(resync.suspect());
  EXPECT_FALSE(resync.exhausted());
}

TEST(Resync, AnAnsweredOneProvesThatNothingOlderIsLeft) {
  const model::DriveModel model = five_objects();
  Resync resync(model.resync, model.objects);
  resync.lost(reading(0x2001), kStart);
  resync.lost(reading(0x2004), kStart);
  resync.resync_sent(*resync.candidate());
  resync.answered();
  EXPECT_FALSE(resync.suspect());
  resync.lost(reading(0x2000), kStart + 1s);
  EXPECT_EQ(resync.candidate().value().object, 1);
}

// Modbus RTU: a reply to a read tells how long it is, and nothing else.
TEST(Resync, TellsRepliesByTheirLengthWhereTheyNameNoObject) {
  model::DriveModel model = five_objects();
  model.resync = {{{1, 1}, {1, 2}, {1, 3}, {1, 4}}, true, 500ms};
  Resync resync(model.resync, model.objects);
  resync.lost(reading(0x2000), kStart);  // one register, of whatever object
  EXPECT_EQ(resync.candidate().value().registers, 2);
  resync.lost(reading(0x2004, 4), kStart);
  EXPECT_EQ(resync.candidate().value().registers, 3);
  bus::Exchange run = reading(0x2000);
  run.more = {{{0x2001, 0}, 2}, {{0x2002, 0}, 2}};
  resync.lost(run, kStart);
  EXPECT_EQ(resync.candidate().value().registers, 4);
  resync.answered();
  EXPECT_EQ(resync.candidate().value().registers, 1);
}

TEST(Resync, AWriteGivenUpMakesTheDriveSuspectThoughItsReplyIsLikeNoRead) {
  model::DriveModel model = five_objects();
  model.resync = {{{1, 1}, {1, 2}}, true, 500ms};
  Resync resync(model.resync, model.objects);
  resync.lost({1, bus::Access::write, {0x2000, 0}, 2, 7}, kStart);
  EXPECT_TRUE(resync.suspect());
  EXPECT_EQ(resync.candidate().value().registers, 1);
}

// Kinco documents counts 1 and 2 and no other.
TEST(Resync, WithBothLengthsLostOnlySilenceHelps) {
  model::DriveModel model = five_objects();
  model.resync = {{{1, 2}, {1, 1}}, true, 500ms};
  Resync resync(model.resync, model.objects);
  resync.lost(reading(0x2000, 2), kStart);
  resync.lost(reading(0x2000, 4), kStart + 1ms);
  EXPECT_FALSE(resync.candidate().has_value());
  EXPECT_EQ(resync.silent_until(), kStart + 501ms);
}

model::DriveModel polled() {
  model::DriveModel model = five_objects();
  model.axes.resize(1);
  model::AxisModel& axis = model.axes[0];
  axis.statusword = 0;
  axis.state_sources = {0};
  const auto bind = [&](Quantity quantity, model::ObjectId object, model::PollClass poll) {
    model::Binding binding;
    binding.quantity = quantity;
    binding.object = object;
    binding.poll = poll;
    axis.bindings.push_back(binding);
  };
  bind(Quantity::statusword, 0, model::PollClass::slow);
  bind(Quantity::velocity_actual, 1, model::PollClass::normal);
  bind(Quantity::drive_temperature, 2, model::PollClass::slow);
  bind(Quantity::profile_velocity, 3, model::PollClass::once);
  return model;
}

TEST(PollPlan, TheObjectLongestOverdueGoesFirst) {
  const model::DriveModel model = polled();
  PollPlan plan(model);
  EXPECT_EQ(plan.next(kStart), std::nullopt);
  plan.restart(kStart);
  for (model::ObjectId id = 0; id < 4; ++id) {
    ASSERT_EQ(plan.next(kStart), id);
    plan.done(id, kStart);
  }
  EXPECT_EQ(plan.next(kStart), std::nullopt);
  EXPECT_EQ(plan.next_due(), kStart + 20ms) << "the statusword is never slower than fast";
  EXPECT_EQ(plan.next(kStart + 5s), model::ObjectId{0});
  plan.done(0, kStart + 5s);
  EXPECT_EQ(plan.next(kStart + 5s), model::ObjectId{1});
}

TEST(PollPlan, KeepsItsBeatButNeverCatchesUp) {
  const model::DriveModel model = polled();
  PollPlan plan(model);
  plan.restart(kStart);
  plan.done(0, kStart + 3ms);
  for (model::ObjectId id = 1; id < 4; ++id) plan.done(id, kStart);
  EXPECT_EQ(plan.next_due(), kStart + 20ms);
  plan.done(0, kStart + 26ms);
  EXPECT_EQ(plan.next_due(), kStart + 40ms);
  plan.done(0, kStart + 95ms);
  plan.done(1, kStart + 100ms);
  EXPECT_EQ(plan.next_due(), kStart + 115ms) << "late by more than a period: it stretches";
  plan.done(0, kStart + 97ms);
  EXPECT_EQ(plan.next_due(), kStart + 117ms) << "read early by somebody else";
}

TEST(PollPlan, OnceMeansOnceAndAgainAfterAWriteOrAnInvalidation) {
  const model::DriveModel model = polled();
  PollPlan plan(model);
  plan.restart(kStart);
  for (model::ObjectId id = 0; id < 4; ++id) plan.done(id, kStart);
  plan.written(1, kStart);
  EXPECT_EQ(plan.next(kStart + 1ms), std::nullopt) << "what is polled anyway keeps its beat";
  plan.written(3, kStart);
  EXPECT_EQ(plan.next(kStart + 1ms), model::ObjectId{3});
  plan.done(3, kStart + 1ms);
  plan.refresh(kStart + 1ms);
  plan.done(0, kStart + 30ms);
  EXPECT_EQ(plan.next(kStart + 30ms), model::ObjectId{3});
}

TEST(PollPlan, WhatTheDriveRefusesIsNotAskedForUntilTheNextBringUp) {
  const model::DriveModel model = polled();
  PollPlan plan(model);
  plan.restart(kStart);
  plan.drop(0);
  plan.drop(3);
  plan.written(3, kStart);
  plan.refresh(kStart);
  plan.done(1, kStart);
  plan.done(2, kStart);
  EXPECT_EQ(plan.next(kStart + 50ms), std::nullopt);
  plan.restart(kStart + 1s);
  EXPECT_EQ(plan.next(kStart + 1s), model::ObjectId{0});
}

TEST(Admission, KnowsAStopWhereverItStands) {
  WriteBatch batch;
  EXPECT_FALSE(holds_stop(batch));
  batch.command = Command::halt;
  EXPECT_TRUE(holds_stop(batch));
  batch.command = Command::enable;
  batch.controlword = 0x0006;
  EXPECT_FALSE(holds_stop(batch)) << "in a block write 6 is a step of the state machine";
  batch.single_controlword = true;
  EXPECT_TRUE(holds_stop(batch));
  batch.setpoints.push_back({Quantity::profile_velocity, 1});
  batch.mode = 3;
  const WriteBatch alone = stop_alone(batch);
  EXPECT_TRUE(alone.setpoints.empty() && !alone.mode && alone.command == Command::none);
  EXPECT_EQ(alone.controlword, std::optional<std::uint16_t>(6));
}

TEST(Admission, TellsTheArbiterWhatABatchIs) {
  const model::DriveModel model = polled();
  ObjectStore store(model.objects.size());
  const Turn turn;
  AxisRecord record;
  AxisCore core{model, model.axes[0], store, turn, Motion{model.axes[0].velocity_lag, record}};
  WriteBatch batch;
  batch.start_by = kStart;
  batch.object = ObjectRequest{false, 0x2001, 0, 2, 0};
  bus::BusJob job = job_for(core, batch, false);
  EXPECT_EQ(job.priority, bus::Priority::interactive);
  EXPECT_TRUE(job.read.has_value() && job.survives_stop);
  batch.object.reset();
  batch.command = Command::enable;
  job = job_for(core, batch, false);
  EXPECT_EQ(job.priority, bus::Priority::command);
  EXPECT_FALSE(job.setpoints_only || job.survives_stop);
  job = job_for(core, batch, true);
  EXPECT_EQ(job.priority, bus::Priority::stop);
  EXPECT_EQ(job.start_by, kNever) << "a stop is never given up for being late";
}

}  // namespace
}  // namespace axisgate::drive
