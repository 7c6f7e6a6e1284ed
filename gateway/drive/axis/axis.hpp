// SPDX-License-Identifier: Apache-2.0
// One axis at work: takes write batches, queues them with the bus, carries them out one after another and shows the
// axis's image. Promises each write batch one result; a stop taken at any time, ahead of everything; callbacks only
// after the image shows what they tell. Never enables or moves the axis by itself: it stops one whose owner has fallen
// silent, a jog whose button is released, a homing out of time, and a motion that nobody can watch, nothing else.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "adapters/bus/exchange.hpp"
#include "gateway/drive/axis/axis_publisher.hpp"
#include "gateway/drive/axis/axis_watch.hpp"
#include "gateway/drive/axis/pending_batches.hpp"
#include "gateway/drive/axis/telling.hpp"
#include "gateway/drive/motion/accepted.hpp"
#include "gateway/drive/motion/late_enable.hpp"
#include "gateway/drive/motion/owed_stop.hpp"
#include "gateway/drive/motion/ownership.hpp"
#include "gateway/image/command_port.hpp"

namespace axisgate::drive {

/// Clients that may wait for one and the same read or stop.
inline constexpr std::size_t kMaxJoined = 64;
/// So soon what waits for an older stop looks again.
inline constexpr Duration kStopsFirst = std::chrono::milliseconds(20);

class Axis {
 public:
  /// `turn`: its drive's, kept up to date by it.
  Axis(const model::DriveModel& drive, AxisSlot slot, ObjectStore& store, const Turn& turn, AxisImage& image,
       AxisHost& host);

  [[nodiscard]] std::optional<BatchResult> submit(const WriteBatch& batch, BatchCallback on_result);
  [[nodiscard]] bool holds(Quantity quantity, std::int64_t value) const;
  /// A row that a block repeats asks all the same: its client owns the axis, and another value was accepted last.
  [[nodiscard]] bool owner_asks(ClientId client, Quantity quantity, std::int64_t value) const;
  [[nodiscard]] std::int32_t set_position_value() const { return core_.set_position_value; }

  /// The drive comes up from scratch: nothing is known, nothing survives.
  void on_bring_up();
  /// The drive has sent an emergency code; 0: the reported emergency is over.
  void on_emergency(std::uint16_t code) { core_.fault.emergency(code, core_.turn.now, core_.store.exchange()); }
  /// What is to be read next so that a fault has its cause; and it goes on the wire.
  [[nodiscard]] std::optional<model::ObjectId> cause_to_read() const { return core_.fault.next(core_.turn.now); }
  void cause_asked() { core_.fault.asked(core_.turn.now); }
  /// What came by itself shows the end of the motion, and a read must settle it.
  [[nodiscard]] bool end_wants_sample() const { return core_.motion.end_wants_sample(core_.facts()); }
  /// The axis has shown a fault until now; reported once.
  [[nodiscard]] bool fault_is_over() { return core_.fault.take_over(); }
  /// It says that it has restarted: no motor of it has torque.
  void on_restarted();
  /// It was suspect: it may have restarted unseen.
  void on_invalidated() { reference_invalidated_ = true; }
  /// The drive, which is there, tells this object no more: a motion that needs it is stopped.
  void on_blind(model::ObjectId object);
  void set_alarm(AxisAlarm alarm, bool on);
  /// Whether its drive holds what makes it notice a dead gateway; none: nobody knows.
  void set_loss_reaction(std::optional<bool> holds);
  /// New samples are in the store: what is made from them is made again.
  void on_samples();
  /// The drive's own constants were read: scales and limits have changed.
  void on_scale();
  /// This client will never speak again: its lease is an orphan. Where leases are off, a motion that it commanded is
  /// stopped if nothing else would stop it.
  void on_client_gone(ClientId client);
  /// The gateway ends: from now on only stops are accepted. What waits ends as never started; what has begun ends after
  /// its exchange; stops, owed ones too, go on to their end.
  void close();
  /// It does not end after all.
  void reopen() { closing_ = false; }
  [[nodiscard]] const AxisImage& image() const { return image_; }
  /// What of it waits for the wire or is on it.
  [[nodiscard]] const PendingBatches& pending() const { return pending_; }
  /// Bring-up has found the axis enabled: it is open to every operator, until its lease runs out (design 3.5).
  void on_adopted();
  /// Somebody answers for what the axis does: its owner's lease runs, or leases are off. What must be commanded again
  /// and again (profile key "keepalive") is commanded only so long.
  [[nodiscard]] bool commands_live() const { return ownership_.live(core_.turn.now); }

