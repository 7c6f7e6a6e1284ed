// SPDX-License-Identifier: Apache-2.0
// Another master on the CAN bus, while motors run: what it changes in a drive moves nothing that a client has not asked
// for, and keeps no stop from acting.
#include <gtest/gtest.h>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kNmt = 0, kSdoRequest = 0x601;  // CiA 301 7.3.3: of node 1
constexpr std::uint8_t kResetCommunication = 0x82;

constexpr bool is_canopen_402(Subject s) {
  return s == Subject::jd_can || s == Subject::md_can || s == Subject::leadshine;
}

class ForeignMaster : public testing::TestWithParam<Subject> {
 protected:
  void ready(PlantOptions options = {}) {
    plant_.emplace(GetParam(), std::move(options));
    plant_->ready();
  }
  void sends(std::uint32_t id, const std::vector<std::uint8_t>& bytes) { plant_->other_master_sends(id, bytes); }
  /// 4 bytes, expedited (CiA 301 7.2.4.3.3).
  void writes(std::uint16_t index, std::uint32_t value) {
    const auto byte = [](std::uint32_t from, int at) { return static_cast<std::uint8_t>(from >> (8 * at)); };
    sends(kSdoRequest,
          {0x23, byte(index, 0), byte(index, 1), 0, byte(value, 0), byte(value, 1), byte(value, 2), byte(value, 3)});
    plant_->run(50ms);
  }
  /// A motor whose drive was told to begin its communication anew, which ends no motion.
  void runs_and_communication_begins_anew(std::int64_t command) {
    ASSERT_EQ(
        command == kMove ? plant_->a.row(row::target_position, kEndless) : plant_->a.row(row::target_velocity, kSpeed),
        kOk);
    ASSERT_EQ(plant_->a.command(command), kOk);
    ASSERT_TRUE(plant_->turns_within(1s));
    sends(kNmt, {kResetCommunication, 1});
    ASSERT_TRUE(plant_->stage.run_until([this] { return plant_->logged("the drive has restarted"); }, 3s));
    ASSERT_TRUE(plant_->stage.run_until([this] { return plant_->stage.axis(1).link_state == LinkState::online; }, 5s));
    ASSERT_TRUE(plant_->turns_within(100ms));
  }
  void jogs() {
    ASSERT_EQ(plant_->a.row(row::jog_velocity, kSpeed), kOk);
    ASSERT_EQ(plant_->a.coil(coil::jog_forward, false), kOk);
    ASSERT_EQ(plant_->a.coil(coil::jog_forward, true), kOk);
    ASSERT_TRUE(plant_->turns_within(1s));
  }
  /// Its button.
  void hold_for(Duration time) { plant_->scan(plant_->a, one_coil(coil::jog_forward, true), time); }
  std::optional<Plant> plant_;
};

// JD 2.3: after its communication has begun it heeds no controlword before the first one, which is 6.
TEST_P(ForeignMaster, AStopEndsAMotionAlsoWhereCommunicationHasBegunAnew) {
  for (const std::int64_t motion : {kRun, kMove})
    for (const std::int64_t stop : {kQuickStop, kHalt, kDisable}) {
      SCOPED_TRACE(std::to_string(motion) + ", " + std::to_string(stop));
      ready();
      runs_and_communication_begins_anew(motion);
      EXPECT_EQ(plant_->b.command(stop), kOk);
      EXPECT_TRUE(plant_->comes_to_stand());
    }
}

TEST_P(ForeignMaster, AStoppingControlwordDoesAsWell) {
  for (const std::int64_t word : {2, 0, 6}) {
    SCOPED_TRACE(word);
    ready();
    runs_and_communication_begins_anew(kRun);
    EXPECT_EQ(plant_->a.row(row::controlword, word), kOk);
    EXPECT_TRUE(plant_->comes_to_stand());
  }
}

TEST_P(ForeignMaster, ALeaseThatRunsOutDoesAsWell) {
  ready(with_leases());
  runs_and_communication_begins_anew(kRun);
  plant_->a.disconnect();
  EXPECT_TRUE(plant_->comes_to_stand(6s));
}

