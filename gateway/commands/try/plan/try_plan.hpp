// SPDX-License-Identifier: Apache-2.0
// `axisgate profile try`: from one step of a trial to the next, by what the axis shows and what a person types. Looks,
// answers, lines and instants in; orders, words and the report out. Pure. Promises that nothing is written before the
// step "setup", that torque and each kind of motion have a consent of their own, that whatever ends it stops and
// disables the axis, and a verdict for every step. Never goes on after a step that is wrong.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/commands/try/plan/object_reads.hpp"
#include "gateway/commands/try/plan/try_ending.hpp"

namespace axisgate::commands {

struct TryArguments {
  AxisNumber axis = 1;
  bool dry = false;
  std::optional<std::int16_t> home{};      ///< a method
  std::vector<std::string> open_before{};  ///< what open questions of the profile forbid
};

/// What is to be done next. Those with an id are answered by on_result().
struct TryOrder {
  enum class Kind : std::uint8_t {
    open,      ///< bring the drive up by its whole profile; until then it is only read
    read,      ///< `object`
    write,     ///< `write`, with `id` as its command_id
    withhold,  ///< no heartbeat of the gateway leaves
    resume,    ///< they leave again
  };
  Kind kind = Kind::read;
  std::uint16_t id = 0;
  ObjectRequest object{};
  Write write{};
};

/// What the axis shows now.
struct TryLook {
  const AxisImage& image;
  std::optional<std::uint32_t> raw_position{};  ///< as the drive counts, its low 32 bits
};

class TryPlan {
 public:
  static constexpr Duration kOnlineLimit = std::chrono::seconds(15);
  static constexpr Duration kAnswerLimit = std::chrono::seconds(15);
  /// No motor has torque while a person is waited for.
  static constexpr Duration kPersonLimit = std::chrono::minutes(5);
  /// A held shaft moves less.
  static constexpr double kHeld = 0.01;  // turns

  /// `drive` outlives the plan.
  TryPlan(const model::DriveModel& drive, AxisSlot slot, const TryArguments& arguments, Instant now);

  void on_look(const TryLook& look, Instant now);
  void on_result(std::uint16_t id, const BatchResult& result);
  /// None: no line comes any more.
  void on_line(std::optional<std::string> line) { person_.line = std::move(line); }
  /// A line of the gateway's log is part of what was seen.
  void on_log(std::string line);
  /// A signal, a terminal that is gone. What moves is stopped at the next look.
  void end(std::string_view why);

  [[nodiscard]] std::vector<std::string> take_words() { return std::exchange(words_, {}); }
  [[nodiscard]] std::optional<TryOrder> take_order();
  /// The number of the line that is waited for, from 1; 0: none is.
  [[nodiscard]] int asks() const { return person_.asked ? person_.questions : 0; }
  [[nodiscard]] bool over() const { return step_.over; }
  [[nodiscard]] int exit_code() const { return report_.any_wrong() || !report_.ended.empty() ? 1 : 0; }
  [[nodiscard]] TryReport& report() { return report_; }

 private:
  struct Turned {
    std::optional<double> turns{};
    std::optional<std::uint32_t> raw{};
  };
  /// Who is asked.
  struct Person {
    bool asked = false;
    int questions = 0;
    std::optional<std::optional<std::string>> line{};  ///< what was typed
  };
  /// Where it is.
  struct Place {
    TryStep step = TryStep::read;
    bool begun = false;
    bool online = false;
    std::size_t read = 0;  ///< objects of the step so far
    std::vector<std::string> faults{};
    bool last_done = false;
    bool over = false;
  };
  /// The act that is carried out.
  struct Doing {
    bool begun = false;
    Instant since = kLongAgo;
    std::optional<MotionCheck> motion{};
    std::optional<Standstill> standstill{};
    bool stood = false;
    Turned from{};
  };

  void say(std::string_view text, std::size_t indent = 9);
  void see(std::string_view text);
  void order(TryOrder order, Instant now);
  [[nodiscard]] std::optional<BatchResult> answer(Instant now);

  // Steps.
  void advance(const TryLook& look, Instant now);
  void begin_ending(Instant now);
  void begin_step(const TryLook& look, Instant now);
  void look_at_reading(const TryLook& look, Instant now);
  void look_at_setup(const TryLook& look, Instant now);
  [[nodiscard]] bool await_online(const TryLook& look, Instant now);
  void end_setup(const TryLook& look);
  void close_step(Verdict verdict);
  void wrong(std::string_view why);
  void look_at_ending(const TryLook& look, Instant now);

  // Acts.
  void look_at_acts(const TryLook& look, Instant now);
  /// What was typed, once it was; else it asks, or goes on waiting.
  [[nodiscard]] std::optional<std::string> typed(std::string_view prompt, Instant now);
  [[nodiscard]] bool act(const Consent& act, const TryLook& look, Instant now);
  [[nodiscard]] bool act(const Question& act, const TryLook& look, Instant now);
  [[nodiscard]] bool act(const TurnByPerson& act, const TryLook& look, Instant now);
  [[nodiscard]] bool act(const Write& act, const TryLook& look, Instant now);
  [[nodiscard]] bool act(const Hold& act, const TryLook& look, Instant now);
  [[nodiscard]] bool act(const Motion& act, const TryLook& look, Instant now);
  [[nodiscard]] bool act(const Stop& act, const TryLook& look, Instant now);
  [[nodiscard]] bool act(const Withhold& act, const TryLook& look, Instant now);
  [[nodiscard]] bool stood(std::string_view by, Duration limit, const TryLook& look, Instant now);
  void judge_turn(const Turned& to);
  void write(const Write& write, const TryLook& look, Instant now);
  void keep_before(const Write& write, const AxisImage& image);

  const model::DriveModel& drive_;
  const model::AxisModel& axis_;
  const TryArguments arguments_;
  TryReport report_;
  std::vector<std::string> words_;
  Place step_;
  std::deque<Act> acts_;
  Doing doing_;
  std::deque<TryOrder> orders_;
  std::optional<std::uint16_t> waits_for_;  ///< an order's id
  std::optional<BatchResult> result_;
  Instant patience_;  ///< of an answer, a person, a drive that comes online
  std::uint16_t id_ = 0;
  Person person_;
  bool torque_ = false;  ///< it may be enabled
  std::vector<Setpoint> before_;
  std::optional<TryEnding> ending_;
};

}  // namespace axisgate::commands
