// SPDX-License-Identifier: Apache-2.0
// One axis at work: takes write batches, queues them with the bus, carries them out one after another and shows the
// axis's image. Promises each write batch one result; a stop taken at any time, ahead of everything; callbacks only
// after the image shows what they tell. Never enables or moves the axis by itself: it sends the stops that its guard
// says are due, nothing else.
#pragma once

#include <string>

#include "gateway/drive/axis/axis_admission.hpp"
#include "gateway/drive/axis/axis_jog.hpp"
#include "gateway/drive/axis/axis_publisher.hpp"
#include "gateway/drive/axis/axis_signs.hpp"
#include "gateway/drive/axis/axis_watch.hpp"
#include "gateway/drive/axis/batch_queue.hpp"
#include "gateway/drive/guard/guard.hpp"
#include "gateway/image/command_port.hpp"

namespace axisgate::drive {

class Axis final : private QueueOwner {
 public:
  /// `turn`: its drive's, kept up to date by it. `shared`: the axes before it that it is enabled and stopped as one
  /// with; they have one stop latch and one lease.
  Axis(const model::DriveModel& drive, AxisSlot slot, ObjectStore& store, const Turn& turn, AxisImage& image,
       const std::vector<Axis*>& shared, AxisHost& host);

  [[nodiscard]] std::optional<BatchResult> submit(const WriteBatch& batch, BatchCallback on_result);
  [[nodiscard]] AxisCore& core() { return core_; }
  [[nodiscard]] const AxisCore& core() const { return core_; }
  [[nodiscard]] const AxisImage& image() const { return image_; }
  [[nodiscard]] const AxisAdmission& admission() const { return admission_; }
  [[nodiscard]] const Guard& guard() const { return guard_; }
  /// What of it waits for the wire or is on it.
  [[nodiscard]] BatchQueue& queue() { return queue_; }
  [[nodiscard]] const PendingBatches& pending() const { return queue_.pending(); }
  [[nodiscard]] Duration cycle() const { return shown_.cycle(); }

  // --- What its drive has found -------------------------------------------------------------------------------------

  /// The drive comes up from scratch: nothing is known, nothing survives.
  void on_bring_up();
  /// It says that it has restarted: no motor of it has torque.
  void on_restarted();
  /// It was suspect: it may have restarted unseen.
  void on_invalidated() { signs_.on_invalidated(); }
  /// The drive, which is there, tells this object no more: a motion that needs it is stopped.
  void on_blind(model::ObjectId object);
  void set_alarm(AxisAlarm alarm, bool on);
  /// Whether its drive holds what makes it notice a dead gateway; none: nobody knows.
  void set_loss_reaction(std::optional<bool> holds);
  /// New samples are in the store: what is made from them is made again.
  void on_samples() { core_.refresh_virtual(); }
  /// The drive's own constants were read: scales and limits have changed.
  void on_scale();
  /// Bring-up has found the axis enabled: it is open to every operator, until its lease runs out (design 3.5).
  void on_adopted();
  /// This client will never speak again: its lease is an orphan. Where leases are off, a motion that it commanded is
  /// stopped if nothing else would stop it.
  void on_client_gone(ClientId client);
  /// A write to it did not pass the way out; of a stop: a quick stop takes its place.
  void on_held_back(const std::string& what, bool stop);

  // --- Each turn ----------------------------------------------------------------------------------------------------

  /// Deadlines of write batches, and of whoever must answer for the axis.
  void on_time();
  /// New samples, or time has passed: what runs, what has ended, which stops are due.
  void observe();
  /// Of the rules below it, and of what publish() has shown.
  [[nodiscard]] Instant next_deadline() const;
  /// Brings the image up to date.
  void publish();

 private:
  // QueueOwner
  [[nodiscard]] Errc may_go_on(Pending& pending) override;
  void on_begun(const Pending& pending, bool done) override;
  void on_stop_over(const Pending& pending, bool ended) override;
  void on_stop_late(const Pending& pending, const Outcome& outcome) override;
  [[nodiscard]] BatchResult on_ended(Pending& pending) override;

  // What is asked.
  [[nodiscard]] std::optional<BatchResult> release(const WriteBatch& batch, BatchCallback on_result);
  [[nodiscard]] BatchResult released(const WriteBatch& batch);
  [[nodiscard]] std::optional<BatchResult> take_over(const WriteBatch& batch, BatchCallback on_result);
  [[nodiscard]] std::optional<BatchResult> taken_over(const WriteBatch& batch, BatchCallback on_result);
  /// What a client has asked for is so; `shown`: as the axis's latest result.
  [[nodiscard]] BatchResult nothing_left(const WriteBatch& batch, bool shown = true);
  /// `refusal`: of what stood beside the stop that the write batch is. `own`: it is this stop of the gateway's own.
  [[nodiscard]] std::optional<BatchResult> carry_out(const WriteBatch& asked, Errc refusal, BatchCallback on_result,
                                                     const OwnStop* own = nullptr);
  [[nodiscard]] BatchResult refuse(const WriteBatch& batch, Errc code, bool shown = true);
  void accept(const WriteBatch& batch);

  // Stops (axis_stops.cpp).
  void accept_stop(const WriteBatch& batch, bool with_another);
  [[nodiscard]] Guard::Seen seen() const;
  /// Sends what is due.
  void settle();
  /// All stops of the gateway's own leave by this.
  [[nodiscard]] std::optional<BatchResult> send(const OwnStop& stop, BatchCallback on_result);
  void withdraw(Pending& pending, Command stop, const BatchResult& answer);
  void on_unreachable();
  void observe_stop();

  AxisImage& image_;
  std::vector<Axis*> shared_;  ///< axes that are enabled and stopped as one with it
  Lease& lease_;
  AxisCore core_;
  AxisPublisher shown_;
  Guard guard_;
  AxisEvents events_;
  AxisAdmission admission_;
  AxisJog jog_;
  AxisWatch watch_;
  AxisSigns signs_;
  BatchQueue queue_;
};

}  // namespace axisgate::drive
