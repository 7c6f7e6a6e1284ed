// SPDX-License-Identifier: Apache-2.0
// One drive on its bus, and its axes: each turn on the wire is the first task's that takes it, else the axis's.
// Promises that no value of a suspect drive is stored, no write but a stop is sent to one, that an unresponsive drive
// costs its bus one probe per back-off step, and that a drive which must be commanded again and again is so while
// somebody answers for its axis. Never enables anything.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/drive/device/drive_tasks.hpp"
#include "gateway/drive/plan/way_out.hpp"

namespace axisgate::drive {

class Drive final : public bus::BusDrive {
 public:
  /// `images`: one per axis of the model, in its order. Everything referred to outlives the drive.
  Drive(model::DriveModel model, DriveSlot slot, std::vector<AxisImage*> images, bus::Bus& bus, Runtime& runtime,
        EventRing& events);

  [[nodiscard]] std::optional<BatchResult> submit(AxisSlot axis, const WriteBatch& batch, BatchCallback on_result);
  [[nodiscard]] const Axis& axis(AxisSlot slot) const { return *core_.axes[slot]; }
  [[nodiscard]] std::size_t axis_count() const { return core_.axes.size(); }
  [[nodiscard]] const model::DriveModel& model() const { return core_.model; }
  [[nodiscard]] LinkState link_state() const { return core_.turn.link; }
  [[nodiscard]] const ObjectStore& store() const { return core_.store; }
  void client_gone(ClientId client);
  using Closing = drive::Closing;
  /// Only stops are accepted from now on. `closed` is called once, when nothing of this drive is on the wire or waits
  /// for it, perhaps from inside; nothing begins after that but stops.
  void close(Closing why, std::function<void()> closed);
  /// What close() has found.
  [[nodiscard]] Disarming::Outcome closing_outcome() const { return end_.outcome(); }
  /// It stays after all: commands are accepted again, and what made it miss the gateway is put back.
  void reopen();

  // BusDrive
  [[nodiscard]] std::optional<bus::Exchange> on_grant(const bus::Arbiter::Grant& grant) override;
  void on_result(const bus::Exchange& exchange, const bus::ExchangeResult& result) override;
  void on_job_ended(const bus::Arbiter::Ending& ending) override;
  void on_link(bool up) override;
  [[nodiscard]] std::uint8_t node() const override { return core_.model.node; }
  void on_unsolicited(const bus::UnsolicitedEvent& unsolicited) override;

 private:
  /// Each call from outside is a turn of its own: what happens in it happens at one instant.
  void begin_turn() { core_.turn.now = core_.bus.now(); }
  /// Null: a bus job of the drive's own, or a poll.
  [[nodiscard]] Axis* axis_of(AxisSlot slot) { return slot == kNoAxis ? nullptr : core_.axes[slot].get(); }

  [[nodiscard]] std::optional<bus::Exchange> exchange_of_turn();
  /// A long object is under way in another bus job: a bus job that can wait does, any other ends it.
  [[nodiscard]] bool waits_for_chain();
  [[nodiscard]] bool chain_open() const;
  void break_chain();
  /// The way out of all its axes; what does not pass ends its bus job.
  [[nodiscard]] bool may_leave(const bus::Exchange& exchange);
  [[nodiscard]] bool may_leave(const Written& write, const Sender& sender);
  /// What was to be sent for an axis is not.
  void give_back(Errc code);
  void after_event();
  void bring_up_to_date();
  [[nodiscard]] Instant poll_due();
  void on_time();

  DriveCore core_;
  ControlTask control_{core_};
  EndTask end_{core_};
  SetupTask setup_{core_, control_, end_};
  LinkTask link_{core_, setup_};
  CausesTask causes_{core_};
  PollTask poll_{core_};
  /// Each goes before those behind it.
  std::array<DriveTask*, 6> tasks_{&link_, &control_, &setup_, &end_, &causes_, &poll_};
  OnWire on_wire_;
  std::unique_ptr<Timer> timer_;
};

}  // namespace axisgate::drive
