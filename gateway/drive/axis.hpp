// One axis at work: takes groups, queues them with the bus, carries them out one after another and shows the axis's
// image. Promises each group one result; a stop taken at any time, ahead of everything; callbacks only after the image
// shows what they tell. Never enables or moves the axis by itself: it stops one whose owner has fallen silent, a jog
// whose button is let go, and a homing out of time, nothing else.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "gateway/drive/accepted.hpp"
#include "gateway/drive/conversation.hpp"
#include "gateway/drive/jog.hpp"
#include "gateway/drive/owed_stop.hpp"
#include "gateway/drive/ownership.hpp"
#include "gateway/drive/telling.hpp"
#include "gateway/image/command_port.hpp"
#include "gateway/image/events.hpp"

namespace axisgate::drive {

/// What an axis needs of its drive.
class AxisHost {
 public:
  AxisHost() = default;
  AxisHost(const AxisHost&) = delete;
  AxisHost& operator=(const AxisHost&) = delete;
  virtual ~AxisHost() = default;
  [[nodiscard]] virtual Instant now() const = 0;
  [[nodiscard]] virtual LinkState link_state() const = 0;
  struct Queued {
    Errc code = Errc::ok;  ///< ok or queue_full
    bus::OrderId id = 0;
    bool joined = false;
  };
  [[nodiscard]] virtual Queued queue(bus::Order order) = 0;
  virtual void order_waits(bus::OrderId id, Instant until) = 0;
  virtual void order_done(bus::OrderId id) = 0;
  /// A stop's order goes on as another: the rest of its group. False: there is no room for it.
  [[nodiscard]] virtual bool order_goes_on_as(bus::OrderId id, const bus::Order& rest) = 0;
  virtual void event(AxisNumber axis, EventKind kind, std::uint32_t code, std::string text) = 0;
};

/// Clients that may wait for one and the same read or stop.
inline constexpr std::size_t kMaxJoined = 64;

class Axis {
 public:
  Axis(const DriveModel& drive, bus::AxisSlot slot, ObjectStore& store, AxisImage& image, AxisHost& host);

  [[nodiscard]] std::optional<GroupResult> submit(const Group& group, GroupCallback on_result);
  [[nodiscard]] bool holds(Quantity quantity, std::int64_t value) const;
  /// A row that a block repeats asks all the same: its client owns the axis, and another value was accepted last.
  [[nodiscard]] bool owner_asks(ClientId client, Quantity quantity, std::int64_t value) const;
  [[nodiscard]] std::int32_t set_position_value() const { return core_.set_position_value; }

  /// The drive comes up anew: nothing is known, nothing survives.
  void on_bring_up();
  /// The drive has sent an emergency code; 0: what it told of is over.
  void on_emergency(std::uint16_t code, Instant now) { core_.fault.emergency(code, now, core_.store.exchange()); }
  /// What is to be read next so that a fault can be shown with its cause; and it goes on the wire.
  [[nodiscard]] std::optional<ObjectId> cause_to_read(Instant now) const { return core_.fault.next(now); }
  void cause_asked(Instant now) { core_.fault.asked(now); }
  /// What came by itself shows the end of the motion, and a read must settle it.
  [[nodiscard]] bool end_wants_sample() const { return core_.motion.end_wants_sample(core_.facts()); }
  /// The axis has shown a fault until now; told once.
  [[nodiscard]] bool fault_is_over() { return core_.fault.take_over(); }
  /// It says that it has started anew: no motor of it has torque.
  void on_restarted();
  /// It was suspect: it may have restarted unseen.
  void on_doubt() { reference_doubted_ = true; }
  void set_alarm(AxisAlarm alarm, bool on);
  /// New samples are in the store: what is made from them is made anew.
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
  /// Nothing of it waits for the wire or is on it.
  [[nodiscard]] bool idle() const { return pending_.empty(); }
  /// Bring-up has found the axis enabled: it is open to every operator, until its lease runs out (design 3.5).
  void on_adopted();
  /// Somebody answers for what the axis does: its owner's lease runs, or leases are off. What must be commanded again
  /// and again (profile key "keepalive") is commanded only so long.
  [[nodiscard]] bool commands_live() const { return ownership_.live(host_.now()); }

