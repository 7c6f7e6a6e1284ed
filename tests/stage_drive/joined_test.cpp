// SPDX-License-Identifier: Apache-2.0
// Clients that ask for one thing at the same time share a bus job on the bus: what each of them is answered, and when.
// On every drive and protocol.
#include <gmock/gmock.h>

#include "tests/stage_drive/drive_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

/// Each request takes the wire for so long: less than a drive's timeout, more than the deadlines below.
constexpr Duration kSlowReply = 80ms;
constexpr ClientId kPanel = 7, kPlc = 8;

using Answer = std::shared_ptr<std::optional<BatchResult>>;

class Joined : public testing::TestWithParam<Subject> {
 protected:
  [[nodiscard]] const model::ObjectDef& object_of(Quantity quantity) {
    const model::DriveModel& model = rig.stage.gateway().drive_of(1)->model();
    const model::ObjectId id = model.axes.front().binding(quantity)->object;
    return model.object(id);
  }
  [[nodiscard]] WriteBatch reading(ClientId client, std::uint8_t size) {
    const model::ObjectDef& object = object_of(Quantity::position_actual);
    WriteBatch batch;
    batch.client = client;
    batch.object = ObjectRequest{.index = object.address.index, .subindex = object.address.sub, .size = size};
    return batch;
  }
  [[nodiscard]] static WriteBatch stopping(ClientId client) {
    WriteBatch batch = with_command(Command::quick_stop);
    batch.client = client;
    return batch;
  }
  [[nodiscard]] Instant in(Duration time) { return rig.stage.runtime().now() + time; }
  [[nodiscard]] WriteBatch read_by(ClientId client, Duration start, Duration answer) {
    WriteBatch batch = reading(client, object_of(Quantity::position_actual).size);
    batch.start_by = in(start);
    batch.answer_by = in(answer);
    return batch;
  }
  Answer begin(const WriteBatch& batch) { return rig.stage.begin(1, batch); }
  [[nodiscard]] bool comes(const Answer& answer) {
    return rig.stage.run_until([&] { return answer->has_value(); });
  }
  [[nodiscard]] static Errc code(const Answer& answer) { return (*answer)->outcome.code; }

  void reply_slowly() { reply_after(rig, kSlowReply); }
  static void reply_after(DriveRig& of, Duration delay) {
    of.stage.at_link(0, [delay](auto& link) { link.line().set_reply_delay(delay); });
  }
  /// A request has just gone out, and its answer is far away.
  void wire_is_taken() { wire_is_taken(rig); }
  static void wire_is_taken(DriveRig& of) {
    const auto sent = [&] { return of.stage.gateway().bus(0).statistics().requests; };
    const auto before = sent();
    ASSERT_TRUE(of.stage.run_until([&] { return sent() > before; }));
  }

  DriveRig rig{GetParam()};
};

TEST_P(Joined, ReadsOfTwoWidthsEachGetTheAnswerToTheirOwn) {
  rig.online();
  for (const auto& [mine, other] : {std::pair{4, 2}, std::pair{2, 4}}) {
    const BatchResult alone = rig.ask(reading(kPanel, static_cast<std::uint8_t>(other)));
    const Answer first = begin(reading(kPlc, static_cast<std::uint8_t>(mine)));
    const Answer waits = begin(reading(kPlc, static_cast<std::uint8_t>(mine)));
    const Answer joins = begin(reading(kPanel, static_cast<std::uint8_t>(other)));
    ASSERT_TRUE(comes(first) && comes(waits) && comes(joins));
    EXPECT_EQ(code(joins), alone.outcome.code) << mine << " before " << other;
    EXPECT_EQ((*joins)->object_size, alone.object_size) << mine << " before " << other;
    EXPECT_EQ((*joins)->object_data, alone.object_data) << mine << " before " << other;
  }
}

// The wire is taken for 80 ms; who would start within 20 ms has started never, and the other is served.
TEST_P(Joined, AReadIsStartedByItsOwnClientsDeadlineWhicheverCameFirst) {
  rig.online();
  reply_slowly();
  for (const bool hasty_first : {true, false}) {
    wire_is_taken();
    const WriteBatch hasty_batch = read_by(kPlc, 20ms, 900ms), patient_batch = read_by(kPanel, 600ms, 900ms);
    const Instant hasty_end = in(20ms);
    const Answer first = begin(hasty_first ? hasty_batch : patient_batch);
    const Answer second = begin(hasty_first ? patient_batch : hasty_batch);
    const Answer &hasty = hasty_first ? first : second, &patient = hasty_first ? second : first;
    ASSERT_TRUE(comes(hasty));
    EXPECT_EQ(code(hasty), Errc::never_started) << hasty_first;
    EXPECT_LE(rig.stage.runtime().now(), hasty_end + 1ms) << hasty_first;
    EXPECT_FALSE(patient->has_value()) << hasty_first;
    ASSERT_TRUE(comes(patient));
    EXPECT_EQ(code(patient), Errc::ok) << hasty_first;
  }
}

