// SPDX-License-Identifier: Apache-2.0
// A command sequence: one write batch carried out, exchange by exchange (design 3.3). Pure: results and instants in,
// the next move out. Promises the fixed order set-points, mode, controlword, command, object; an end at the first
// failure; a statusword sampled after the last acknowledgement before it is done, and not done where that shows an axis
// which could not have obeyed; no write repeated but a stop, three times at most. Never decides whose turn the wire is,
// and never calls anybody.
#pragma once

#include <span>
#include <string>

#include "adapters/bus/exchange.hpp"
#include "gateway/drive/command_sequence/awaiting.hpp"
#include "gateway/drive/command_sequence/mailbox_access.hpp"
#include "gateway/drive/command_sequence/stop_attempt.hpp"
#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {

class CommandSequence {
 public:
  /// `core` outlives it. `stop`: the write batch is a stop by design 3.4; its stop is carried out before everything
  /// else in it. `by_mailbox`: after its writes nothing else counts as cached (design 3.3).
  CommandSequence(AxisCore& core, const WriteBatch& batch, bool stop, bool by_mailbox = false);

  struct Move {
    enum class Kind : std::uint8_t {
      exchange,  ///< put this on the wire, then call on_result()
      wait,      ///< nothing before `until`
      finished,  ///< see outcome()
    };
    Kind kind = Kind::finished;
    bus::Exchange exchange;
    Instant until = kLongAgo;
  };
  /// Goes as far as it can without the wire. The exchange of the answer is only for looking ahead.
  [[nodiscard]] Move advance();
  /// As advance(), and its exchange goes on the wire now: what is only planned is planned again, with what is known by
  /// now.
  [[nodiscard]] Move granted();
  /// The result of the exchange given last. `sent_at`: when it was sent. `trusted`: the drive was not suspect; else an
  /// acknowledgement proves no write, and the object is read back.
  void on_result(const bus::ExchangeResult& result, Instant sent_at, bool trusted);
  /// It ends here: stopped, drive or link lost. What was sent stays sent.
  void abort(Outcome outcome);
  /// It ends here: its client's time is over.
  void expire() { abort(outcome_if_late()); }
  /// Where the drive has acknowledged all that was sent, the state asked for was not reached; else the outcome is
  /// unknown.
  [[nodiscard]] Outcome outcome_if_late() const;
  /// Of an end with not_reached, for the log: the step, what was awaited, what was read. Of one with refused_by_drive:
  /// the object, "target_position (0x607A:00)"; empty: it was the client's own.
  [[nodiscard]] std::string missed() const;
  /// What might still happen after such an end must be withdrawn by this stop; none: nothing might.
  [[nodiscard]] Command withdrawn_by() const;

  [[nodiscard]] bool finished() const { return phase_ == Phase::finished; }
  [[nodiscard]] bool begun() const { return begun_; }  ///< something was sent
  /// Its command or controlword was carried out, at least in part: it was neither refused nor asked for what was so.
  [[nodiscard]] bool commanded() const { return acted_; }
  /// A stop that would be sent once more if the exchange on the wire stays without an answer.
  [[nodiscard]] bool would_repeat() const { return phase_ == Phase::stop && stop_attempt_.may_repeat(); }
  /// A long object is under way: another exchange with this drive would end it.
  [[nodiscard]] bool chain_open() const { return mailbox_.chain_open() && !finished(); }
  /// A stop whose own part is over: what is left of the write batch has no claim to go first.
  [[nodiscard]] bool stop_is_over() const { return is_stop() && phase_ > Phase::settle_stop; }
  /// What stands beside the stop waits until then at least, kLongAgo: for nothing. That of an older stop comes first
  /// (design 3.3, the order of one axis).
  void hold_rest(Instant until) { rest_held_ = until; }
  /// A state read after the stop's last sending has confirmed it.
  [[nodiscard]] bool stop_confirmed() const { return stop_attempt_.confirmed(); }
  /// The rest of the write batch was queued again, without the stop's precedence.
  void stop_was_handed_over() { stop_attempt_.hand_over(); }
  [[nodiscard]] const WriteBatch& batch() const { return batch_; }
  [[nodiscard]] const BatchResult& result() const { return result_; }
  /// What stands beside a stop is none, once it was queued again.
  [[nodiscard]] bool is_stop() const { return stop_ && !stop_attempt_.handed_over(); }
  [[nodiscard]] bool began_as_stop() const { return stop_; }
  /// It knows of each stop up to this point: what a later one overtakes starts and enables nothing.
  [[nodiscard]] AxisRecord::Point asked() const { return asked_; }
  /// The next move is a write that belongs to the stop: it passes a suspect drive's resynchronisation read.
  [[nodiscard]] bool passes_resync();

