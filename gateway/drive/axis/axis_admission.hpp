// SPDX-License-Identifier: Apache-2.0
// What is asked of an axis before anything is carried out: who owns it, who may have it, what must be stopped first,
// and whether its link lets it pass (design 3.3 Outcomes, 3.5). Promises that reads are free and stops open to every
// operator. Never queues and never sends.
#pragma once

#include <optional>
#include <string>

#include "gateway/drive/axis/axis_events.hpp"
#include "gateway/drive/guard/guard.hpp"

namespace axisgate::drive {

class AxisAdmission {
 public:
  AxisAdmission(AxisCore& core, AxisImage& image, Guard& guard, AxisEvents& events)
      : core_(core), image_(image), guard_(guard), events_(events) {}

  // --- Who asks -----------------------------------------------------------------------------------------------------

  /// ok, or not_owner.
  [[nodiscard]] Errc judge(const WriteBatch& batch) const;
  /// Its turn has come: what it waited for may have made it acceptable, and the axis may be another's by now.
  [[nodiscard]] Errc judge_again(Pending& pending);
  /// What was accepted from a client makes it the owner; so does any write where the axis waits for this client.
  void claim(const WriteBatch& batch);
  /// Any write of this client makes it the owner.
  [[nodiscard]] bool waits_for(const WriteBatch& batch) const;
  void make_owner(const WriteBatch& batch);
  /// It has become another's by what was asked of an axis that it has one owner with.
  void see_owner();
  /// Command take_over: another owns the axis, and must be halted first.
  [[nodiscard]] bool must_halt_for(const WriteBatch& batch, const PendingBatches& pending) const;
  /// The halt of this client's take-over is under way: nobody else asks for anything. None: it has ended.
  void is_taken_by(std::optional<ClientId> client) { taken_by_ = client; }
  /// Command release: ok or not_owner.
  [[nodiscard]] Errc release(const WriteBatch& batch, bool enables);

  // --- What stands against it ---------------------------------------------------------------------------------------

  /// A stop is owed by a loss: whatever is asked would act on an axis of which nobody knows what it does.
  [[nodiscard]] bool stop_comes_first(const WriteBatch& batch) const;
  /// By the link and what the drive was found to be. `stop`, `reads_alone`: of what is asked.
  [[nodiscard]] Errc link_admits(bool stop, bool reads_alone) const;
  /// What is not surely read disabled counts as enabled: the motor of a cut cable may be running.
  [[nodiscard]] bool may_be_enabled() const {
    return core_.turn.link != LinkState::online ||
           core_.any_shared([](const AxisCore& axis) { return axis.state().enabled(); });
  }
  /// A run that is on, waits for the wire, or may go on unseen.
  [[nodiscard]] bool may_run(const PendingBatches& pending) const;
  /// The owner's zero of a target that a run follows ends it, also where the block has not changed.
  void add_zero_speed(WriteBatch& batch, const PendingBatches& pending) const;

  // --- Which rows ask -----------------------------------------------------------------------------------------------

  /// The drive is known to hold exactly this value.
  [[nodiscard]] bool holds(Quantity quantity, std::int64_t value) const;
  /// A row that a block repeats asks all the same: its client owns the axis, and another value was accepted last.
  [[nodiscard]] bool owner_asks(ClientId client, Quantity quantity, std::int64_t value) const;

 private:
  [[nodiscard]] bool is_anothers(const WriteBatch& batch) const;

  AxisCore& core_;
  AxisImage& image_;
  Guard& guard_;
  AxisEvents& events_;
  std::optional<ClientId> taken_by_{};  ///< its take-over's halt is under way
  ClientId owner_ = 0;                  ///< as seen last; 0: nobody's
};

}  // namespace axisgate::drive