  /// A stop of it waits for the wire or is under way.
  [[nodiscard]] bool stopping() const;
  /// A stop was accepted, and the drive has not shown it yet.
  [[nodiscard]] bool owes_stop() const { return owed_.owed(); }
  /// An enable is under way.
  [[nodiscard]] bool enabling() const { return enable_is_asked(true); }
  /// The same, or (not `begun`) one waits for the wire.
  [[nodiscard]] bool enable_is_asked(bool begun = false) const;
  /// A disable waits for the wire.
  [[nodiscard]] bool disable_waits() const;

  /// The order's next exchange; none: it waits or has just ended.
  [[nodiscard]] std::optional<bus::Exchange> on_grant(bus::OrderId id);
  [[nodiscard]] bool passes_fence(bus::OrderId id);
  /// A stop that has not been sent yet, or, of the order on the wire, one that will be sent once more.
  [[nodiscard]] bool insists(bus::OrderId id) const;
  void on_result(bus::OrderId id, const bus::ExchangeResult& result, Instant sent_at, bool trusted);
  void on_order_ended(bus::OrderId id, Errc code);
  [[nodiscard]] bool has(bus::OrderId id) const { return find(id) != nullptr; }
  /// The order whose long object is under way; 0: none.
  [[nodiscard]] bus::OrderId chain_order() const;

  /// Deadlines of groups.
  void on_time(Instant now);
  /// New samples, or time has passed: what runs, what has ended.
  void observe(Instant now);
  [[nodiscard]] Instant next_deadline() const;

  /// Brings the image up to date; then calls what is due to be called.
  void publish(Instant now);
  void call_back();
  [[nodiscard]] bool has_due() const { return !due_.empty() && !core_.fault.withheld(); }

  [[nodiscard]] const AxisCore& core() const { return core_; }
  /// Between the last two samples of the statusword: the poll cycle as it really is.
  [[nodiscard]] Duration cycle() const { return cycle_; }

 private:
  /// A client that waits for a result. Those that share an order keep a deadline each.
  struct Waiting {
    GroupCallback tell;
    Instant start_by = kNever;   ///< nothing sent by then: never_started; of a stop: kNever
    Instant answer_by = kNever;  ///< no result by then: timed_out
  };
  struct Pending {
    bus::OrderId id = 0;
    std::unique_ptr<Conversation> conversation;
    std::vector<Waiting> callbacks;
    Instant start_by = kNever;  ///< the latest of theirs: the bus ends the order then
    bool starts_motion = false;
    bool by_mailbox = false;
    bool jogs = false;                        ///< it starts a jog
    std::optional<Endings::Point> acts_at{};  ///< of a command or controlword that the faces do not know to act yet
    std::uint64_t ends_jog = 0;               ///< once it has started what it starts, this jog is over
    Errc refusal = Errc::ok;                  ///< of what stood beside the stop; the answer once the stop is done
    std::optional<ClientId> stopped_by{};     ///< whose stop came first after it
    std::string stopped_by_name{};            ///< for log and events
    /// What the refusal is of.
    std::optional<std::uint16_t> refused_row{};
  };
  struct Due {
    GroupResult result;
    std::vector<Waiting> callbacks;
  };
  // What comes before a group is carried out: who asks, and for what besides (axis_ownership.cpp).
  [[nodiscard]] Errc judge_owner(const Group& group) const;
  void claim(const Group& group);
  [[nodiscard]] GroupResult nothing_asked(const Group& group);
  [[nodiscard]] bool may_run() const;
  [[nodiscard]] bool may_be_jog() const;
  void accept(const Group& group);
  void note_commanded(Pending& pending);
  void forget_accepted(const Group& group);
  [[nodiscard]] std::optional<GroupResult> release(const Group& group, GroupCallback on_result);
  [[nodiscard]] GroupResult released(const Group& group);
  [[nodiscard]] std::optional<GroupResult> take_over(const Group& group, GroupCallback on_result);
  [[nodiscard]] std::optional<GroupResult> taken_over(const Group& group, GroupCallback on_result);
  void end_expired_lease();
  void on_lease_action(const GroupResult& result);
  [[nodiscard]] Errc begin_jog(Group& group);
  [[nodiscard]] bool jog_must_stop(Command direction, std::int64_t velocity) const;
  void observe_jog();
  void stop_by_itself(Command command, bool latches, GroupCallback on_result);
  // What is owed until the drive shows it (axis_owed.cpp).
  void owe(const Group& stop);
  void observe_owed();
  void lose_sight();
  void send_owed(StopKind stop);
  void note_stop(const Pending& pending, bool ended);
  void note_accepted(const Group& group);
  void tell_end(OwedStop::End end);
  void note_jog(const Pending& pending, Errc code);
  [[nodiscard]] bool waits_for_stop(const Pending& pending) const;
  void end_jog();
  void halt_jog(std::string why);
  [[nodiscard]] bool stop_comes_first(const Group& group) const;
  [[nodiscard]] bool may_be_enabled() const;
  /// `refusal`: of what stood beside the stop that the group is.
  [[nodiscard]] std::optional<GroupResult> carry_out(const Group& asked, Errc refusal, GroupCallback on_result);

