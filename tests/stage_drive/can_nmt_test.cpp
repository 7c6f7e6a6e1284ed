// SPDX-License-Identifier: Apache-2.0
// Nodes that are not operational though they were told to be: a start that was lost, a foreign master's commands. What
// a client sees, and what reaches the node whose motor may be enabled. On every drive that speaks CANopen.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/stage_drive/can_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::NmtState;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::array kNodes{Subject::leadshine, Subject::jd_can, Subject::md_can, Subject::keya_canopen_speed};

constexpr std::uint8_t kStart = 0x01, kStop = 0x02, kEnterPreOperational = 0x80;

bool starts_a_node(const can::CanFrame& frame) { return frame.id == 0 && frame.data[0] == kStart; }

class CanNodeState : public testing::TestWithParam<Subject> {
 protected:
  /// The next so many starts that we send reach nobody.
  void lose_starts(int count) {
    // Off the bus for as long as that frame takes.
    static constexpr Duration kFrame = 200us;
    back_ = rig.stage.runtime().make_timer([this] {
      rig.stage.can_link(0).advance_drives();
      rig.line().connect(0, true);
    });
    rig.stage.can_link(0).on_traffic = [this, count](bool to_drive, const can::CanFrame& frame) mutable {
      if (!to_drive || !starts_a_node(frame) || count-- <= 0) return;
      rig.line().connect(0, false);
      back_->expires_at(rig.stage.runtime().now() + kFrame);
    };
  }
  /// Another master's command, now.
  void foreign(std::uint8_t command) {
    simulated::BusFrame nmt;
    nmt.size = 2;
    nmt.data = {command, 0x01};
    rig.line().from_host(nmt, rig.stage.can_link(0).time_of(rig.stage.runtime().now()));
  }
  [[nodiscard]] bool operational() { return rig.node().state() == NmtState::operational; }
  [[nodiscard]] bool comes_back(Duration limit = 20s) {
    return rig.stage.run_until([&] { return operational() && is_good(); }, limit);
  }
  [[nodiscard]] bool is_good() {
    return rig.axis().link_state == LinkState::online && rig.axis()[Quantity::position_actual].valid;
  }
  [[nodiscard]] std::size_t starts() {
    const auto nmt = rig.nmt();
    return static_cast<std::size_t>(std::count(nmt.begin(), nmt.end(), "01 01"));
  }
  void runs() {
    rig.enable();
    ASSERT_EQ(rig.stage.write(1, Quantity::target_velocity, 60'000).outcome.code, Errc::ok);
    ASSERT_EQ(rig.stage.command(1, Command::run_velocity).outcome.code, Errc::ok);
    rig.stage.run(1s);
  }
  [[nodiscard]] std::int64_t position() { return rig.axis()[Quantity::position_actual].value; }

  CanRig rig{std::vector{GetParam()}};

 private:
  std::unique_ptr<Timer> back_;
};

INSTANTIATE_TEST_SUITE_P(Drives, CanNodeState, testing::ValuesIn(kNodes), named);

TEST_P(CanNodeState, OneLostStartIsNoticedByTheSignsOfLifeAndMadeGood) {
  lose_starts(1);
  rig.online();
  EXPECT_TRUE(comes_back());
  EXPECT_THAT(rig.nmt(), ElementsAre("80 01", "01 01", "80 01", "01 01"));
  EXPECT_TRUE(rig.told("the node is pre-operational"));
  rig.stage.run(30s);
  EXPECT_EQ(starts(), 2U) << "and then it is left alone";
}

// Each change alone was told: of a node that had said so before, nothing was heard ever after.
TEST_P(CanNodeState, OneLostStartIsNoticedAlsoOfANodeThatWasHeardBeforeIt) {
  lose_starts(1);
  rig.line().set_reply_delay(50ms);  // the bring-up takes longer than a heartbeat's period
  rig.online();
  EXPECT_TRUE(comes_back(60s));
  EXPECT_EQ(starts(), 2U);
}

TEST_P(CanNodeState, AStartThatIsLostAgainAndAgainIsTriedMoreAndMoreSeldomAndTheNodeIsPolled) {
  lose_starts(1000);
  rig.online();
  rig.stage.run(10s);
  int good = 0;
  for (int i = 0; i < 1000; ++i) {
    rig.stage.run(50ms);
    good += is_good();
  }
  EXPECT_LE(starts(), 10U) << "in a minute";
  EXPECT_GT(good, 900) << "between the tries its values are good";
  lose_starts(0);
  EXPECT_TRUE(comes_back(60s));
}

TEST_P(CanNodeState, AForeignCommandBeforeTheFirstSignOfLifeIsNoticed) {
  int frames = 0;
  rig.stage.can_link(0).on_traffic = [&](bool to_drive, const can::CanFrame& frame) {
    frames += to_drive && starts_a_node(frame);
  };
  ASSERT_TRUE(rig.settles([&] { return frames > 0; }));
  ASSERT_TRUE(rig.settles([&] { return operational(); }));
  foreign(kEnterPreOperational);
  ASSERT_TRUE(rig.settles([&] { return !operational(); }));
  EXPECT_TRUE(comes_back());
}

TEST_P(CanNodeState, AStoppedNodeIsNoticedAlsoBeforeTheFirstSignOfLife) {
  ASSERT_TRUE(rig.settles([&] { return operational(); }));
  foreign(kStop);
  ASSERT_TRUE(rig.settles([&] { return !operational(); }));
  EXPECT_TRUE(comes_back(60s));
}

TEST_P(CanNodeState, WhileItsMotorIsEnabledItIsPolledAndGetsNoNmtCommand) {
  rig.online();
  ASSERT_TRUE(comes_back());
  runs();
  rig.mark();
  foreign(kEnterPreOperational);
  // Noticed by its next sign of life, a second away at most.
  ASSERT_TRUE(rig.settles([&] { return rig.told("the node is pre-operational"); }));
  for (int i = 0; i < 50; ++i) {
    const std::int64_t before = position();
    rig.stage.run(100ms);
    ASSERT_TRUE(rig.axis()[Quantity::position_actual].valid) << i;
    ASSERT_NE(position(), before) << i << ": it runs, and what is shown follows";
    ASSERT_TRUE(rig.axis().has(AxisInput::enabled)) << i;
  }
  EXPECT_THAT(rig.nmt(), IsEmpty());
  EXPECT_FALSE(operational());
  ASSERT_EQ(rig.stage.command(1, Command::disable).outcome.code, Errc::ok);
  EXPECT_TRUE(comes_back());
  EXPECT_THAT(rig.nmt(), ElementsAre("80 01", "01 01"));
}

TEST_P(CanNodeState, NoProcessValueOfANodeThatLeftOperationalIsShownAsGood) {
  rig.online();
  ASSERT_TRUE(comes_back());
  runs();
  foreign(kEnterPreOperational);
  bool told = false;
  rig.stage.run_until([&] {
    // At the very moment it is known: nothing but what was asked for since.
    told = rig.told("the node is pre-operational");
    return told;
  });
  ASSERT_TRUE(told);
  const auto& position = rig.axis()[Quantity::position_actual];
  EXPECT_TRUE(!position.valid || rig.stage.runtime().now() - position.at < 20ms);
}

}  // namespace
}  // namespace axisgate::test
