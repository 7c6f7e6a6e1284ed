// SPDX-License-Identifier: Apache-2.0
// A stop is sent before what was received before it: what it has overtaken is never carried out after it.
#include "gateway/upstream/dds/stop_order.hpp"

#include <gmock/gmock.h>

#include "gateway/upstream/dds_link/command_mask.hpp"
#include "tests/unit/dds/plain_session.hpp"

namespace axisgate::dds {
namespace {

using namespace std::chrono_literals;
using test::command;
using test::guid;
using test::PlainSession;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

struct Overtaken : testing::Test {
  static constexpr std::uint8_t kEnable = 1, kDisable = 2, kQuickStop = 3, kHalt = 4, kRun = 8, kRelease = 13,
                                kJogForward = 31, kJogEnd = 33;
  static constexpr int kDone = 2, kNeverStarted = 6, kUnsuitable = 9;
  PlainSession plain{2};
  std::uint64_t id = 0;
  Overtaken() { plain.port.at_once = BatchResult{}; }
  CommandRecord received(SteadyNs at, std::uint8_t number, std::uint8_t writer = 1, AxisNumber axis = 1) {
    CommandRecord out = command(guid(writer), number, ++id, axis);
    out.received = at;
    if (number == kJogForward) {
      out.mask = kHasJogVelocity;
      out.jog_velocity = 1;
    }
    return out;
  }
  /// Its result, and whether anything came to the axis.
  int ask(const Record& record) {
    plain.port.submitted.clear();
    return plain.ask(record);
  }
  bool asked() { return !plain.port.submitted.empty(); }
  Command last() { return plain.port.submitted.back().batch.command; }
};

TEST_F(Overtaken, CommandsOfEveryWriterAreAnsweredAndNotCarriedOut) {
  EXPECT_EQ(ask(received(20, kHalt)), kDone);
  for (const std::uint8_t writer : {std::uint8_t{1}, std::uint8_t{2}}) {
    for (const std::uint8_t number : {kRun, kEnable, std::uint8_t{0}}) {
      CommandRecord record = received(10, number, writer);
      record.mask = kHasTargetVelocity;
      EXPECT_EQ(ask(record), kNeverStarted) << int{number};
      EXPECT_FALSE(asked()) << int{number};
    }
  }
  EXPECT_EQ(ask(received(21, kRun)), kDone) << "received after the stop";
  EXPECT_TRUE(asked());
}

TEST_F(Overtaken, CommandsOfAnotherAxisAreNot) {
  EXPECT_EQ(ask(received(20, kQuickStop)), kDone);
  EXPECT_EQ(ask(received(10, kRun, 1, 2)), kDone);
}

TEST_F(Overtaken, StopsAndReleasesActAllTheSame) {
  EXPECT_EQ(ask(received(20, kQuickStop)), kDone);
  for (const std::uint8_t number : {kDisable, kHalt, kJogEnd, kRelease}) {
    EXPECT_EQ(ask(received(10, number)), kDone) << int{number};
    EXPECT_TRUE(asked()) << int{number};
  }
  EXPECT_EQ(ask(received(15, kRun)), kNeverStarted) << "the newest stop counts";
}

TEST_F(Overtaken, NothingIsByAStopForAnotherGateway) {
  CommandRecord stop = received(20, kQuickStop);
  stop.gateway = gateway_id("cell_8");
  EXPECT_EQ(ask(stop), 0);
  EXPECT_EQ(ask(received(10, kRun)), kDone);
}

TEST_F(Overtaken, NothingIsWhoseTimeIsUnknown) {
  EXPECT_EQ(ask(received(20, kHalt)), kDone);
  EXPECT_EQ(ask(received(0, kRun)), kDone);
}

TEST_F(Overtaken, WritesOfObjectsAreAndReadsAreNot) {
  EXPECT_EQ(ask(received(20, kQuickStop)), kDone);
  ObjectRequestRecord object{guid(1, 2), 0, {}, 1, 3, true, 0x60FF, 0, 4, 1000, {}, 10};
  plain.port.submitted.clear();
  EXPECT_EQ(plain.ask<ObjectReplyRecord>(object), kNeverStarted);
  EXPECT_FALSE(asked());
  object.write = false;
  object.request_id = 4;
  EXPECT_EQ(plain.ask<ObjectReplyRecord>(object), kDone);
}

TEST_F(Overtaken, RosTopicsAreByStopsOfEitherKind) {
  const auto act = [&](SteadyNs at, RosAction action) {
    plain.port.submitted.clear();
    plain.session->on_record(RosActionRecord{guid(9), 0, 1, static_cast<std::uint8_t>(action), at}, plain.now);
  };
  EXPECT_EQ(ask(received(20, kQuickStop)), kDone);
  act(10, RosAction::enable);
  EXPECT_FALSE(asked());
  act(21, RosAction::enable);
  EXPECT_TRUE(asked());
  act(30, RosAction::quick_stop);
  ASSERT_TRUE(asked());
  act(29, RosAction::home);
  EXPECT_FALSE(asked());
  EXPECT_EQ(ask(received(29, kEnable)), kNeverStarted);
  act(28, RosAction::disable);
  EXPECT_TRUE(asked()) << "a stop";
}

TEST_F(Overtaken, TargetsOfAStreamAre) {
  AxisImage& axis = *plain.image.find(1);
  axis.axis_state = AxisState::standstill;
  axis.inputs = bit(AxisInput::enabled);
  JointCommandsRecord sample;
  sample.writer = guid(1);
  sample.names = {axis.name};
  sample.velocities = {0};
  sample.received = 10;
  EXPECT_EQ(ask(received(20, kHalt)), kDone);
  plain.port.submitted.clear();
  plain.session->on_record(sample, plain.now);
  EXPECT_FALSE(asked()) << "it brings no stream into step";
  sample.received = 21;
  plain.session->on_record(sample, plain.now);
  EXPECT_TRUE(asked());
}

TEST_F(Overtaken, APressIsAButtonThatIsStillHeld) {
  EXPECT_EQ(ask(received(20, kHalt, 2)), kDone);
  EXPECT_EQ(ask(received(10, kJogForward)), kNeverStarted);
  EXPECT_EQ(ask(received(21, kJogForward)), kUnsuitable) << "no new press: a stop came since its button went down";
  ASSERT_TRUE(asked());
  EXPECT_NE(last(), Command::jog_forward);
  EXPECT_EQ(ask(received(22, kJogEnd)), kDone);
  EXPECT_EQ(ask(received(23, kJogForward)), kDone);
  EXPECT_EQ(last(), Command::jog_forward);
}

TEST_F(Overtaken, APressByItsOwnReleaseIsOver) {
  EXPECT_EQ(ask(received(20, kJogEnd)), kDone);
  EXPECT_EQ(ask(received(10, kJogForward)), kNeverStarted);
  EXPECT_FALSE(asked());
  EXPECT_EQ(ask(received(21, kJogForward)), kDone);
  EXPECT_EQ(last(), Command::jog_forward) << "a new press";
}

// --- Between the two write batches of a jog --------------------------------------------------------------------------

struct BetweenItsBatches : Overtaken {
  BetweenItsBatches() {
    plain.port.at_once.reset();
    static_cast<void>(plain.read());
    plain.session->on_record(received(10, kJogForward), plain.now);
    EXPECT_THAT(plain.port.submitted, SizeIs(1)) << "its velocity first";
  }
  /// The velocity was written: what becomes of the press?
  std::vector<ReplyRecord> velocity_is_written() {
    static_cast<void>(plain.read());
    const auto on_result = plain.port.submitted.front().on_result;
    plain.port.submitted.clear();
    on_result({});
    return plain.read<ReplyRecord>();
  }
};

TEST_F(BetweenItsBatches, AStopOfAnybodyEndsIt) {
  plain.session->on_record(received(11, kHalt, 2), plain.now);
  EXPECT_THAT(velocity_is_written(), ElementsAre(ReplyRecord{1, 1, guid(1), kNeverStarted, 0}));
  EXPECT_THAT(plain.port.submitted, IsEmpty());
  plain.port.at_once = BatchResult{};
  EXPECT_EQ(ask(received(12, kJogForward)), kUnsuitable) << "the button is held still";
}

TEST_F(BetweenItsBatches, ItsOwnReleaseEndsIt) {
  plain.session->on_record(received(11, kJogEnd), plain.now);
  EXPECT_THAT(velocity_is_written(), ElementsAre(ReplyRecord{1, 1, guid(1), kNeverStarted, 0}));
  EXPECT_THAT(plain.port.submitted, IsEmpty());
}

TEST_F(BetweenItsBatches, AStopOfAModbusClientEndsIt) {
  plain.image.find(1)->record.stopped(77);
  EXPECT_THAT(velocity_is_written(), ElementsAre(ReplyRecord{1, 1, guid(1), kNeverStarted, 0}));
  EXPECT_THAT(plain.port.submitted, IsEmpty());
}

TEST_F(Overtaken, AJogThatAStopHasDroppedIsAButtonThatIsStillHeld) {
  for (const Errc code : {Errc::dropped_by_stop, Errc::stopped_by_other}) {
    plain.port.at_once.reset();
    CommandRecord press = command(guid(1), kJogForward, ++id);
    plain.port.submitted.clear();
    plain.session->on_record(press, plain.now);
    ASSERT_THAT(plain.port.submitted, SizeIs(1));
    plain.port.submitted.front().on_result({{code, 0}});
    plain.port.at_once = BatchResult{};
    EXPECT_EQ(ask(received(0, kJogForward)), kUnsuitable);
    EXPECT_NE(last(), Command::jog_forward);
    EXPECT_EQ(ask(received(0, kJogEnd)), kDone);
  }
}

}  // namespace
}  // namespace axisgate::dds