// A start went by what the drive had acknowledged to us, however long ago.
TEST_P(ForeignMaster, AMoveEndsAtItsOwnTargetAndAtItsOwnSpeedWhateverTheDriveWasTold) {
  constexpr std::uint16_t kTargetPosition = 0x607A, kProfileVelocity = 0x6081;
  ready();
  ASSERT_EQ(plant_->a.row(row::profile_velocity, kSpeed), kOk);
  ASSERT_EQ(plant_->a.row(row::target_position, kNear), kOk);
  ASSERT_EQ(plant_->a.command(kMove), kOk);
  ASSERT_LE(std::abs(plant_->comes_to_rest_at() - kNear), kClose);
  ASSERT_EQ(plant_->a.command(0), kOk);
  ASSERT_EQ(plant_->a.row(row::target_position, 0), kOk);
  writes(kTargetPosition, 3'000'000);
  writes(kProfileVelocity, 30'000'000);
  ASSERT_EQ(plant_->a.command(kMove), kOk);
  std::int64_t fastest = 0;
  for (int i = 0; i < 300; ++i) {
    plant_->run(10ms);
    fastest = std::max(fastest, std::abs(plant_->velocity()));
  }
  EXPECT_LE(std::abs(plant_->comes_to_rest_at()), kClose);
  EXPECT_LE(fastest, kSpeed + kSpeed / 50);
}

// As after a restart that nobody has seen: 3.4 wants the method "written or configured since bring-up".
TEST_P(ForeignMaster, AHomingGoesByNoMethodThatTheDriveDoesNotHoldAnyMore) {
  constexpr std::int64_t kHomeSwitch = 19;  // CiA 402, as 17
  constexpr std::uint8_t kNegativeLimit = 17;
  ready();
  ASSERT_EQ(plant_->a.row(row::homing_method, kHomeSwitch), kOk);
  plant_->run(1s);
  sends(kSdoRequest, {0x2F, 0x98, 0x60, 0, kNegativeLimit, 0, 0, 0});
  plant_->run(1s);
  EXPECT_EQ(plant_->a.command(kHome).exception, kBadValue);
  plant_->run(500ms);
  EXPECT_TRUE(plant_->stands());
  EXPECT_EQ(plant_->a.row(row::homing_method, kHomeSwitch), kOk);
  ASSERT_EQ(plant_->a.command(0), kOk);
  EXPECT_EQ(plant_->a.command(kHome), kOk);
}

// The jog had ended with the boot-up, and its motor turned on: no button was known to be held any more.
TEST_P(ForeignMaster, AJogEndsWithItsButtonAlsoWhereCommunicationHasBegunAnew) {
  for (const bool lets_go : {true, false})
    for (const Duration after : {20ms, 150ms, 1000ms}) {
      SCOPED_TRACE(std::to_string(after / 1ms) + (lets_go ? " ms, let go" : " ms, not written any more"));
      ready();
      jogs();
      sends(kNmt, {kResetCommunication, 1});
      hold_for(after);
      if (lets_go) {
        EXPECT_EQ(plant_->a.coil(coil::jog_forward, false), kOk);
      }
      EXPECT_TRUE(plant_->comes_to_stand(4s));
      plant_->run(1s);
      EXPECT_TRUE(plant_->stands());
    }
}

TEST_P(ForeignMaster, AButtonThatIsLetGoEndsWhatWasEnabledAnewInItsJog) {
  constexpr std::uint32_t kControlword = 0x6040, kDisabled = 6, kEnabled = 15;
  ready();
  jogs();
  for (const std::uint32_t word : {kDisabled, kEnabled}) {
    sends(kSdoRequest, {0x2B, kControlword & 0xFF, kControlword >> 8, 0, static_cast<std::uint8_t>(word), 0, 0, 0});
    hold_for(500ms);
  }
  EXPECT_EQ(plant_->a.coil(coil::jog_forward, false), kOk);
  EXPECT_TRUE(plant_->comes_to_stand());
}

INSTANTIATE_TEST_SUITE_P(Every, ForeignMaster, testing::ValuesIn(subjects(is_canopen_402)), named);

}  // namespace
}  // namespace axisgate::test::obey