  /// A stop was accepted, and the drive has not shown it yet.
  [[nodiscard]] bool owes_stop() const { return owed_.owed(); }

  /// The bus job's next exchange; none: it waits or has just ended.
  [[nodiscard]] std::optional<bus::Exchange> on_grant(bus::JobId id);
  [[nodiscard]] bool passes_resync(bus::JobId id);
  void on_result(bus::JobId id, const bus::ExchangeResult& result, Instant sent_at, bool trusted);
  void on_job_ended(bus::JobId id, Errc code);

  /// A write to it did not pass the way out; of a stop: a quick stop takes its place.
  void on_held_back(const std::string& what, bool stop);

  /// Deadlines of write batches.
  void on_time();
  /// New samples, or time has passed: what runs, what has ended.
  void observe();
  [[nodiscard]] Instant next_deadline() const;

  /// Brings the image up to date; then calls what is due to be called.
  void publish();
  void call_back();
  [[nodiscard]] bool has_due() const { return !due_.empty(); }

  [[nodiscard]] const AxisCore& core() const { return core_; }
  [[nodiscard]] Duration cycle() const { return shown_.cycle(); }

 private:
  struct Due {
    BatchResult result;
    std::vector<Waiting> callbacks;
  };
  // What comes before a write batch is carried out: who asks, and for what besides (axis_ownership.cpp).
  [[nodiscard]] Errc judge_owner(const WriteBatch& batch) const;
  void claim(const WriteBatch& batch);
  [[nodiscard]] bool waits_for(const WriteBatch& batch) const;
  void make_owner(const WriteBatch& batch);
  bool claims_late(Pending& pending);
  [[nodiscard]] bool is_anothers(const WriteBatch& batch) const;
  [[nodiscard]] BatchResult nothing_asked(const WriteBatch& batch);
  [[nodiscard]] bool may_run() const;
  [[nodiscard]] bool may_be_jog() const;
  void accept(const WriteBatch& batch);
  void note_commanded(const Pending& pending);
  void forget_accepted(const WriteBatch& batch);
  [[nodiscard]] std::optional<BatchResult> release(const WriteBatch& batch, BatchCallback on_result);
  [[nodiscard]] BatchResult released(const WriteBatch& batch);
  [[nodiscard]] std::optional<BatchResult> take_over(const WriteBatch& batch, BatchCallback on_result);
  [[nodiscard]] std::optional<BatchResult> taken_over(const WriteBatch& batch, BatchCallback on_result);
  void end_expired_lease();
  void on_lease_action(const BatchResult& result);
  [[nodiscard]] Errc begin_jog(WriteBatch& batch);
  [[nodiscard]] Duration usual_position_gap() const;
  /// No value: it is not homed, or nobody knows where it is, so no limit ends the jog.
  [[nodiscard]] std::optional<JogTravel> jog_travel(std::int64_t velocity) const;
  /// When a halt must be sent that ends the jog before the position limit, as far as is known now.
  [[nodiscard]] Instant jog_limit_due() const;
  void watch_position();
  void observe_jog();
  void end_jog_at_limit();
  void observe_reference(const AxisFacts& facts);
  void observe_counter();
  void observe_volatile();
  void observe_homing_method();
  void observe_end_of_fault(const AxisFacts& facts);
  /// A serial drive has restarted between two polls, as that sign tells: what was cached of it is not true any more.
  void on_unseen_restart(const char* sign);
  void stop_by_itself(Command command, bool latches, BatchCallback on_result);
  // What is owed until the drive shows it (axis_owed.cpp).
  void owe(const WriteBatch& stop);
  void observe_owed();
  void observe_stop();
  void watch_enable(const CommandSequence& unknown);
  void take_back_enable(model::State402 state);
  void on_unreachable();
  void send_owed(StopKind stop);
  void note_stop(const Pending& pending, bool ended);
  void note_begun(const Pending& pending, bool done);
  void tell_end(OwedStop::End end);
  void note_jog(const Pending& pending, Errc code);
  [[nodiscard]] bool runs_unwatched() const;
  void hold_rest(const Pending& pending);
  void end_jog();
  void halt_jog(const std::string& why);
  void stop_jog(std::string event_text);
  [[nodiscard]] bool stop_comes_first(const WriteBatch& batch) const;
  [[nodiscard]] bool may_be_enabled() const;
  [[nodiscard]] bool zero_may_move() const;
  /// `refusal`: of what stood beside the stop that the write batch is.
  [[nodiscard]] std::optional<BatchResult> carry_out(const WriteBatch& asked, Errc refusal, BatchCallback on_result);

