// SPDX-License-Identifier: Apache-2.0
// A drive with one axis as a trial sees it: a motor that does what it is asked, counted by a profile that may be wrong.
// Promises that time passes in looks of 20 ms, and that what was written and said is kept. Never answers what a test
// has told it not to.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "gateway/commands/try/plan/try_plan.hpp"

namespace axisgate::commands {

inline constexpr Duration kMs = std::chrono::milliseconds(1);
inline constexpr std::int64_t kCounts = 10000;

/// What may be wrong with it.
struct Flaws {
  double speed = 1;            ///< so many times as fast as asked
  double shown_velocity = 1;   ///< velocity_actual beside what it turns at
  double shown_position = 1;   ///< position_actual beside target_position
  double counts = 1;           ///< position_actual beside the turns it makes
  bool stops_nothing = false;  ///< quick stop is acknowledged alone
  bool creeps = false;         ///< while it is held
  bool ignores_loss = false;
  bool no_units = false;  ///< a constant is not known
};

class TrialRig : public ::testing::Test {
 protected:
  TrialRig();
  void begin(TryArguments arguments = {});
  /// One look.
  void step();
  /// Until it asks, or is over.
  void until_asked();
  void until_over();
  void say(std::optional<std::string> line);
  /// Consents and answers as they come, until it is over or asks for `last`.
  void go_on(TryStep last);
  [[nodiscard]] std::string saw(TryStep step) const;
  [[nodiscard]] Verdict verdict(TryStep step) { return plan_->report().of(step).verdict; }
  [[nodiscard]] bool stands() const { return rpm_ == 0 && !enabled_; }

  model::DriveModel drive_;
  AxisImage image_;
  Flaws flaws_;
  Instant now_ = Instant(std::chrono::hours(1));
  std::optional<TryPlan> plan_;
  std::vector<std::string> words_;
  std::vector<Command> commands_;
  std::vector<TryOrder::Kind> orders_;
  int writes_ = 0;
  double turned_ = 0;   ///< by the motor, in turns
  double fastest_ = 0;  ///< rpm
  bool enabled_ = false;
  bool answers_ = true;
  bool latched_ = false;  ///< by a quick stop, until the next enable
  bool sees_heartbeats_ = true;
  std::vector<std::uint32_t> raw_positions_{};  ///< handed out instead of the position's counts

 private:
  void carry_out(const TryOrder& order);
  void obey(const Write& write, std::uint16_t id);
  void turn();
  void show();

  double rpm_ = 0, target_rpm_ = 0;
  std::optional<double> goal_;
  Instant loss_at_ = kNever;
};

}  // namespace axisgate::commands
