// SPDX-License-Identifier: Apache-2.0
// A reload beside commands that are under way: refused or done, each of them has the answer it would have had.
#include "gateway/compose/bus_release.hpp"

#include <gmock/gmock.h>

#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr Duration kInTime = 2 * compose::kBusReleaseStep + 10ms;
using Reasons = GatewayStage::Reasons;

/// Two Kinco JD, each on a line of its own.
struct TwoBuses {
  TwoBuses() { EXPECT_TRUE(stage.come_online()); }

  [[nodiscard]] std::shared_ptr<std::optional<Reasons>> begin_reload() {
    return stage.begin_reload([](config::Config& config) {
      for (config::BusConfig& bus : config.buses) bus.timeout += 1ms;
    });
  }
  [[nodiscard]] std::shared_ptr<std::optional<BatchResult>> begin_enable() {
    WriteBatch batch;
    batch.command = Command::enable;
    return stage.begin(1, batch);
  }
  [[nodiscard]] Reasons ended(const std::shared_ptr<std::optional<Reasons>>& told) {
    EXPECT_TRUE(stage.run_until([&] { return told->has_value(); }, kInTime));
    return told->value_or(Reasons{"it never ended"});
  }
  [[nodiscard]] Errc result_of(const std::shared_ptr<std::optional<BatchResult>>& asked) {
    EXPECT_TRUE(stage.run_until([&] { return asked->has_value(); }));
    return asked->value_or(BatchResult{}).outcome.code;
  }

  GatewayStage stage{[] {
    std::vector<GatewayStage::Line> lines{line_of(simulated::KincoType::jd, 1), line_of(simulated::KincoType::jd, 2)};
    lines[0].name = "one";
    lines[1].name = "two";
    for (GatewayStage::Line& line : lines) line.options.baud = 38400;
    return lines;
  }()};
};

/// So far a command may be when the reload begins.
constexpr auto kSoFar = {0ms, 1ms, 3ms, 6ms, 10ms, 20ms};

TEST(LettingGo, AnEnabledAxisElsewhereRefusesItAndBreaksOffNoCommand) {
  for (const Duration so_far : kSoFar) {
    TwoBuses plant;
    ASSERT_EQ(plant.stage.command(2, Command::enable).outcome.code, Errc::ok);
    const auto enable = plant.begin_enable();
    plant.stage.run(so_far);
    EXPECT_THAT(plant.ended(plant.begin_reload()), testing::Contains(HasSubstr("axis 2 (axis 2) has torque")));
    EXPECT_EQ(plant.result_of(enable), Errc::ok);
  }
}

TEST(LettingGo, AnEnableThatIsUnderWayIsAwaitedAndRefusesIt) {
  for (const Duration so_far : kSoFar) {
    TwoBuses plant;
    const auto enable = plant.begin_enable();
    plant.stage.run(so_far);
    EXPECT_THAT(plant.ended(plant.begin_reload()), testing::ElementsAre(HasSubstr("axis 1 (axis 1) has torque")));
    EXPECT_EQ(plant.result_of(enable), Errc::ok);
  }
}

TEST(LettingGo, AParameterThatIsUnderWayIsAwaitedAndTheReloadGoesOn) {
  for (const Duration so_far : kSoFar) {
    TwoBuses plant;
    WriteBatch batch;
    batch.setpoints.push_back({Quantity::profile_acceleration, 4321});
    const auto write = plant.stage.begin(1, batch);
    plant.stage.run(so_far);
    EXPECT_EQ(plant.ended(plant.begin_reload()), Reasons{});
    EXPECT_EQ(plant.result_of(write), Errc::ok);
  }
}

// A client that is never done: no write of it is broken off, and whoever reloads is told.
TEST(LettingGo, AnAxisThatIsWrittenToWithoutAPauseRefusesIt) {
  TwoBuses plant;
  GatewayStage& stage = plant.stage;
  std::uint32_t value = 5000;
  std::vector<std::shared_ptr<std::optional<BatchResult>>> writes;
  const auto keep_two_under_way = [&] {
    const auto open = std::ranges::count_if(writes, [](const auto& each) { return !each->has_value(); });
    for (auto more = open; more < 2; ++more) {
      WriteBatch batch;
      batch.role = Role::engineer;
      const auto index = static_cast<std::uint16_t>(0x6083 + value % 2);  // one that waits is not superseded
      batch.object = ObjectRequest{.write = true, .index = index, .size = 4, .data = value++};
      writes.push_back(stage.begin(1, batch));
    }
  };
  keep_two_under_way();
  stage.run(1ms);
  const auto told = plant.begin_reload();
  for (Duration passed{}; !told->has_value() && passed < kInTime; passed += 1ms) {
    keep_two_under_way();
    stage.run(1ms);
  }
  EXPECT_THAT(plant.ended(told), testing::ElementsAre(HasSubstr("axis 1 (axis 1) carries out commands all the time")));
  for (const auto& each : writes) EXPECT_EQ(plant.result_of(each), Errc::ok);
}

}  // namespace
}  // namespace axisgate::test
