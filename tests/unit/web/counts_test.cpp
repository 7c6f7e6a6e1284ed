// SPDX-License-Identifier: Apache-2.0
// What is counted of an axis, against what its clients asked and its motor did: nothing twice, nothing that was not.
#include <gmock/gmock.h>

#include <cstdlib>

#include "gateway/image/axis_counts.hpp"
#include "tests/stage/subject.hpp"
#include "tests/unit/drive/clients.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

class Counted : public testing::TestWithParam<Subject> {
 protected:
  explicit Counted(std::optional<LeaseRules> lease = LeaseRules{.on = false}) : stage_({line_with(GetParam(), lease)}) {
    EXPECT_TRUE(stage_.come_online());
  }
  [[nodiscard]] const AxisCounts& counts() { return *stage_.axis(1).counts; }
  [[nodiscard]] std::uint32_t commands(Command command, CommandResult result) {
    const auto found = counts().commands.find({command, result});
    return found == counts().commands.end() ? 0 : found->second;
  }
  Errc ask(const std::shared_ptr<ClientLife>& who, Command command, std::vector<Setpoint> setpoints = {}) {
    who->last_request = stage_.runtime().now();
    WriteBatch batch;
    batch.client = who->id;
    batch.role = who->role;
    batch.life = who;
    batch.claims = !is_stop(command);
    batch.command = command;
    for (const Setpoint& each : setpoints) batch.setpoints.push_back(each);
    return stage_.ask(1, batch).outcome.code;
  }

  GatewayStage stage_;
  std::shared_ptr<ClientLife> plc_ = client(1, "10.0.0.1");
};

constexpr double kMicroPerTruth = 1e6 / 10'000;  // the simulated motor counts 1/10000 turn

TEST_P(Counted, TimeWithTorqueAndWayAreThoseOfItsMotor) {
  stage_.run(10s);
  EXPECT_EQ(counts().enabled, Duration{});
  ASSERT_EQ(ask(plc_, Command::enable), Errc::ok);
  const Instant enabled = stage_.runtime().now();
  const std::int64_t began = truth(stage_, GetParam()).position;
  ASSERT_EQ(ask(plc_, Command::run_velocity, {{Quantity::target_velocity, 120'000}}), Errc::ok);
  stage_.run(10s);
  const std::int64_t turned = truth(stage_, GetParam()).position;
  ASSERT_EQ(ask(plc_, Command::run_velocity, {{Quantity::target_velocity, -120'000}}), Errc::ok);
  stage_.run(10s);
  ASSERT_EQ(ask(plc_, Command::disable), Errc::ok);
  const Instant disabled = stage_.runtime().now();
  stage_.run(5s);  // it coasts
  const double way = static_cast<double>(2 * turned - began - truth(stage_, GetParam()).position) * kMicroPerTruth;
  EXPECT_NEAR(static_cast<double>(counts().travel_microturns), way, way / 20);
  EXPECT_NEAR(std::chrono::duration<double>(counts().enabled).count(),
              std::chrono::duration<double>(disabled - enabled).count(), 0.5);
  const AxisCounts standing = counts();
  stage_.run(60s);
  EXPECT_EQ(counts().travel_microturns, standing.travel_microturns);
  EXPECT_EQ(counts().enabled, standing.enabled);
}

TEST_P(Counted, EachCommandOfAClientByItsEnd) {
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(ask(plc_, Command::enable), Errc::ok);
    ASSERT_EQ(ask(plc_, Command::disable), Errc::ok);
  }
  EXPECT_EQ(ask(plc_, Command::run_velocity, {{Quantity::target_velocity, 60'000}}), Errc::state_unsuitable);
  stage_.command(1, Command::halt);
  EXPECT_EQ(commands(Command::enable, CommandResult::done), 3U);
  EXPECT_EQ(commands(Command::disable, CommandResult::done), 3U);
  EXPECT_EQ(commands(Command::run_velocity, CommandResult::state_unsuitable), 1U);
  EXPECT_EQ(counts().commands.size(), 3U) << "not what is the gateway's own, nor what is under way";
}

TEST_P(Counted, AFaultIsOneHoweverOftenItsLinkIsLost) {
  break_down(stage_, GetParam());
  ASSERT_TRUE(stage_.run_until([&] { return stage_.axis(1).has(AxisInput::fault); }));
  stage_.run(1s);
  EXPECT_EQ(counts().faults, 1U);
  stage_.at_link(0, [](auto& link) { link.unplug(); });
  stage_.run(5s);
  stage_.at_link(0, [](auto& link) { link.plug(); });
  ASSERT_TRUE(stage_.run_until([&] { return stage_.axis(1).has(AxisInput::fault); }));
  EXPECT_EQ(counts().faults, 1U);
  end_cause(stage_, GetParam());
  ASSERT_EQ(ask(plc_, Command::fault_reset), Errc::ok);
  stage_.run(1s);
  trip(stage_, GetParam());
  ASSERT_TRUE(stage_.run_until([&] { return counts().faults == 2; }));
}

TEST_P(Counted, AnotherZeroIsNoWay) {
  ASSERT_EQ(ask(plc_, Command::enable), Errc::ok);
  ASSERT_EQ(ask(plc_, Command::run_velocity, {{Quantity::target_velocity, 120'000}}), Errc::ok);
  stage_.run(5s);
  ASSERT_EQ(ask(plc_, Command::halt), Errc::ok);
  stage_.run(2s);
  ASSERT_EQ(ask(plc_, Command::enable), Errc::ok);
  const auto position = [&] { return stage_.axis(1)[Quantity::position_actual].value; };
  const std::uint64_t before = counts().travel_microturns;
  ASSERT_GT(position(), 50'000);
  ASSERT_EQ(ask(plc_, Command::set_position), Errc::ok) << "to 0, which all of these can";
  stage_.run(2s);
  ASSERT_LT(std::abs(position()), 100);
  EXPECT_EQ(counts().travel_microturns, before);
}

INSTANTIATE_TEST_SUITE_P(All, Counted, testing::Values(Subject::jd_serial, Subject::leadshine), named);

class CountedLeases : public Counted {
 protected:
  CountedLeases() : Counted(LeaseRules{}) {}
};

TEST_P(CountedLeases, ALeaseThatRunsOutIsOne) {
  ASSERT_EQ(ask(plc_, Command::enable), Errc::ok);
  EXPECT_EQ(ask(client(2, "10.0.0.2"), Command::enable), Errc::not_owner);
  EXPECT_EQ(commands(Command::enable, CommandResult::not_owner), 1U);
  EXPECT_EQ(counts().lease_expiries, 0U);
  stage_.run(10s);
  EXPECT_EQ(counts().lease_expiries, 1U);
  ASSERT_EQ(ask(plc_, Command::disable), Errc::ok);
  stage_.run(10s);
  EXPECT_EQ(counts().lease_expiries, 1U) << "it has none";
}

INSTANTIATE_TEST_SUITE_P(All, CountedLeases, testing::Values(Subject::jd_serial), named);

}  // namespace
}  // namespace axisgate::test