// Its request leaves after 80 ms and is answered after 160 ms.
TEST_P(Joined, AReadUnderWayIsAnsweredToEachByItsOwnDeadline) {
  rig.online();
  reply_slowly();
  for (const bool hasty_first : {true, false}) {
    wire_is_taken();
    const WriteBatch hasty_batch = read_by(kPlc, 600ms, 120ms), patient_batch = read_by(kPanel, 600ms, 900ms);
    const Instant hasty_end = in(120ms);
    const Answer first = begin(hasty_first ? hasty_batch : patient_batch);
    const Answer second = begin(hasty_first ? patient_batch : hasty_batch);
    const Answer &hasty = hasty_first ? first : second, &patient = hasty_first ? second : first;
    ASSERT_TRUE(comes(hasty));
    EXPECT_EQ(code(hasty), Errc::timed_out) << hasty_first;
    EXPECT_LE(rig.stage.runtime().now(), hasty_end + 1ms) << hasty_first;
    EXPECT_FALSE(patient->has_value()) << hasty_first;
    ASSERT_TRUE(comes(patient));
    EXPECT_EQ(code(patient), Errc::ok) << hasty_first;
  }
}

TEST_P(Joined, AReadThatNobodyWaitsForAnyMoreIsNotSent) {
  rig.online();
  reply_slowly();
  wire_is_taken();
  const auto joined = rig.stage.gateway().bus(0).statistics().coalesced;
  const auto waiting = rig.stage.gateway().bus(0).queue_depth();
  const Answer first = begin(read_by(kPlc, 600ms, 20ms));
  const Answer second = begin(read_by(kPanel, 600ms, 40ms));
  ASSERT_EQ(rig.stage.gateway().bus(0).statistics().coalesced, joined + 1);
  ASSERT_TRUE(comes(first) && comes(second));
  EXPECT_EQ(code(first), Errc::never_started);
  EXPECT_EQ(code(second), Errc::never_started);
  EXPECT_EQ(rig.stage.gateway().bus(0).queue_depth(), waiting);
}

TEST_P(Joined, AStopIsAnsweredToEachByItsOwnDeadlineAndCarriedOutAllTheSame) {
  for (const bool hasty_first : {true, false}) {
    DriveRig moving(GetParam());
    moving.bring_to(Situation::running, 700ms);
    reply_after(moving, kSlowReply);
    wire_is_taken(moving);
    const auto until = [&](Duration time) { return moving.stage.runtime().now() + time; };
    WriteBatch hasty_batch = stopping(kPlc), patient_batch = stopping(kPanel);
    hasty_batch.answer_by = until(20ms);
    patient_batch.answer_by = until(20s);
    const Instant hasty_end = until(20ms);
    const Answer first = moving.stage.begin(1, hasty_first ? hasty_batch : patient_batch);
    const Answer second = moving.stage.begin(1, hasty_first ? patient_batch : hasty_batch);
    const Answer &hasty = hasty_first ? first : second, &patient = hasty_first ? second : first;
    ASSERT_TRUE(moving.stage.run_until([&] { return hasty->has_value(); }));
    EXPECT_EQ(code(hasty), Errc::not_reached) << hasty_first << ": nothing was sent that could be lost";
    EXPECT_EQ((**hasty).outcome.detail, 0U) << hasty_first;
    EXPECT_LE(moving.stage.runtime().now(), hasty_end + 1ms) << hasty_first;
    EXPECT_FALSE(patient->has_value()) << hasty_first;
    reply_after(moving, 2ms);
    ASSERT_TRUE(moving.stage.run_until([&] { return patient->has_value(); }, 30s));
    EXPECT_EQ(code(patient), Errc::ok) << hasty_first;
    EXPECT_TRUE(moving.stage.run_until([&] { return !moving.turns(); })) << hasty_first;
  }
}

INSTANTIATE_TEST_SUITE_P(Drives, Joined, testing::ValuesIn(kSubjects), named);

}  // namespace
}  // namespace axisgate::test
