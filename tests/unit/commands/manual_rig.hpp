// SPDX-License-Identifier: Apache-2.0
// An axis, as the plan of a command by hand sees it, and what that plan writes: answered when a test says so.
// Promises that signs of life are answered in their turn and counted apart. Never answers anything else by itself.
#pragma once

#include <gmock/gmock.h>

#include <deque>
#include <utility>

#include "gateway/commands/manual/plan/manual_plan.hpp"

namespace axisgate::commands {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using What = ManualWrite::What;
using Exception = ModbusException;

inline constexpr Duration kMs = std::chrono::milliseconds(1);

inline ManualWrite stop(Command command) { return {.what = What::stop, .command = command}; }
inline ManualWrite command(Command command, std::uint16_t id) {
  return {.what = What::command, .command = command, .id = id};
}
inline ManualWrite coil(std::uint16_t offset, bool on) { return {.what = What::coil, .coil = offset, .on = on}; }

class ByHand : public ::testing::Test {
 protected:
  void begin(ManualTask task, bool enable = true) {
    arguments_.task = task;
    arguments_.axis = 4;
    arguments_.turns = Rational(5, 2);
    arguments_.enable = enable;
    plan_.emplace(arguments_, now_);
    box_.clear();
    unanswered_.clear();
    view_ = {};
    view_.link = LinkState::online;
    view_.state = AxisState::disabled;
    view_.command_id_seen = 40;
    view_.turns = 0.0;
    view_.inputs = bit(AxisInput::online);
  }
  void set(AxisInput input, bool on = true) {
    view_.inputs = static_cast<std::uint16_t>(on ? view_.inputs | bit(input) : view_.inputs & ~bit(input));
  }
  void look() {
    carry();
    plan_->on_view(view_, plan_->answered(), now_);
  }
  /// What the plan has written is on its way; signs of life are answered in their turn.
  void carry() {
    for (const ManualWrite& write : plan_->take()) {
      unanswered_.push_back(write.what);
      if (write.what == What::heartbeat)
        ++beats_;
      else
        box_.push_back(write);
    }
    while (!unanswered_.empty() && unanswered_.front() == What::heartbeat) {
      unanswered_.pop_front();
      plan_->on_answer(Exception::none, now_);
    }
  }
  /// Whatever was written.
  void answer_unseen() {
    static_cast<void>(written());
    answer();
  }
  void answer(Exception exception = Exception::none) {
    carry();
    ASSERT_FALSE(unanswered_.empty());
    const What what = unanswered_.front();
    unanswered_.pop_front();
    plan_->on_answer(exception, now_);
    carry();
    // The look behind it shows its result.
    const bool sets = what == What::target_position || what == What::profile_velocity || what == What::jog_velocity;
    if (sets && looks_at_set_points_ && exception == Exception::none) look();
  }
  /// What is written now, signs of life left out.
  std::vector<ManualWrite> written() {
    carry();
    return std::exchange(box_, {});
  }
  /// In steps, as a loop does it.
  void pass(Duration time) {
    for (const Instant until = now_ + time; now_ < until;) {
      now_ += 10 * kMs;
      if (plan_->due() <= now_) plan_->on_time(now_);
    }
  }
  void press(ManualKey key) { plan_->on_keys({key}, now_); }
  /// Up to the answer that the axis is enabled.
  void enabled() {
    look();
    EXPECT_THAT(written(), ElementsAre(command(Command::none, 41)));
    answer();
    EXPECT_THAT(written(), ElementsAre(command(Command::enable, 42)));
    answer();
    set(AxisInput::enabled);
    view_.owner = 1;
    view_.lease_remaining_ms = 2000;
    look();
  }
  void moving() {
    begin(ManualTask::move);
    enabled();
    EXPECT_THAT(written(), ElementsAre(ManualWrite{.what = What::target_position, .number = Rational(5, 2)}));
    answer();
    EXPECT_THAT(written(), ElementsAre(command(Command::move_absolute, 43)));
    answer();
    set(AxisInput::moving);
    view_.motion_id = 43;
    view_.motion = MotionState::active;
    look();
    EXPECT_THAT(written(), IsEmpty());
  }
  void jogging() {
    begin(ManualTask::jog);
    enabled();
    EXPECT_THAT(written(), ElementsAre(coil(8, false), coil(9, false)));
    answer();
    answer();
    look();
  }
  void stand() {
    set(AxisInput::moving, false);
    pass(ManualPlan::kStill + 10 * kMs);
    look();
  }
  /// Its torque goes back, its lease goes back.
  void given_back(std::uint16_t id) {
    EXPECT_THAT(written(), ElementsAre(stop(Command::disable)));
    answer();
    EXPECT_THAT(written(), ElementsAre(command(Command::release, id)));
    EXPECT_FALSE(plan_->over());
    answer();
    EXPECT_TRUE(plan_->over());
  }
  void stopped_and_given_back(std::uint16_t id) {
    EXPECT_THAT(written(), ElementsAre(stop(Command::quick_stop)));
    answer();
    look();
    EXPECT_THAT(written(), IsEmpty()) << "torque that is taken from a motor that turns lets it coast";
    stand();
    given_back(id);
    EXPECT_EQ(plan_->exit_code(), 1);
  }

  ManualArguments arguments_;
  std::optional<ManualPlan> plan_;
  ManualView view_;
  Instant now_ = Instant(std::chrono::hours(1));
  int beats_ = 0;
  std::vector<ManualWrite> box_;
  std::deque<What> unanswered_;
  bool looks_at_set_points_ = true;
};

}  // namespace axisgate::commands
