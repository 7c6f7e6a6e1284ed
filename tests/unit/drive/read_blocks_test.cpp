// SPDX-License-Identifier: Apache-2.0
// Which registers go into one request, what a refusal leaves of it; and the budget of writes that wear memory out.
#include <gmock/gmock.h>

#include "gateway/drive/device/read_blocks.hpp"
#include "gateway/drive/state/nvm_budget.hpp"
#include "tests/unit/drive/alone.hpp"

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

/// Registers 100, 101 (32 bits), 103, 104, 110 of one class, 105 of another; one run from 100 to 105.
model::DriveModel registers() {
  model::DriveModel model;
  model.rtu.runs = {{100, 105}};
  model.rtu.max_registers = 8;
  model.axes.resize(1);
  model::AxisModel& axis = model.axes[0];
  const auto add = [&](std::uint16_t index, std::uint8_t size, model::PollClass poll) {
    model::ObjectDef object;
    object.address = {index, 0};
    object.size = size;
    model::Binding binding;
    binding.quantity = static_cast<Quantity>(axis.bindings.size());
    binding.object = static_cast<model::ObjectId>(model.objects.size());
    binding.poll = poll;
    axis.bindings.push_back(binding);
    model.objects.push_back(object);
  };
  add(103, 2, model::PollClass::fast);
  add(100, 2, model::PollClass::fast);
  add(101, 4, model::PollClass::fast);
  add(104, 2, model::PollClass::fast);
  add(105, 2, model::PollClass::slow);
  add(110, 2, model::PollClass::fast);
  return model;
}

std::vector<int> registers_of(const bus::Exchange& exchange) {
  std::vector<int> out{exchange.object.index};
  for (const bus::Neighbour& n : exchange.more) out.push_back(n.object.index);
  return out;
}

std::vector<int> widened(const ReadBlocks& blocks, bus::Exchange exchange) {
  blocks.widen(exchange, [](model::ObjectId) { return true; });
  return registers_of(exchange);
}

TEST(ReadBlocks, NeighboursOfOneClassGoIntoOneRequest) {
  const model::DriveModel model = registers();
  const ReadBlocks blocks(model);
  EXPECT_THAT(widened(blocks, reading(104)), ElementsAre(100, 101, 103, 104));
  EXPECT_THAT(widened(blocks, reading(101, 4)), ElementsAre(100, 101, 103, 104));
  EXPECT_THAT(widened(blocks, reading(105)), ElementsAre(105)) << "another class";
  EXPECT_THAT(widened(blocks, reading(110)), ElementsAre(110)) << "outside the run";
}

TEST(ReadBlocks, OnlyWhatIsWantedComesAlong) {
  const model::DriveModel model = registers();
  const ReadBlocks blocks(model);
  bus::Exchange exchange = reading(104);
  blocks.widen(exchange, [](model::ObjectId id) { return id == 2; });
  EXPECT_THAT(registers_of(exchange), ElementsAre(101, 104));
  EXPECT_EQ(exchange.size, 4) << "the first one's own width";
}

TEST(ReadBlocks, NeverExceedsWhatTheDriveReadsAtOnce) {
  model::DriveModel model = registers();
  model.rtu.max_registers = 3;
  const ReadBlocks blocks(model);
  EXPECT_THAT(widened(blocks, reading(100)), ElementsAre(100, 101));
  EXPECT_THAT(widened(blocks, reading(103)), ElementsAre(103, 104));
}

TEST(ReadBlocks, AWriteOrAnotherWidthIsLeftAlone) {
  const model::DriveModel model = registers();
  const ReadBlocks blocks(model);
  EXPECT_THAT(widened(blocks, {1, bus::Access::write, {100, 0}, 2, 5}), ElementsAre(100));
  EXPECT_THAT(widened(blocks, reading(100, 4)), ElementsAre(100)) << "the mailbox asks for two registers";
}