  [[nodiscard]] Errc link_admits(bool stop, bool reads_alone) const;
  [[nodiscard]] static Instant deadline_of(const Pending& pending, const Waiting& client);
  [[nodiscard]] bool join_stop(const Group& group, GroupCallback& on_result);
  void accept_stop(const Group& group);
  [[nodiscard]] GroupResult refuse(const Group& group, Errc code);
  void show_latest(const Group& group, const Outcome& outcome);
  void enqueue(Pending pending, bool stop, std::optional<GroupResult>& refused);
  void carry_on(Pending& pending);
  [[nodiscard]] bool ends_with_gateway(const Pending& pending) const;
  void end_begun(Pending& pending);
  void complete(bus::OrderId id, const GroupResult& result);
  void watch_fault();
  // A state that did not come in time (axis_time.cpp).
  [[nodiscard]] static Instant decide_by(const Group& group, Instant now);
  void tell_not_reached(const Pending& pending);
  void withdraw(const Group& asked, Command stop, const GroupResult& told, std::vector<Waiting> waiting);
  // Who asked for what, and what became of it (axis_told.cpp).
  void tell_asked(const Group& asked, const Group& carried_out);
  void tell_owner(const std::string& what);
  void tell_refused(const Group& asked, const Outcome& outcome);
  void tell_ended(const Pending& pending, const Outcome& outcome);
  void tell_fault(const AxisImage& before);
  void tell_endings();
  void tell_changes(const AxisImage& before);
  [[nodiscard]] Pending* find(bus::OrderId id);
  [[nodiscard]] const Pending* find(bus::OrderId id) const { return const_cast<Axis*>(this)->find(id); }
  [[nodiscard]] bool motion_pending() const;

  AxisHost& host_;
  AxisImage& image_;
  bus::AxisSlot slot_;
  AxisCore core_;
  std::vector<Pending> pending_;
  std::vector<Due> due_;
  bool reference_doubted_ = false;
  Duration cycle_{};
  Instant last_statusword_ = kLongAgo;
  std::optional<ClientId> motion_by_{};  ///< who commanded the motion that runs
  std::shared_ptr<const ClientLife> motion_by_life_{};
  Ownership ownership_;
  Accepted accepted_;
  std::uint64_t faults_told_ = 0;
  std::uint64_t losses_told_ = 0;
  Jog jog_;
  OwedStop owed_;
  bool owed_told_ = false;  ///< an event has told of it: its end is told as well
  Telling telling_;
  struct ShownFault {
    Instant since = kLongAgo;  ///< kLongAgo: there is none
    std::uint32_t code = 0;
    std::string reset_by{};  ///< who has asked for a reset of it last; empty: nobody
  } shown_fault_;
  bool closing_ = false;                ///< the gateway ends, or lets go of the drive
  Instant withdrawn_until_ = kLongAgo;  ///< an enable was withdrawn: until then one that comes late is taken back
};

}  // namespace axisgate::drive
