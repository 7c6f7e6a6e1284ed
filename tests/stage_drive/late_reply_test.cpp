// SPDX-License-Identifier: Apache-2.0
// Late replies meet a resynchronisation read (design 7, point 4), and an unresponsive drive costs its
// neighbours little (point 7; design 8, P3).
#include <gmock/gmock.h>

#include "gateway/image/shown.hpp"
#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::DriveFault;
using enum Situation;

TEST(LateReply, TheNextExchangeIsAResynchronisationReadThatNoLostReplyCanPassFor) {
  Rig rig(KincoType::jd);
  rig.bring_to(disabled);
  rig.faults().next(DriveFault::unresponsive, 2);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().link_state == LinkState::suspect; }));
  const auto lost = decoded(kLongAgo, rig.stage.link(0).sent.end()[-2].bytes);
  const auto resync = decoded(kLongAgo, rig.stage.link(0).sent.back().bytes);
  EXPECT_FALSE(resync.write);
  EXPECT_NE(resync.index, lost.index);
  rig.stage.run(101ms);
  const auto second = decoded(kLongAgo, rig.stage.link(0).sent.back().bytes);
  EXPECT_NE(second.index, resync.index);
  EXPECT_NE(second.index, lost.index);
  EXPECT_TRUE(rig.stage.run_until([&] { return rig.axis().link_state == LinkState::online; }, 50ms));
}

TEST(LateReply, NoValueOfASuspectDriveIsShown) {
  Rig rig(KincoType::jd);
  rig.bring_to(running);
  rig.faults().late_by = 150ms;
  rig.faults().next(DriveFault::late, 2);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().link_state == LinkState::suspect; }));
  const auto before = rig.axis()[Quantity::position_actual].at;
  rig.stage.run_until([&] { return rig.axis().link_state == LinkState::online; }, 2s);
  const Instant online = rig.stage.runtime().now();
  // What is shown from now on was asked for after the resynchronisation read was answered.
  rig.stage.run(100ms);
  const auto after = rig.axis()[Quantity::position_actual].at;
  EXPECT_TRUE(after == before || after >= online - 5ms);
  EXPECT_NEAR(static_cast<double>(rig.axis()[Quantity::position_actual].value),
              static_cast<double>(rig.motor().position()), 2'000);
}

TEST(LateReply, TwoResynchronisationReadsAndTheDriveIsOffline) {
  Rig rig(KincoType::jd);
  rig.bring_to(disabled);
  rig.faults().set_rate(DriveFault::unresponsive, 1);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().link_state == LinkState::suspect; }));
  rig.mark();
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().link_state == LinkState::offline; }, 250ms));
  rig.stage.run(400ms);
  EXPECT_LE(rig.requests().size(), 2U) << "the second resynchronisation read, then silence until the first probe";
  EXPECT_EQ(shown_value(rig.axis(), Quantity::statusword), 0);
  EXPECT_EQ(rig.axis().valid_bits(), 0U);
}

TEST(LateReply, AnErrorAnswerIsNoAnsweredResynchronisationRead) {
  Rig rig(KincoType::jd);
  rig.bring_to(disabled);
  rig.faults().next(DriveFault::unresponsive);
  int refused = 0;
  rig.stage.link(0).on_traffic = [&](bool to_drive, Bytes) {
    if (!to_drive || rig.axis().link_state != LinkState::suspect || refused > 0) return;
    ++refused;
    rig.stage.link(0).fate = SimLink::Fate::refused;
  };
  ASSERT_TRUE(rig.stage.run_until([&] { return refused == 1; }));
  const auto first = decoded(kLongAgo, rig.stage.link(0).sent.back().bytes);
  rig.mark();
  EXPECT_TRUE(rig.stage.run_until([&] { return rig.axis().link_state == LinkState::online; }, 700ms));
  const auto after = rig.requests();
  ASSERT_FALSE(after.empty());
  EXPECT_FALSE(after.front().write);
  EXPECT_NE(after.front().index, first.index) << "another candidate";
}