  [[nodiscard]] Errc link_admits(bool stop, bool reads_alone) const;
  [[nodiscard]] static Instant deadline_of(const Pending& pending, const Waiting& client);
  [[nodiscard]] bool join_stop(const WriteBatch& batch, BatchCallback& on_result);
  void accept_stop(const WriteBatch& batch);
  [[nodiscard]] BatchResult refuse(const WriteBatch& batch, Errc code);
  void show_latest(const WriteBatch& batch, const Outcome& outcome);
  void enqueue(Pending pending, bool stop, std::optional<BatchResult>& refused);
  void carry_on(Pending& pending);
  [[nodiscard]] bool ends_with_gateway(const Pending& pending) const;
  void end_begun(Pending& pending);
  void complete(bus::JobId id, const BatchResult& result);
  // A state that did not come in time (axis_time.cpp).
  [[nodiscard]] Instant decide_by(const WriteBatch& batch) const;
  void tell_not_reached(const Pending& pending);
  void withdraw(const WriteBatch& asked, Command stop, const BatchResult& answer, std::vector<Waiting> waiting);
  // Who asked for what, and what became of it (axis_events.cpp).
  void tell_asked(const WriteBatch& asked, const WriteBatch& carried_out);
  void tell_owner(const std::string& what);
  void tell_refused(const WriteBatch& asked, const BatchResult& result);
  void name_limit(const WriteBatch& batch, BatchResult& result) const;
  void tell_ended(const Pending& pending, const Outcome& outcome);
  void add_zero_speed(WriteBatch& batch) const;

  AxisHost& host_;
  AxisImage& image_;
  AxisSlot slot_;
  AxisCore core_;
  AxisPublisher shown_;
  PendingBatches pending_;
  std::vector<Due> due_;
  bool reference_invalidated_ = false;
  bool holds_method_ = false;              ///< its drive was seen to hold the homing_method that a client has written
  bool faulted_ = false;                   ///< as seen last
  std::optional<std::int64_t> counted_{};  ///< the position as the drive counts, as seen last without a gap
  bool speeds_lost_ = false;  ///< its drive holds other speeds than it was sent; a start will write them again
  struct {
    std::optional<ClientId> client{};
    std::shared_ptr<const ClientLife> life{};
  } motion_by_;  ///< who commanded the motion that runs
  Ownership ownership_;
  bool zero_moves_ = false;             ///< when it was published last
  std::optional<ClientId> taken_by_{};  ///< its take-over's halt is under way
  Accepted accepted_;
  Jog jog_;
  bool jog_ended_without_halt_ = false;  ///< a jog has ended without a halt, and nothing was started since
  Instant jog_started_ = kLongAgo;       ///< until then it stood, or moved otherwise
  Instant position_at_ = kLongAgo;       ///< the newest sample of the position
  Duration position_gap_{};              ///< between two of them, while it jogs
  OwedStop owed_;
  AxisWatch watch_;
  LateEnable late_enable_;
  Telling telling_;
  bool closing_ = false;  ///< the gateway ends, or lets go of the drive
};

}  // namespace axisgate::drive
