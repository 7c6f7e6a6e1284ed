// SPDX-License-Identifier: Apache-2.0
// Samples that no honest program sends, and those that ask for what this axis does not have: each is refused by its
// result, nothing of it reaches the axis, and a stop is carried out whatever stands beside it.
#include <gmock/gmock.h>

#include <bit>
#include <limits>
#include <random>

#include "gateway/upstream/dds/command_batches.hpp"
#include "tests/unit/dds/plain_session.hpp"

namespace axisgate::dds {
namespace {

using test::command;
using test::guid;
using test::PlainSession;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr int kNotSupported = 16, kBadValue = 17, kRole = 18, kNoAxis = 20;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

struct Malformed : testing::Test {
  PlainSession plain;
  std::uint64_t id = 0;
  Malformed() { plain.port.at_once = BatchResult{}; }
  CommandRecord sample(std::uint8_t number, std::uint32_t mask = 0) {
    CommandRecord out = command(guid(1), number, ++id);
    out.mask = mask;
    return out;
  }
  void expect_refused(const CommandRecord& record, int result) {
    EXPECT_EQ(plain.ask(record), result) << "command " << int{record.command} << " mask " << record.mask;
    EXPECT_THAT(plain.port.submitted, IsEmpty());
  }
};

TEST_F(Malformed, UnknownCommandsAreBadValues) {
  for (int number = 0; number <= 255; ++number) {
    const bool known = (number >= 1 && number <= 14) || (number >= 31 && number <= 33);
    if (!known) expect_refused(sample(static_cast<std::uint8_t>(number)), kBadValue);
  }
}

TEST_F(Malformed, UnknownBitsOfTheMaskAreBadValues) {
  for (unsigned bit = 11; bit < 32; ++bit) expect_refused(sample(1, 1U << bit), kBadValue);
  expect_refused(sample(0, UINT32_MAX), kBadValue);
}

TEST_F(Malformed, NumbersThatAreNoneOrFitNoRegisterAreBadValues) {
  const auto set = [](CommandRecord& record, double value) {
    record.target_position = record.target_velocity = record.target_torque = record.max_torque = value;
    record.profile_velocity = record.profile_acceleration = record.profile_deceleration = value;
    record.jog_velocity = record.set_position_value = value;
  };
  const std::uint32_t numbers = kHasAny & ~(kHasMode | kHasHomingMethod);
  for (std::uint32_t bit = 1; bit <= kHasSetPositionValue; bit <<= 1U) {
    if ((numbers & bit) == 0) continue;
    for (const double value : {kNaN, kInf, -kInf, 1e12, -1e12}) {
      CommandRecord record = sample(0, bit);
      set(record, value);
      expect_refused(record, kBadValue);
    }
  }
  CommandRecord slow = sample(0, kHasProfileVelocity);
  slow.profile_velocity = -1;
  expect_refused(slow, kBadValue);
  CommandRecord method = sample(0, kHasHomingMethod);
  method.homing_method = INT16_MIN;
  expect_refused(method, kBadValue);
}

TEST_F(Malformed, ANumberThatTheMaskDoesNotNameIsNotLookedAt) {
  CommandRecord record = sample(1);
  record.target_position = record.jog_velocity = kNaN;
  record.mode = 99;
  EXPECT_EQ(plain.ask(record), 2);
  ASSERT_THAT(plain.port.submitted, SizeIs(1));
  EXPECT_THAT(plain.port.submitted.front().batch.setpoints, IsEmpty());
  EXPECT_FALSE(plain.port.submitted.front().batch.mode);
}

TEST_F(Malformed, OnlyTheAxesThatThereAreCanBeAsked) {
  for (const std::uint16_t axis : std::initializer_list<std::uint16_t>{0, 2, 499, 500, 65535}) {
    CommandRecord record = sample(1);
    record.axis = axis;
    expect_refused(record, kNoAxis);
  }
}

TEST_F(Malformed, WhatThisAxisDoesNotHaveIsNotSupported) {
  AxisImage& axis = *plain.image.find(1);
  const std::vector<std::pair<std::uint32_t, Quantity>> members{
      {kHasMode, Quantity::mode},
      {kHasTargetPosition, Quantity::target_position},
      {kHasTargetVelocity, Quantity::target_velocity},
      {kHasTargetTorque, Quantity::target_torque},
      {kHasMaxTorque, Quantity::max_torque},
      {kHasProfileVelocity, Quantity::profile_velocity},
      {kHasProfileAcceleration, Quantity::profile_acceleration},
      {kHasProfileDeceleration, Quantity::profile_deceleration},
      {kHasHomingMethod, Quantity::homing_method}};
  for (const auto& [mask, quantity] : members) {
    axis.supported = ~bit(quantity);
    expect_refused(sample(0, mask), kNotSupported);
    axis.supported = UINT32_MAX;
    axis.writable = ~bit(quantity);
    expect_refused(sample(0, mask), kNotSupported);
    axis.writable = UINT32_MAX;
  }
  axis.supported_commands = 0;
  for (std::uint8_t number = 1; number <= 14; ++number) expect_refused(sample(number), kNotSupported);
  for (std::uint8_t number = 31; number <= 33; ++number) expect_refused(sample(number), kNotSupported);
  expect_refused(sample(0, kHasJogVelocity), kNotSupported);
  expect_refused(sample(0, kHasSetPositionValue), kNotSupported);
}

TEST_F(Malformed, AJogBesideAnotherMotionIsABadValue) {
  for (const std::uint32_t mask :
       {kHasMode, kHasTargetPosition, kHasTargetVelocity, kHasTargetTorque, kHasHomingMethod, kHasSetPositionValue})
    for (const std::uint8_t number : std::initializer_list<std::uint8_t>{31, 32})
      expect_refused(sample(number, mask), kBadValue);
}

TEST_F(Malformed, RequestIdZeroIsABadValue) {
  expect_refused(command(guid(1), 1, 0), kBadValue);
  expect_refused(command(guid(1), 1, 0), kBadValue);
}

TEST_F(Malformed, AStopIsCarriedOutAndTheAnswerTellsOfTheNonsense) {
  for (const std::uint8_t number : std::initializer_list<std::uint8_t>{2, 3, 4, 33}) {
    CommandRecord nan = sample(number, kHasTargetVelocity);
    nan.target_velocity = kNaN;
    CommandRecord unknown = sample(number, 1U << 31U);
    CommandRecord no_id = command(guid(1), number, 0);
    for (const CommandRecord& record : {nan, unknown, no_id}) {
      plain.port.submitted.clear();
      EXPECT_EQ(plain.ask(record), kBadValue);
      ASSERT_THAT(plain.port.submitted, SizeIs(1));
      const WriteBatch& batch = plain.port.submitted.front().batch;
      EXPECT_EQ(batch.command, Command{number});
      EXPECT_THAT(batch.setpoints, IsEmpty());
      EXPECT_FALSE(batch.claims);
    }
  }
}

TEST_F(Malformed, AStopThatFailedIsToldAsThatAndNotAsTheNonsense) {
  plain.port.at_once = BatchResult{{Errc::offline, 0}};
  CommandRecord nan = sample(3, kHasTargetVelocity);
  nan.target_velocity = kNaN;
  EXPECT_EQ(plain.ask(nan), 6);
}

TEST_F(Malformed, RecordsThatOnlyTheGatewaySendsAreNothing) {
  static_cast<void>(plain.read());
  for (const Record& record :
       std::initializer_list<Record>{StateRecord{}, EventRecord{}, GatewayRecord{}, ReplyRecord{}, ObjectReplyRecord{},
                                     ReadyRecord{}, LogRecord{}})
    plain.session->on_record(record, plain.now);
  EXPECT_THAT(plain.read(), IsEmpty());
}

TEST_F(Malformed, AnyBytesAtAllHaveOneReplyAndOnlySoundBatchesReachTheAxis) {
  std::mt19937_64 random(6);
  static_cast<void>(plain.read());
  for (int i = 0; i < 20'000; ++i) {
    const auto number = [&](std::uint64_t below) { return random() % below; };
    const auto any = [&] {
      return number(2) == 0 ? std::bit_cast<double>(random()) : static_cast<double>(number(4000)) - 2000;
    };
    CommandRecord record = command(guid(static_cast<std::uint8_t>(number(4))), static_cast<std::uint8_t>(number(36)),
                                   number(1000), static_cast<std::uint16_t>(number(3)));
    record.mask = static_cast<std::uint32_t>(number(2) == 0 ? number(2048) : 1ULL << number(32));
    record.mode = static_cast<std::int16_t>(random());
    record.homing_method = static_cast<std::int16_t>(random());
    for (double* const value : {&record.target_position, &record.target_velocity, &record.target_torque,
                                &record.max_torque, &record.profile_velocity, &record.profile_acceleration,
                                &record.profile_deceleration, &record.jog_velocity, &record.set_position_value})
      *value = any();
    plain.port.submitted.clear();
    plain.now += std::chrono::milliseconds(5);
    EXPECT_NE(plain.ask(record), 0);
    for (const auto& each : plain.port.submitted) {
      EXPECT_EQ(each.axis, 1);
      EXPECT_TRUE(each.batch.life);
      for (const Setpoint& setpoint : each.batch.setpoints)
        EXPECT_TRUE(range_of(row(setpoint.quantity).type).holds(setpoint.value));
    }
  }
}

struct RoleCase {
  Role role;
  bool commands;
  int enable, save, object_read, object_write;
};

TEST(Roles, OfDdsWritersAreTheSettings) {
  for (const RoleCase& each :
       {RoleCase{Role::engineer, false, kRole, kRole, kRole, kRole},
        RoleCase{Role::viewer, true, kRole, kRole, 2, kRole}, RoleCase{Role::operator_, true, 2, kRole, 2, kRole},
        RoleCase{Role::engineer, true, 2, 2, 2, 2}}) {
    DdsSettings settings = PlainSession::settings();
    settings.role = each.role;
    settings.commands = each.commands;
    PlainSession plain(1, settings);
    plain.port.at_once = BatchResult{};
    EXPECT_EQ(plain.ask(command(guid(1), 1, 1)), each.enable);
    EXPECT_EQ(plain.ask(command(guid(1), 12, 2)), each.save);
    ObjectRequestRecord object{guid(1, 2), 0, {}, 1, 3, false, 0x1000, 0, 4, 0, {}};
    EXPECT_EQ(plain.ask<ObjectReplyRecord>(object), each.object_read);
    object.write = true;
    object.request_id = 4;
    EXPECT_EQ(plain.ask<ObjectReplyRecord>(object), each.object_write);
    CommandRecord stop = command(guid(1), 3, 5);
    EXPECT_EQ(plain.ask(stop), each.role == Role::viewer || !each.commands ? kRole : 2);
  }
}

// --- What is asked for, in the words of a Modbus client
// ----------------------------------------------------------------

struct Asked : Malformed {
  const WriteBatch& asked(const CommandRecord& record) {
    plain.port.submitted.clear();
    EXPECT_EQ(plain.ask(record), 2);
    EXPECT_THAT(plain.port.submitted, SizeIs(1));
    return plain.port.submitted.back().batch;
  }
};

TEST_F(Asked, EveryMemberIsItsQuantityInRegisterUnits) {
  CommandRecord record = sample(6, kHasAny & ~kHasJogVelocity);
  constexpr double kTurn = 2 * 3.14159265358979323846;
  record.mode = -3;
  record.target_position = kTurn;
  record.target_velocity = -kTurn;
  record.target_torque = -100;
  record.max_torque = 2000;
  record.profile_velocity = kTurn;
  record.profile_acceleration = kTurn;
  record.profile_deceleration = 2 * kTurn;
  record.homing_method = 35;
  record.set_position_value = -kTurn;
  const WriteBatch batch = asked(record);
  std::vector<std::pair<Quantity, std::int64_t>> setpoints;
  for (const Setpoint& each : batch.setpoints) setpoints.emplace_back(each.quantity, each.value);
  EXPECT_THAT(setpoints,
              ElementsAre(std::pair(Quantity::target_position, 10'000), std::pair(Quantity::target_velocity, -60'000),
                          std::pair(Quantity::target_torque, -100), std::pair(Quantity::max_torque, 2000),
                          std::pair(Quantity::profile_velocity, 60'000), std::pair(Quantity::profile_acceleration, 600),
                          std::pair(Quantity::profile_deceleration, 1200), std::pair(Quantity::homing_method, 35)));
  EXPECT_EQ(batch.mode, -3);
  EXPECT_EQ(batch.set_position_value, -10'000);
  EXPECT_EQ(batch.command, Command::move_absolute);
}

TEST_F(Asked, WhoAsksAndUntilWhenIsInEachBatch) {
  CommandRecord record = command(guid(1), 1, 0xABCD'0012'3456);
  const WriteBatch batch = asked(record);
  EXPECT_EQ(batch.command_id, 0x3456);
  EXPECT_GE(batch.client, ClientId{1} << 63U);
  ASSERT_TRUE(batch.life);
  EXPECT_EQ(batch.life->id, batch.client);
  EXPECT_EQ(batch.role, Role::engineer);
  EXPECT_EQ(batch.start_by, plain.now + std::chrono::milliseconds(500));
  EXPECT_EQ(batch.answer_by, plain.now + std::chrono::milliseconds(900));
  EXPECT_TRUE(batch.beats);
  EXPECT_TRUE(batch.life->strength);
}

TEST_F(Asked, WhatClaimsTheAxisIsWhatClaimsItOnModbus) {
  for (const std::uint8_t number : std::initializer_list<std::uint8_t>{1, 5, 6, 7, 8, 9, 10, 11, 12})
    EXPECT_TRUE(asked(sample(number)).claims) << int{number};
  for (const std::uint8_t number : std::initializer_list<std::uint8_t>{2, 3, 4, 13, 14, 33})
    EXPECT_FALSE(asked(sample(number)).claims) << int{number};
  for (const std::uint8_t number : std::initializer_list<std::uint8_t>{0, 2, 3, 4, 13, 14}) {
    EXPECT_TRUE(asked(sample(number, kHasTargetPosition)).claims) << int{number};
  }
}

}  // namespace
}  // namespace axisgate::dds