TEST(ReadBlocks, ARefusedRunIsSplitUntilTheBadRegisterStandsAloneAndStaysSo) {
  const model::DriveModel model = registers();
  ReadBlocks blocks(model);
  const auto drive_refuses = [](const bus::Exchange& exchange) {
    const auto read = registers_of(exchange);
    return std::find(read.begin(), read.end(), 103) != read.end();
  };
  int asked = 0;
  bus::Exchange exchange = reading(100);
  do {
    exchange = reading(103);
    blocks.widen(exchange, [](model::ObjectId) { return true; });
    ASSERT_LT(++asked, 5);
  } while (drive_refuses(exchange) && blocks.refused(exchange));
  EXPECT_THAT(registers_of(exchange), ElementsAre(103)) << "refused alone: now it is the drive's last word";
  EXPECT_THAT(widened(blocks, reading(100)), ElementsAre(100, 101)) << "the others are still read together";
  EXPECT_THAT(widened(blocks, reading(104)), ElementsAre(104));
}

TEST(ReadBlocks, SilenceToALongReadCountsAsARefusalTheSecondTime) {
  const model::DriveModel model = registers();
  ReadBlocks blocks(model);
  bus::Exchange exchange = reading(100);
  blocks.widen(exchange, [](model::ObjectId) { return true; });
  EXPECT_FALSE(blocks.silent(exchange));
  blocks.answered(exchange);
  EXPECT_FALSE(blocks.silent(exchange)) << "an answer between makes it the first time again";
  EXPECT_TRUE(blocks.silent(exchange));
  EXPECT_THAT(widened(blocks, reading(100)), ElementsAre(100, 101));
}

TEST(ReadBlocks, ThePlanListsEachRequestOnce) {
  std::vector<int> firsts;
  for (const PlannedRead& read : planned_reads(registers())) firsts.push_back(read.exchange.object.index);
  EXPECT_THAT(firsts, testing::UnorderedElementsAre(100, 105, 110));
}

TEST(NvmBudget, TenAtOnceThenOneAMinute) {
  NvmBudget budget;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(budget.take(model::Nvm::yes, kStart)) << i;
  EXPECT_FALSE(budget.take(model::Nvm::yes, kStart));
  EXPECT_TRUE(budget.alarm(kStart));
  EXPECT_FALSE(budget.take(model::Nvm::yes, kStart + 59s));
  EXPECT_TRUE(budget.take(model::Nvm::yes, kStart + 60s));
  EXPECT_FALSE(budget.take(model::Nvm::yes, kStart + 61s));
  EXPECT_EQ(budget.stored(), 11U);
}

TEST(NvmBudget, IsWholeAgainAfterTenQuietMinutes) {
  NvmBudget budget;
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(budget.take(model::Nvm::yes, kStart));
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(budget.take(model::Nvm::yes, kStart + 10min));
  EXPECT_FALSE(budget.take(model::Nvm::yes, kStart + 10min));
}

TEST(NvmBudget, TheAlarmEndsWhenAWriteMayBeSentAgain) {
  NvmBudget budget;
  for (int i = 0; i < 11; ++i) static_cast<void>(budget.take(model::Nvm::yes, kStart));
  EXPECT_TRUE(budget.alarm(kStart + 59s));
  EXPECT_FALSE(budget.alarm(kStart + 60s));
}

TEST(NvmBudget, AYearOfAWriteEachSecondStaysBelowWhatMemoryStands) {
  NvmBudget budget;
  for (Instant now = kStart; now < kStart + 24h; now += 1s) static_cast<void>(budget.take(model::Nvm::yes, now));
  EXPECT_LE(budget.stored(), 24U * 60U + 10U) << "1,450 a day: a million in almost two years, with an alarm all along";
}

TEST(NvmBudget, UnknownStorageIsCountedAndMemoryOfNoneIsFree) {
  NvmBudget budget;
  for (std::uint32_t i = 0; i < NvmBudget::kManyUnknown - 1; ++i) ASSERT_TRUE(budget.take(model::Nvm::unknown, kStart));
  EXPECT_FALSE(budget.alarm(kStart));
  EXPECT_TRUE(budget.take(model::Nvm::no, kStart));
  EXPECT_FALSE(budget.alarm(kStart));
  EXPECT_TRUE(budget.take(model::Nvm::unknown, kStart)) << "counted, not refused";
  EXPECT_TRUE(budget.alarm(kStart));
}

}  // namespace
}  // namespace axisgate::drive