TEST(LateReply, ABatchWaitsBehindTheResynchronisationReadAndIsThenCarriedOut) {
  Rig rig(KincoType::jd);
  rig.bring_to(suspect);
  const auto place = rig.stage.begin(1, setpoints({{Quantity::profile_velocity, 111'000}}));
  ASSERT_TRUE(rig.stage.run_until([&] { return place->has_value(); }));
  EXPECT_EQ((*place)->outcome.code, Errc::ok);
  for (const WireRequest& r : rig.requests()) {
    if (r.write) break;
    EXPECT_NE(r.index, kStatusword) << "no plain read before the resynchronisation read is answered";
  }
}

TEST(UnresponsiveDrive, ABatchThatWasNeverSentGetsOfflineAndOneThatWasGetsUnknown) {
  Rig rig(KincoType::jd);
  rig.bring_to(enabled);
  const auto sent = rig.stage.begin(1, setpoints({{Quantity::profile_velocity, 111'000}}));
  const auto waiting = rig.stage.begin(1, with_command(Command::enable));
  ASSERT_TRUE(rig.stage.run_until([&] { return !rig.writes().empty(); }));
  rig.faults().set_rate(DriveFault::unresponsive, 1);
  rig.stage.run(700ms);
  ASSERT_TRUE(sent->has_value() && waiting->has_value());
  EXPECT_EQ((*sent)->outcome.code, Errc::link_lost);
  EXPECT_EQ((*waiting)->outcome.code, Errc::offline);
}

TEST(Link, ALossAnswersEveryBatchAtOnce) {
  Rig rig(KincoType::jd);
  rig.bring_to(enabled);
  const auto sent = rig.stage.begin(1, setpoints({{Quantity::profile_velocity, 111'000}}));
  const auto waiting = rig.stage.begin(1, with_command(Command::enable));
  const auto read_only = rig.stage.begin(1, [] {
    WriteBatch g;
    g.object = ObjectRequest{false, 0x2601, 0, 2, 0};
    return g;
  }());
  ASSERT_TRUE(rig.stage.run_until([&] { return !rig.writes().empty(); }));
  rig.stage.link(0).unplug();
  rig.stage.run(1ms);
  ASSERT_TRUE(sent->has_value() && waiting->has_value() && read_only->has_value());
  EXPECT_EQ((*sent)->outcome.code, Errc::link_lost);
  EXPECT_EQ((*waiting)->outcome.code, Errc::offline);
  EXPECT_EQ((*read_only)->outcome.code, Errc::offline);
  rig.stage.link(0).plug();
  EXPECT_TRUE(rig.stage.run_until([&] { return rig.axis().link_state == LinkState::online; }, 5s));
}

TEST(UnresponsiveDrive, CostsItsNeighbourOneTimeoutPerBackOffStep) {
  GatewayStage stage({line_of_mds(2, 5ms)});
  ASSERT_TRUE(stage.come_online());
  stage.link(0).line().faults(1).set_rate(DriveFault::unresponsive, 1);
  stage.run(60s);
  ASSERT_EQ(stage.axis(2).link_state, LinkState::offline);
  const auto before = stage.link(0).sent.size();
  std::vector<Duration> latencies;
  for (int i = 0; i < 400; ++i) {
    const Instant asked = stage.runtime().now();
    const auto place = stage.begin(1, setpoints({{Quantity::profile_velocity, 100'000 + i}}));
    ASSERT_TRUE(stage.run_until([&] { return place->has_value(); }));
    latencies.push_back(stage.runtime().now() - asked);
    stage.run(std::chrono::milliseconds(i % 37));
  }
  std::ranges::sort(latencies);
  EXPECT_LE(latencies[200], 17ms) << "the write, the statusword, and perhaps a poll on the wire";
  EXPECT_LE(latencies.back(), 17ms + 100ms + 20ms) << "at worst its own plus one probe";
  std::size_t probes = 0;
  for (std::size_t i = before; i < stage.link(0).sent.size(); ++i) probes += stage.link(0).sent[i].bytes[0] == 2;
  EXPECT_LE(probes, 2U) << "each 20 s with a timeout of 100 ms";
  stage.link(0).line().faults(1).clear();
  EXPECT_TRUE(stage.run_until([&] { return stage.axis(2).link_state == LinkState::online; }, 25s));
}

}  // namespace
}  // namespace axisgate::test
