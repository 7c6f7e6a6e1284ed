// SPDX-License-Identifier: Apache-2.0
// One drive on its bus: link state, bring-up, polling, the resynchronisation read after a timeout, and its axes.
// Promises that no value of a suspect drive is stored, no write but a stop is sent to one, that an unresponsive drive
// costs its bus one probe per back-off step, and that a drive which must be commanded again and again is so while
// somebody answers for its axis. Never enables anything.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "adapters/bus/bus.hpp"
#include "gateway/drive/axis/axis.hpp"
#include "gateway/drive/device/bring_up.hpp"
#include "gateway/drive/device/drive_control.hpp"
#include "gateway/drive/device/drive_end.hpp"
#include "gateway/drive/device/drive_reads.hpp"
#include "gateway/drive/device/node_presence.hpp"

namespace axisgate::drive {

class Drive final : public bus::BusDrive, private AxisHost {
 public:
  /// `images`: one per axis of the model, in its order. Everything referred to outlives the drive.
  Drive(model::DriveModel model, DriveSlot slot, std::vector<AxisImage*> images, bus::Bus& bus, Runtime& runtime,
        EventRing& events);

  [[nodiscard]] std::optional<BatchResult> submit(AxisSlot axis, const WriteBatch& batch, BatchCallback on_result);
  [[nodiscard]] const Axis& axis(AxisSlot slot) const { return *axes_[slot]; }
  [[nodiscard]] std::size_t axis_count() const { return axes_.size(); }
  [[nodiscard]] const model::DriveModel& model() const { return model_; }
  [[nodiscard]] LinkState link_state() const { return turn_.link; }
  [[nodiscard]] const ObjectStore& store() const { return store_; }
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
  [[nodiscard]] std::uint8_t node() const override { return model_.node; }
  void on_unsolicited(const bus::UnsolicitedEvent& unsolicited) override;

 private:
  /// Who asked for the exchange on the wire.
  struct OnWire {
    bus::JobId job = 0;    ///< 0: a poll or probe
    Axis* axis = nullptr;  ///< whose bus job it is; null: the drive's own
    DriveReads::Asked read{};
    std::optional<AxisSlot> keeps_alive{};  ///< a repetition for this axis, or the look before it
    /// The bus job keeps its turn; this exchange is the drive's own.
    void becomes_own() {
      job = 0;
      axis = nullptr;
    }
  };

  /// Bus jobs of the drive's own; 0: there is none.
  struct OwnJobs {
    bus::JobId setup = 0;
    bus::JobId cause = 0;
    bus::JobId keep_alive = 0;
    bus::JobId end = 0;
  };

  /// Each call from outside is a turn of its own: what happens in it happens at one instant.
  void begin_turn() { turn_.now = bus_.now(); }
  /// Null: a bus job of the drive's own, or a poll.
  [[nodiscard]] Axis* axis_of(AxisSlot slot) { return slot == kNoAxis ? nullptr : axes_[slot].get(); }

  // AxisHost
  [[nodiscard]] Queued queue(bus::BusJob job) override;
  void job_waits(bus::JobId id, Instant until) override { bus_.wait(id, until); }
  void job_done(bus::JobId id) override { bus_.finish(id); }
  bool job_goes_on_as(bus::JobId id, const bus::BusJob& rest) override { return bus_.go_on_as(id, rest); }
  void event(AxisNumber axis, EventKind kind, std::uint32_t code, std::string text) override;

