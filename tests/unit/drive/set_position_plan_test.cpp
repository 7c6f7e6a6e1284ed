// SPDX-License-Identifier: Apache-2.0
// A profile of one's own whose set_position writes the controlword, on a CiA 402 drive that stands in mode 1 with an
// old target in it: what would be sent.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "gateway/drive/plan/planner.hpp"
#include "gateway/profile/resolve/profile_resolve.hpp"
#include "tests/places.hpp"

namespace axisgate::drive {
namespace {

constexpr const char* kName = "kinco-jd";

/// The shipped profile, but for the steps of set_position.
model::DriveModel foreign(const char* steps) {
  // It extends the shipped one of its own name, which lies in another folder.
  const nlohmann::json profile{
      {"profile", 1},
      {"name", kName},
      {"extends", kName},
      {"commands", {{"set_position", {{"steps", nlohmann::json::parse(steps)}, {"zero_only", nullptr}}}}}};
  const auto folder = std::filesystem::path(testing::TempDir()) / "set_position_plan_test";
  std::filesystem::create_directories(folder);
  const std::string path = (folder / (std::string(kName) + ".json")).string();
  std::ofstream(path) << profile;
  const profile::LoadedProfile loaded = profile::load_profile(path, {test::source_path("schemas/drives")});
  if (!loaded.faults.empty()) throw std::runtime_error(text(loaded.faults.front()));
  profile::ResolveInput input;
  input.protocol = "canopen";
  input.node = 1;
  input.constants.emplace("peak_current_a", Rational(275, 10));
  profile::ResolveAxis axis;
  axis.number = 1;
  axis.name = "axis 1";
  input.axes = {axis};
  auto model = profile::resolve(loaded, input);
  if (auto* faults = std::get_if<std::vector<profile::Fault>>(&model)) throw std::runtime_error(text(faults->front()));
  return std::get<model::DriveModel>(std::move(model));
}

class SetPosition : public testing::Test {
 protected:
  static constexpr const char* kStarts =
      R"([{"write": "target_position", "value": {"quantity": "set_position_value"}},
          {"write": "controlword", "value": 15}, {"write": "controlword", "value": 31}])";

  SetPosition() : model(foreign(kStarts)), store(model.objects) {
    store.begin_exchange();
    store.read(core.model.statusword, 0x0637, turn.now);
    store.read(core.model.controlword, 0x000F, turn.now);
    in_mode(1);
    core.set_position_value = 4000;
    core.motion.enabled();
  }
  void in_mode(std::int64_t mode) {
    store.read(core.model.mode, mode, turn.now);
    if (core.model.mode_display != model::kNoObject) store.read(core.model.mode_display, mode, turn.now);
  }
  [[nodiscard]] static long place_of(const Plan& plan, model::ObjectId object, std::int64_t number) {
    const auto at = std::find_if(plan.actions.begin(), plan.actions.end(), [&](const Action& a) {
      return a.kind == Action::Kind::write && a.object == object && a.number == number;
    });
    return at == plan.actions.end() ? -1 : at - plan.actions.begin();
  }

  model::DriveModel model;
  ObjectStore store;
  Turn turn{.now = kLongAgo, .link = LinkState::online};
  AxisRecord record;
  AxisCore core{model, model.axes[0], store, turn, Motion{model.axes[0].velocity_lag, record}};
};

TEST_F(SetPosition, TheModeThatMovesIsLeftBeforeTheFirstStep) {
  const Plan before = plan_preparation(core, Command::set_position);
  ASSERT_FALSE(before.refused()) << text(before.refusal.code);
  EXPECT_GE(place_of(before, core.model.mode, 6), 0);
}

TEST_F(SetPosition, InTheModeThatMovesNothingIsSent) {
  const Plan plan = plan_set_position(core, 1);
  EXPECT_TRUE(plan.refused());
  EXPECT_TRUE(plan.actions.empty());
}

TEST_F(SetPosition, NoStartIsLeftInTheControlwordForTheModeToComeBack) {
  in_mode(6);
  const Plan plan = plan_set_position(core, 1);
  ASSERT_FALSE(plan.refused()) << text(plan.refusal.code);
  const long start = place_of(plan, core.model.controlword, 31), back = place_of(plan, core.model.mode, 1);
  ASSERT_GE(start, 0);
  ASSERT_GT(back, start);
  const auto cleared = std::any_of(plan.actions.begin() + start, plan.actions.begin() + back, [&](const Action& a) {
    return a.kind == Action::Kind::write && a.object == core.model.controlword && a.number == 15;
  });
  EXPECT_TRUE(cleared);
}

}  // namespace
}  // namespace axisgate::drive
