// SPDX-License-Identifier: Apache-2.0
// What `axisgate enable`, `move`, `jog` and `stop` write, and when: looks at an axis, answers, keys and instants in,
// writes out. Pure. Promises that nothing but a key presses a jog button, that 300 ms without a key let it go, and that
// however it ends on purpose the axis is stopped first, and has no torque where it had none before. Never enables an
// axis unless it was commanded, and never writes to one that somebody else owns, but for stops.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/commands/manual/plan/jog_button.hpp"
#include "gateway/commands/manual/plan/manual_keys.hpp"
#include "gateway/commands/manual/plan/stand_watch.hpp"
#include "gateway/commands/view/manual_view.hpp"
#include "gateway/core/clock.hpp"

namespace axisgate::commands {

enum class ManualTask : std::uint8_t { enable, move, jog, stop };
[[nodiscard]] std::string_view text(ManualTask task);

/// What a person asks for on the command line.
struct ManualArguments {
  ManualTask task = ManualTask::stop;
  AxisNumber axis = 1;
  Rational turns{};  ///< move: to this position, or by so much
  bool relative = false;
  std::optional<Rational> rpm;  ///< move: profile_velocity; jog: jog_velocity; none: ManualPlan::kUsualRpm at most
  bool enable = false;          ///< move, jog: enables the axis before, and disables it after
};

class ManualPlan {
 public:
  static constexpr Duration kKeyLapse = JogButton::kKeyLapse;
  /// A sign of life, for every way in which a lease is renewed. It presses no button.
  static constexpr Duration kHeartbeat = std::chrono::milliseconds(200);
  /// A motor that still turns by then is reported as such, and its torque is not taken away.
  static constexpr Duration kStandLimit = std::chrono::seconds(20);
  /// A motor stands when it has not moved for so long: longer than the filters of a drive's speed.
  static constexpr Duration kStill = std::chrono::milliseconds(300);

  /// A speed at which a person can follow a motor with his eyes.
  static constexpr std::int64_t kUsualRpm = 60;
  /// More is a slip of the keyboard, where nobody has said what the motor is rated for.
  static constexpr std::int64_t kMostRpm = 10000;

  ManualPlan(const ManualArguments& arguments, Instant now);

  /// What is written next, in this order; each is answered once, in the same order.
  [[nodiscard]] std::vector<ManualWrite> take();
  /// What a person must read before anything moves, once: the speed, and what becomes of the motor without a gateway.
  [[nodiscard]] std::vector<std::string> take_notes() { return std::exchange(notes_, {}); }
  /// Of the oldest write not answered yet.
  void on_answer(ModbusException exception, Instant now);
  /// `answered`: what answered() was when the look was asked for.
  void on_view(const ManualView& view, std::uint32_t answered, Instant now);
  void on_keys(const std::vector<ManualKey>& keys, Instant now);
  /// The process could not look at its keys for longer than kKeyLapse: nobody knows what was held. A terminal may still
  /// deliver what was typed meanwhile, so no key presses a button for another kKeyLapse.
  void on_stall(Instant now);
  void on_time(Instant now);
  [[nodiscard]] Instant due() const;

  /// Somebody ends it: a signal, a terminal that is gone. A second end says nothing new.
  void end(std::string_view why, Instant now);
  /// Whoever asks twice is in a hurry: the axis is not waited for.
  void end_at_once();
  /// The gateway is out of reach: nothing can be written any more.
  void lost(std::string_view why);
  /// The newest write was not sent: its number does not fit the register.
  void refuse_number(Instant now);
  /// It cannot begin, or go on.
  void fail(std::string_view why, Instant now);

  [[nodiscard]] bool over() const { return step_ == Step::over; }
  [[nodiscard]] int exit_code() const { return code_; }
  /// What there is to say at the end.
  [[nodiscard]] const std::string& words() const { return words_; }
  /// What it does now, for the line that is shown.
  [[nodiscard]] std::string doing() const;
  [[nodiscard]] std::uint32_t answered() const { return answered_; }
  [[nodiscard]] const std::optional<ManualView>& view() const { return view_; }

