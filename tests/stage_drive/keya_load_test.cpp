// SPDX-License-Identifier: Apache-2.0
// The keep-alive of one motor while many clients want the wire for everything else.
#include <gmock/gmock.h>

#include "tests/stage_drive/keya_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

class KeyaUnderLoad : public testing::TestWithParam<Speech> {
 protected:
  [[nodiscard]] KeyaOptions options() const { return {.speech = GetParam(), .keep_alive = kKeepAlivePeriod}; }
};
INSTANTIATE_TEST_SUITE_P(Speeches, KeyaUnderLoad, testing::Values(Speech::single, Speech::composed),
                         [](const auto& p) { return p.param == Speech::single ? "single" : "composed"; });

/// Clients that never rest: each asks anew as soon as it has its answer.
class Crowd {
 public:
  Crowd(KeyaRig& rig, int clients, std::function<std::pair<AxisSlot, WriteBatch>(int client, int round)> ask)
      : rig_(rig), ask_(std::move(ask)), waiting_(static_cast<std::size_t>(clients)) {}
  void run(Duration time) {
    const Instant end = rig_.runtime.now() + time;
    int round = 0;
    while (rig_.runtime.now() < end) {
      ++round;
      for (std::size_t i = 0; i < waiting_.size(); ++i) {
        if (waiting_[i] && !waiting_[i]->has_value()) continue;
        auto [slot, batch] = ask_(static_cast<int>(i), round);
        batch.client = 100 + i;
        waiting_[i] = rig_.begin(slot, batch);
      }
      rig_.run(1ms);
    }
  }

 private:
  KeyaRig& rig_;
  std::function<std::pair<AxisSlot, WriteBatch>(int, int)> ask_;
  std::vector<std::shared_ptr<std::optional<BatchResult>>> waiting_;
};

WriteBatch mailbox_read(std::uint16_t index, std::uint8_t size) {
  WriteBatch batch;
  batch.role = Role::engineer;
  batch.object = ObjectRequest{false, index, 1, size, 0};
  return batch;
}

TEST_P(KeyaUnderLoad, ThirtyTwoBusyClientsOfTheOtherMotorDelayItByNothingThatCounts) {
  KeyaRig rig(options());
  rig.online();
  rig.enable_and_run(0);
  rig.enable_and_run(1);
  rig.mark();
  Crowd crowd(rig, 32, [](int client, int round) -> std::pair<AxisSlot, WriteBatch> {
    if (client % 4 == 0) return {AxisSlot{0}, mailbox_read(static_cast<std::uint16_t>(0x3000 + round % 50), 4)};
    return {AxisSlot{1},
            KeyaRig::batch_of(Command::run_velocity, {{Quantity::target_velocity, (client + round % 10) * 10'000}})};
  });
  crowd.run(10s);
  const auto instants = rig.heard(1);
  EXPECT_GE(instants.size(), 20U);
  EXPECT_LE(longest_gap(instants), kKeepAlivePeriod);
  EXPECT_TRUE(rig.motor(0).enabled);
  EXPECT_EQ(rig.motor(0).value, kRaw150);
}

TEST_P(KeyaUnderLoad, ThirtyTwoBusyReadersDelayItByNothingThatCounts) {
  KeyaRig rig(options());
  rig.online();
  rig.enable_and_run(0);
  rig.mark();
  Crowd crowd(rig, 32, [](int client, int round) -> std::pair<AxisSlot, WriteBatch> {
    return {AxisSlot{0}, mailbox_read(static_cast<std::uint16_t>(0x3000 + 100 * client + round % 100), 4)};
  });
  crowd.run(10s);
  EXPECT_LE(longest_gap(rig.heard(1)), kKeepAlivePeriod);
  EXPECT_LE(rig.motor(0).enables, 1);
}

TEST_P(KeyaUnderLoad, AQueueThatIsFullDoesNotKeepItFromItsTurn) {
  KeyaRig rig(options());
  rig.online();
  rig.enable_and_run(0);
  rig.mark();
  Crowd crowd(rig, 72, [](int client, int round) -> std::pair<AxisSlot, WriteBatch> {
    return {AxisSlot{0}, mailbox_read(static_cast<std::uint16_t>(0x3000 + client), round % 2 == 0 ? 4 : 2)};
  });
  crowd.run(2s);
  EXPECT_LE(longest_gap(rig.heard(1)), kKeepAlivePeriod);
  EXPECT_TRUE(rig.motor(0).enabled);
}

}  // namespace
}  // namespace axisgate::test