 private:
  enum class Phase : std::uint8_t {
    stop,
    settle_stop,
    setpoints,
    mode,
    controlword,
    preparation,
    command,
    object,
    settle,
    finished,
  };

  void drop_setpoints_of_a_refused_command();
  void plan_phase();
  void next_phase();
  [[nodiscard]] Plan plan_of(Phase phase);
  [[nodiscard]] Move exchange_for(const Action& action) const;
  [[nodiscard]] std::optional<Move> advance_wait(const Action& action);
  [[nodiscard]] bool has_come(const Action& action, const ObjectState& looked_at);
  [[nodiscard]] std::optional<Move> advance_settle() const;
  [[nodiscard]] bool in_command() const {
    return phase_ == Phase::controlword || phase_ == Phase::preparation || phase_ == Phase::command;
  }
  [[nodiscard]] bool enables_uncommanded(const Action& action) const;
  [[nodiscard]] bool is_command_of_motion(model::ObjectId object) const;
  [[nodiscard]] bool has_lost_torque() const;
  [[nodiscard]] bool within_nvm_budget(const bus::Exchange& exchange);
  void reach(const Action& action);
  [[nodiscard]] bool overtaken_by_stop(Mark mark) const;
  void pop();
  void fail(Errc code, std::uint32_t detail = 0);
  [[nodiscard]] bool repeat_stop();
  void on_write(const Action& action, const bus::ExchangeResult& result, Instant sent_at, bool trusted);
  void on_lost_write(const Action& action);
  void on_read(model::ObjectId object, const bus::ExchangeResult& result);
  void on_object(const bus::ExchangeResult& result);
  [[nodiscard]] std::int64_t number_of(const Action& action) const;

  AxisCore& core_;
  WriteBatch batch_;
  BatchResult result_;
  bool stop_;
  bool by_mailbox_;
  Instant rest_held_ = kLongAgo;
  AxisRecord::Point asked_;
  Phase phase_;
  StopAttempt stop_attempt_{};
  /// The plan of the phase, as far as it is carried out.
  struct {
    bool made = false;
    bool begun = false;  ///< something of it was sent: it is carried to its end
    std::vector<Action> actions{};
    std::size_t at = 0;
    [[nodiscard]] bool at_end() const { return at >= actions.size(); }
    [[nodiscard]] const Action& action() const { return actions[at]; }
    /// It, and the writes that go in one request with it.
    [[nodiscard]] std::span<const Action> request() const {
      std::size_t count = 1;
      while (actions[at + count - 1].joined) ++count;
      return {actions.data() + at, count};
    }
  } plan_;
  Awaiting awaiting_{};
  EffectWatch effect_{};
  /// The writes of all phases.
  struct {
    std::uint32_t count = 0;
    std::optional<Action> last{};
    bool under_way = false;             ///< the last one is not answered yet
    bool verifying = false;             ///< it was not acknowledged: its object is read back
    bool acknowledged = false;          ///< one of them at least
    std::uint64_t acknowledged_by = 0;  ///< exchange of the last one: samples asked for earlier are too old
  } writes_;
  MailboxAccess mailbox_{};
  bool begun_ = false;
  bool acted_ = false;
  bool moved_by_write_ = false;     ///< a set-point that moves by being written went to an enabled axis
  bool preparation_sent_ = false;   ///< the preparation of the command was more than a judgement
  std::optional<int> mode_before_;  ///< in force before the first preparation
};

}  // namespace axisgate::drive