 private:
  enum class Step : std::uint8_t {
    look,
    begin,  ///< command 0: the id is remembered
    speed,
    speed_set,  ///< awaits a look that shows its result, as target_set
    enable,
    enabled,   ///< awaits a look that shows it
    released,  ///< jog: both buttons are written 0, one after the other
    target,
    target_set,
    start,
    working,  ///< holds, moves, jogs
    refused,  ///< awaits a look that tells why
    stop,
    standing,  ///< awaits a look that shows it
    disable,
    set_back,  ///< the speed is what it was before
    release,
    over,
  };

  void go(Step step) { step_ = step; }
  void claim(Instant now);
  void write(const ManualWrite& write, bool of_step = true);
  void write_command(Command command);
  void write_button(const std::optional<JogButton::Write>& button);
  void step_done(Instant now);
  void button_answered(ModbusException exception, Instant now);
  [[nodiscard]] ManualWrite speed_write(const Rational& rpm) const;
  [[nodiscard]] bool has_speed() const;
  [[nodiscard]] std::optional<Rational> speed_shown() const;
  [[nodiscard]] std::string too_fast() const;
  void write_speed(Instant now);
  [[nodiscard]] bool lowers_speed();
  void note_dangers();
  void give_back();
  void after_speed(Instant now);
  void after_enable(Instant now);
  void after_target(Instant now);
  [[nodiscard]] bool settled(const ManualWrite& write, Instant now);
  void first_look(Instant now);
  void watch(Instant now);
  void stood(Instant now);
  /// Stops what may move, takes torque and lease back, and ends.
  void finish(int code, std::string words, Instant now);
  void after_stop();
  void after_disable();
  [[nodiscard]] bool stands(Instant now) const;
  [[nodiscard]] bool ending() const { return step_ >= Step::stop; }
  [[nodiscard]] std::string why_refused() const;
  [[nodiscard]] std::string limit_text() const;
  [[nodiscard]] std::string out_of_reach() const;
  [[nodiscard]] std::string axis_text() const;

  ManualArguments arguments_;
  Rational rpm_{kUsualRpm};               ///< asked for
  bool speed_is_limit_ = false;           ///< the usual one was beyond the axis's limit
  bool speed_set_ = false;                ///< the drive, or the gateway, has taken it
  std::optional<Rational> speed_before_;  ///< what is set back
  std::vector<std::string> notes_;
  Step step_ = Step::look;
  std::deque<ManualWrite> outbox_;
  struct Waiting {
    ManualWrite write;
    bool of_step = false;
  };
  std::deque<Waiting> waiting_;  ///< written, not answered
  std::uint32_t answered_ = 0;   ///< writes, heartbeats left out
  std::optional<ManualView> view_;
  std::uint16_t id_ = 0;
  std::uint16_t motion_before_ = 0;  ///< move: what motion_id may show; its own, once a look has shown that
  std::uint16_t beat_ = 0;
  bool beat_waits_ = false;
  bool claimed_ = false;       ///< something was written that asks
  bool owned_before_ = false;  ///< by another connection of this host, where those are one client
  bool torque_is_ours_ = false;
  bool may_move_ = false;  ///< something was written that moves, and no look has shown it standing since
  bool reached_ = false;
  std::optional<std::uint16_t> lease_ms_;  ///< the most that was seen left of it
  ModbusException exception_ = ModbusException::none;
  std::string refused_what_;
  JogButton button_;
  Instant next_beat_ = kNever;
  Instant stand_by_ = kNever;
  StandWatch stand_watch_;
  Instant watched_from_ = kLongAgo;  ///< when its stop or its button was answered, or its target reached
  int code_ = 0;
  std::string words_;
};

}  // namespace axisgate::commands