  /// A bus job of the drive's own; 0: there is no room for it.
  [[nodiscard]] bus::JobId queue_own(bus::Priority priority);
  /// In the width that the drive answered with last.
  [[nodiscard]] bus::Exchange write(model::ObjectId object, std::int64_t number) const;
  void widen(bus::Exchange& exchange);
  [[nodiscard]] std::optional<bus::Exchange> probe();
  /// `job`: whose turn it takes; it waits where silence must be kept instead.
  [[nodiscard]] std::optional<bus::Exchange> resync(bus::JobId job);
  [[nodiscard]] std::optional<bus::Exchange> own_exchange();
  [[nodiscard]] std::optional<bus::Exchange> exchange_of(const bus::Arbiter::Grant& grant);
  // What it asks for itself (drive_jobs.cpp).
  [[nodiscard]] DriveControl::Turn control_turn() const;
  [[nodiscard]] std::optional<bus::Exchange> keep_alive_turn(bus::Priority priority);
  [[nodiscard]] std::optional<bus::Exchange> whole_frame(const bus::Exchange& exchange,
                                                         const bus::Arbiter::Grant& grant);
  [[nodiscard]] Instant schedule_keep_alive();
  [[nodiscard]] bool has_cause_to_read() const;
  [[nodiscard]] std::optional<bus::Exchange> next_cause();
  [[nodiscard]] std::optional<bus::Exchange> next_of_causes();
  void schedule_causes();
  [[nodiscard]] std::optional<bus::Exchange> next_of_end();
  void finish_end();
  void tell_closed();
  [[nodiscard]] std::optional<bus::Exchange> next_of_bring_up();
  /// A long object is under way in another bus job: a bus job that can wait does, any other ends it.
  [[nodiscard]] bool waits_for_chain(const bus::Arbiter::Grant& grant);
  [[nodiscard]] bool chain_open() const;
  void break_chain();
  void store_fields(const bus::Exchange& exchange, const bus::ExchangeResult& result);
  void on_timeout(const bus::Exchange& exchange, bool stop_insists);
  void go_offline();
  void on_write_without_owner(const bus::Exchange& exchange, const bus::ExchangeResult& result, bool trusted);
  void on_answer(const bus::Exchange& exchange, const bus::ExchangeResult& result);
  /// `restarted`: the drive comes up from scratch; else a running one was adopted and is only set up now.
  void begin_bring_up(bool restarted);
  void carry_on_bring_up(const bus::Exchange& exchange, const bus::ExchangeResult& result);
  void end_bring_up();
  /// Of the exchange that has ended: objects may have been given up by it.
  void on_given_up();
  void tell_given_up(model::ObjectId object);
  void judge_given_up();
  void amend_setup();
  void end_amending();
  [[nodiscard]] std::string lacking(model::ObjectId object) const;
  void tell_mismatch(const std::string& lacks);
  void judge_profile();
  void judge_checks();
  void judge_loss_reaction();
  void leave_adoption();
  // What the drive says by itself (drive_unsolicited.cpp).
  void on_started();
  void on_present(bus::NodeState state);
  void on_gone();
  void on_values(const bus::ReplyFields& fields);
  void on_emergency(const bus::UnsolicitedEvent& unsolicited);
  void left_operational(bus::NodeState state);
  [[nodiscard]] bool may_be_set_up_again() const;
  [[nodiscard]] bool enable_is_asked() const;
  void map_values();
  void watch_positions();
  void unmap_values();
  void tell_all(EventKind kind, std::uint32_t code, const std::string& text);
  /// The way out of all its axes; what does not pass ends its bus job.
  [[nodiscard]] bool may_leave(const bus::Exchange& exchange, const bus::Arbiter::Grant& grant);
  void after_event();
  void bring_up_to_date();
  void on_time();
  [[nodiscard]] bool brought_up() const { return turn_.link == LinkState::online || turn_.link == LinkState::suspect; }

  model::DriveModel model_;  ///< its own: constants that are read from the drive change scales and limits
  DriveSlot slot_;
  bus::Bus& bus_;
  EventRing& events_;
  Turn turn_{.now = kLongAgo, .link = LinkState::link_down};
  ObjectStore store_;
  DriveReads reads_;
  BringUp bring_up_;
  DriveControl control_;
  DriveEnd end_;
  NodePresence presence_;
  OwnJobs jobs_;
  OnWire on_wire_;
  std::vector<std::unique_ptr<Axis>> axes_;
  std::unique_ptr<Timer> timer_;
};

}  // namespace axisgate::drive
