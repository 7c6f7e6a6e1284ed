// SPDX-License-Identifier: Apache-2.0
// The duties of a drive: whether it is there, its control frames and keep-alive, its bring-up, its end on purpose, what
// names a fault, its polls (design 7, points 4, 6 and 7). Promises that no value of a suspect drive is stored, that an
// unresponsive drive costs its bus one probe per back-off step, that a drive which loses its state, its start or its
// setup is brought up again, but no NMT command meets an enable, and that nothing begins once the end on purpose has.
// Never enables, moves or stops anything: but for repetitions, what does is an axis's.
#pragma once

#include <functional>

#include "gateway/drive/device/drive_control.hpp"
#include "gateway/drive/device/drive_end.hpp"
#include "gateway/drive/device/drive_task.hpp"

namespace axisgate::drive {

class CausesTask final : public DriveTask {
 public:
  using DriveTask::DriveTask;
  [[nodiscard]] std::optional<bus::Exchange> next(OnWire& turn) override;
  [[nodiscard]] Instant deadline() override;
  void on_emergency(const bus::UnsolicitedEvent& emergency);
};

class ControlTask final : public DriveTask {
 public:
  explicit ControlTask(DriveCore& core) : DriveTask(core), control_(core.model, core.store) {}

  /// Also another's turn, where a repetition is due or its axis's state must be looked at first.
  [[nodiscard]] bool takes(const OnWire& turn) override;
  [[nodiscard]] std::optional<bus::Exchange> next(OnWire& turn) override;
  void on_result(const Ended& ended) override;
  [[nodiscard]] Instant deadline() override;
  /// The drive comes up from scratch.
  void reset() { control_.reset(); }
  /// The exchange as it goes on the wire; none: it has no frame.
  [[nodiscard]] std::optional<bus::Exchange> whole(const OnWire& turn, const bus::Exchange& exchange) const;
  /// The repetition for this axis was not sent.
  void failed(AxisSlot axis) { control_.failed(axis, core_.turn.now); }

 private:
  [[nodiscard]] DriveControl::Turn shown() const;

  DriveControl control_;
  std::optional<DriveControl::Due> due_{};  ///< in the turn that it takes
  std::optional<model::ObjectId> look_{};   ///< likewise, where no repetition is
};

class EndTask final : public DriveTask {
 public:
  explicit EndTask(DriveCore& core) : DriveTask(core), end_(core.model) {}

  void begin(Closing why, std::function<void()> closed);
  [[nodiscard]] bool begun() const { return end_.begun(); }
  /// It stays after all: true where its setup is to be put back.
  [[nodiscard]] bool take_back();
  [[nodiscard]] Disarming::Outcome outcome() const { return end_.outcome(); }
  [[nodiscard]] std::optional<bus::Exchange> next(OnWire& turn) override;
  void on_result(const Ended& ended) override;
  void on_lost() override;
  /// Once nothing of the drive is on the wire or waits for it: whoever waits for that is called.
  void call_back();

 private:
  DriveEnd end_;
};

class SetupTask final : public DriveTask {
 public:
  SetupTask(DriveCore& core, ControlTask& control, const EndTask& end)
      : DriveTask(core), control_(control), end_(end) {}

  /// `restarted`: the drive comes up from scratch; else a running one was adopted and is only set up now.
  void begin(bool restarted);
  [[nodiscard]] std::optional<bus::Exchange> next(OnWire& turn) override;
  void on_result(const Ended& ended) override;
  [[nodiscard]] Instant deadline() override;
  /// Of the exchange that has ended: objects may have been given up by it.
  void on_given_up();
  /// Of one that is brought up: what has changed is judged, and what it is owed begins.
  void go_on();
  /// The node reports that it is not operational any more.
  void on_left(bus::NodeState state);
  /// What it sends by itself counts no more.
  void unmap();

 private:
  void end();
  void map();
  [[nodiscard]] bool enable_is_asked() const;
  /// What was refused of the setup for now may be tried again.
  [[nodiscard]] bool may_amend() const;
  void leave_adoption();

  ControlTask& control_;
  const EndTask& end_;
  std::string refused_{};  ///< what was reported of it
};

/// The turns of a drive that is not there, and of one that owes a reply.
class LinkTask final : public DriveTask {
 public:
  LinkTask(DriveCore& core, SetupTask& setup) : DriveTask(core), setup_(setup) {}

  [[nodiscard]] bool takes(const OnWire& turn) override;
  /// Where silence must be kept the bus job whose turn it was waits.
  [[nodiscard]] std::optional<bus::Exchange> next(OnWire& turn) override;
  /// What an exchange says of the drive, before anybody else sees it. False: nobody does, since it is tried again in
  /// smaller parts.
  [[nodiscard]] bool judge(const Ended& ended);
  [[nodiscard]] Instant deadline() override { return core_.presence.duplicate_due(core_.turn.now); }
  void on_link(bool up);
  void on_started();
  void on_present(bus::NodeState state);
  void on_gone();
  /// A node is heard that no drive of the configuration has.
  void on_stranger(std::uint8_t node);

 private:
  [[nodiscard]] std::optional<bus::Exchange> probe(OnWire& turn);
  void on_timeout(const Ended& ended);
  void on_answer(const Ended& ended);
  void go_offline();
  void tell_strangers();

  SetupTask& setup_;
  std::string strangers_{};  ///< nodes that are heard and in no configuration
  bool tells_strangers_ = false;
  bool answered_ = false;  ///< once at least
};

class PollTask final : public DriveTask {
 public:
  using DriveTask::DriveTask;
  [[nodiscard]] bool takes(const OnWire& turn) override { return turn.job == 0 && core_.brought_up(); }
  [[nodiscard]] std::optional<bus::Exchange> next(OnWire& /*turn*/) override {
    return core_.reads.poll(core_.turn.now);
  }
  [[nodiscard]] Instant deadline() override;
  /// What the axis waits for is read soon.
  void hurry(const Axis& axis);
  void on_values(const bus::ReplyFields& fields);
};

/// The alarms of checks, as what is known of the drive says.
void judge_checks(DriveCore& core);
/// Whether the drive notices a dead gateway: what makes it do so must be in it.
void judge_loss_reaction(DriveCore& core);
/// Whether it has what its profile needs.
void judge_profile(DriveCore& core);
/// An object was given up, or has answered again.
void judge_given_up(DriveCore& core);
/// One line for each object, until it answers again.
void tell_given_up(DriveCore& core, model::ObjectId object);
/// Its name for tell_mismatch().
[[nodiscard]] std::string lacking(const DriveCore& core, model::ObjectId object);
/// What its profile needs and it does not have, reported once.
void tell_mismatch(DriveCore& core, const std::string& lacks);
/// Why it is none that this profile can move, reported once; empty: it is.
void tell_unfit(DriveCore& core, const std::string& why);
/// What it does not have and can live without, where it is other than `reported`, which was so last.
void tell_refused(DriveCore& core, std::string& reported);

}  // namespace axisgate::drive
