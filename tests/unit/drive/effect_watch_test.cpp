// SPDX-License-Identifier: Apache-2.0
// What shows a stop where a bit of the drive tells whether it moves, and its velocity tells otherwise.
#include "gateway/drive/state/effect_watch.hpp"

#include <gtest/gtest.h>

#include "gateway/profile/resolve/profile_resolve.hpp"
#include "tests/places.hpp"
#include "tests/unit/drive/alone.hpp"

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kRuns = 3, kStands = 2;  // run_state of an iD286pro
constexpr std::int64_t kFast = 6000;            // as it counts

model::DriveModel id286pro() {
  profile::ResolveInput input;
  input.protocol = "modbus-rtu";
  profile::ResolveAxis axis;
  axis.number = 1;
  input.axes = {axis};
  auto model = profile::resolve(profile::load_profile(test::source_path("schemas/drives/id286pro.json")), input);
  return std::get<model::DriveModel>(std::move(model));
}

class StopOfABit : public testing::Test {
 protected:
  void SetUp() override {
    reads(kRuns, kFast);
    watch_.sending(core_);
    after_ = store_.exchange();
  }
  /// All that its state is made of, with a speed.
  void reads(std::int64_t run_state, std::int64_t speed) {
    turn_.now += 20ms;
    store_.begin_exchange();
    for (const model::ObjectId id : core_.model.state_sources) store_.read(id, 0, turn_.now);
    store_.read(core_.motion_object(), run_state, turn_.now);
    store_.read(core_.object_of(Quantity::velocity_actual), speed, turn_.now);
    core_.refresh_virtual();
  }
  [[nodiscard]] bool shown() { return watch_.shown(core_, Effect::stop, after_); }

  model::DriveModel model_ = id286pro();
  ObjectStore store_{model_.objects};
  Turn turn_{.now = kStart, .link = LinkState::online};
  AxisRecord record_;
  AxisCore core_{model_, model_.axes[0], store_, turn_, Motion{model_.axes[0].velocity_lag, record_}};
  EffectWatch watch_;
  std::uint64_t after_ = 0;
};

TEST_F(StopOfABit, IsNotShownByItWhileTheMotorTurns) {
  EXPECT_FALSE(shown()) << "nothing was read since";
  reads(kStands, kFast);
  EXPECT_FALSE(shown());
  reads(kStands, 0);
  EXPECT_TRUE(shown());
}

TEST_F(StopOfABit, IsShownByAFallBeforeIt) {
  reads(kRuns, kFast);
  EXPECT_FALSE(shown());
  reads(kRuns, kFast / 2);
  EXPECT_TRUE(shown());
}

}  // namespace
}  // namespace axisgate::drive
