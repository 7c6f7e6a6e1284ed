// One drive on its bus: link state, bring-up, polling, the fence after a timeout, and its axes.
// Promises that no value of a suspect drive is stored, no write but a stop is sent to one, that a mute drive costs its
// bus one probe per back-off step, and that a drive which must be commanded again and again is so while somebody
// answers for its axis. Never enables anything.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "adapters/bus/backoff.hpp"
#include "adapters/bus/bus.hpp"
#include "gateway/drive/axis.hpp"
#include "gateway/drive/bring_up.hpp"
#include "gateway/drive/control_frame.hpp"
#include "gateway/drive/disarming.hpp"
#include "gateway/drive/fence.hpp"
#include "gateway/drive/keep_alive.hpp"
#include "gateway/drive/read_blocks.hpp"

namespace axisgate::drive {

class Drive final : public bus::BusDrive, private AxisHost {
 public:
  /// A mute drive is offline after this many timeouts in a row.
  static constexpr int kMuteTimeouts = 3;
  static constexpr int kCallsPerQuestion = 4;
  /// A position that comes by TPDO is read after so long without one while its axis moves.
  static constexpr Duration kMovingConfirm = std::chrono::milliseconds(250);
  /// Alarm duplicate_node stands so long after the last sign of a twin: a second SDO client that asks for the same
  /// object at the same time looks like one, once.
  static constexpr Duration kTwinStands = std::chrono::seconds(60);

  /// `images`: one per axis of the model, in its order. Everything referred to outlives the drive.
  Drive(DriveModel model, bus::DriveSlot slot, std::vector<AxisImage*> images, bus::Bus& bus, Runtime& runtime,
        EventRing& events);

  [[nodiscard]] std::optional<GroupResult> submit(bus::AxisSlot axis, const Group& group, GroupCallback on_result);
  [[nodiscard]] const Axis& axis(bus::AxisSlot slot) const { return *axes_[slot]; }
  [[nodiscard]] std::size_t axis_count() const { return axes_.size(); }
  [[nodiscard]] const DriveModel& model() const { return model_; }
  [[nodiscard]] LinkState link_state() const override { return state_; }
  [[nodiscard]] const ObjectStore& store() const { return store_; }
  void client_gone(ClientId client);
  /// Why a drive is closed.
  enum class Closing : std::uint8_t {
    gateway_ends,  ///< where no motor has torque, the drive is told not to miss the gateway; any other one stops as if
                   ///< the gateway had died
    look,          ///< to be taken away, if no motor has torque: that is read, and nothing is written
    taken_away     ///< as gateway_ends, while the gateway goes on
  };
  /// Only stops are accepted from now on. `closed` is called once, when nothing of this drive is on the wire or waits
  /// for it, perhaps from inside; nothing begins after that but stops.
  void close(Closing why, std::function<void()> closed);
  /// What close() has found.
  [[nodiscard]] Disarming::Outcome closing_outcome() const { return disarming_.outcome(); }
  /// It stays after all: commands are accepted again, and what made it miss the gateway is put back.
  void reopen();

  // BusDrive
  [[nodiscard]] std::optional<bus::Exchange> on_grant(bus::OrderId id, bus::Priority priority) override;
  void on_result(const bus::Exchange& exchange, const bus::ExchangeResult& result) override;
  void on_order_ended(bus::OrderId id, Errc code) override;
  void on_link(bool up) override;
  [[nodiscard]] std::uint8_t node() const override { return model_.node; }
  void on_notice(const bus::Notice& notice) override;

 private:
  /// Who asked for the exchange on the wire.
  struct OnWire {
    bus::OrderId order = 0;  ///< 0: a poll or probe
    bool fence = false;
    bool probe = false;
    bool widened = false;  ///< it reads neighbours that nobody asked for
    Instant sent_at = kLongAgo;
    std::optional<bus::AxisSlot> keeps_alive{};  ///< a repetition for this axis, or the look before it
  };

  // AxisHost
  [[nodiscard]] Instant now() const override { return runtime_.now(); }
  [[nodiscard]] Queued queue(bus::Order order) override;
  void order_waits(bus::OrderId id, Instant until) override { bus_.wait(id, until); }
  void order_done(bus::OrderId id) override { bus_.finish(id); }
  bool order_goes_on_as(bus::OrderId id, const bus::Order& rest) override { return bus_.go_on_as(id, rest); }
  void event(AxisNumber axis, EventKind kind, std::uint32_t code, std::string text) override;

  /// An order of the drive's own: it neither waits for its axes' orders nor is joined or superseded by one.
  [[nodiscard]] Queued queue_own(bus::Priority priority);
  [[nodiscard]] bus::Exchange read(ObjectId object) const;
  /// In the width that the drive answered with last.
  [[nodiscard]] bus::Exchange write(ObjectId object, std::int64_t number) const;
  [[nodiscard]] bus::Exchange read(const FenceRead& fence) const;
  /// A read that every drive of this type answers.
  [[nodiscard]] bus::Exchange plain_read() const;
  /// A read that shows that the drive is there.
  [[nodiscard]] bus::Exchange probe_read() const;
  void widen(bus::Exchange& exchange);
  /// A read of several objects that was refused: true where it is tried again in smaller parts.
  [[nodiscard]] bool split(const bus::Exchange& exchange, const bus::ExchangeResult& result);
  void store_refusal(const bus::Exchange& exchange, const bus::ExchangeResult& result);
  void read_constants();
  [[nodiscard]] bool tells_state(ObjectId object) const;
  [[nodiscard]] std::optional<bus::Exchange> probe();
  /// `order`: whose turn it takes; it waits where silence must be kept instead.
  [[nodiscard]] std::optional<bus::Exchange> fence(bus::OrderId order);
  [[nodiscard]] std::optional<bus::Exchange> poll();
  [[nodiscard]] std::optional<bus::Exchange> own_exchange();
  [[nodiscard]] std::optional<bus::Exchange> exchange_of(bus::OrderId id, bus::Priority priority);
  // What is commanded again and again, and frames that command all motors at once (drive_control.cpp).
  [[nodiscard]] bool shown_lately(ObjectId object) const;
  [[nodiscard]] std::vector<MotorShows> motors_show() const;
  [[nodiscard]] std::optional<bus::Exchange> look_before_frame(bool stop) const;
  [[nodiscard]] std::optional<bus::Exchange> whole_frame(const bus::Exchange& exchange, bus::OrderId id,
                                                         bus::Priority priority);
  [[nodiscard]] bool may_repeat() const;
  [[nodiscard]] std::optional<KeepAlive::Repeat> repeat_for(std::size_t slot) const;
  [[nodiscard]] bool looked_just_now() const;
  [[nodiscard]] std::optional<bus::Exchange> keep_alive_turn(bus::Priority priority);
  /// Takes and gives up a place in the queue as it is needed; when it must be looked at again.
  [[nodiscard]] Instant schedule_keep_alive();
  void on_control_result(const bus::Exchange& exchange, const bus::ExchangeResult& result, const OnWire& asked,
                         ObjectId written, bool trusted);
  void map_unasked();
  [[nodiscard]] std::optional<bus::Exchange> next_of_bring_up();
  // What names a fault (drive_causes.cpp).
  [[nodiscard]] std::optional<ObjectId> cause_to_read();
  [[nodiscard]] std::optional<bus::Exchange> next_of_causes();
  [[nodiscard]] bool causes_are_open() const;
  void schedule_causes();
  /// A long object is under way in another order: an order that can wait does, any other ends it.
  [[nodiscard]] bool waits_for_chain(bus::OrderId id, bus::Priority priority);
  [[nodiscard]] bool chain_open() const;
  void break_chain();
  void store_fields(const bus::Exchange& exchange, const bus::ExchangeResult& result);
  void on_timeout(const bus::Exchange& exchange, bool stop_insists);
  void go_offline();
  void on_write_without_owner(const bus::Exchange& exchange, const bus::ExchangeResult& result, bool trusted);
  void on_answer(const bus::Exchange& exchange, const bus::ExchangeResult& result);
  /// `restarted`: the drive comes up anew; else a running one was adopted and is only set up now.
  void begin_bring_up(bool restarted);
  void carry_on_bring_up(const bus::Exchange& exchange, const bus::ExchangeResult& result);
  void end_bring_up();
  [[nodiscard]] std::string lacking(ObjectId object) const;
  void tell_mismatch(const std::string& lacks);
  void judge_profile();
  void judge_checks();
  void judge_loss_reaction();
  void leave_adoption();
  // What the drive says by itself (drive_notices.cpp).
  void on_started();
  void on_present(bus::NodeState state);
  void on_gone();
  void on_values(const bus::ReplyFields& fields);
  void on_emergency(const bus::Notice& notice);
  void left_operational(bus::NodeState state);
  [[nodiscard]] bool may_be_set_up_anew() const;
  void map_values();
  void watch_positions();
  void unmap_values();
  void tell_all(EventKind kind, std::uint32_t code, const std::string& text);
  // The end on purpose (drive_closing.cpp).
  [[nodiscard]] std::optional<bus::Exchange> next_of_closing();
  void carry_on_closing(const bus::ExchangeResult& result, bool trusted);
  void end_closing();
  void tell_closed();
  void set_state(LinkState state);
  void after_event();
  void bring_up_to_date();
  void on_time();
  [[nodiscard]] bool brought_up() const { return state_ == LinkState::online || state_ == LinkState::suspect; }

  DriveModel model_;  ///< its own: constants that are read from the drive change scales and limits
  bus::DriveSlot slot_;
  bus::Bus& bus_;
  Runtime& runtime_;
  EventRing& events_;
  ObjectStore store_;
  PollPlan plan_;
  Fence fence_;
  ReadBlocks blocks_;
  std::optional<bus::Exchange> silent_read_{};  ///< of a block, given up; whether the drive lives is not known yet
  std::vector<std::optional<Rational>> constants_;
  BringUp bring_up_;
  ControlFrame frame_;
  KeepAlive keep_alive_;
  bus::OrderId keep_alive_order_ = 0;
  bus::OrderId cause_order_ = 0;
  bus::Backoff backoff_;
  bus::Backoff start_backoff_;  ///< between two set-ups of a node that does not become operational
  std::vector<std::unique_ptr<Axis>> axes_;
  std::unique_ptr<Timer> timer_;
  LinkState state_ = LinkState::link_down;
  OnWire on_wire_;
  bus::OrderId setup_order_ = 0;
  int mute_ = 0;
  std::string lacks_;  ///< what its profile needs and it refuses
  std::uint64_t doubts_seen_ = 0;
  Instant probe_due_ = kNever;
  bool adopted_ = false;
  /// CANopen: the node is not operational though it was told to start. It is polled, and set up and started anew in the
  /// first disabled state, not before `set_up_after_`.
  bool fell_back_ = false;
  Instant set_up_after_ = kLongAgo;
  /// CANopen: the node has given a sign of life since it was last gone. One that has not is asked by SDO once after the
  /// link came up, to find what was there before us; then it is called (design 7, point 3), and asked again after so
  /// many calls alone: a node may know neither guarding nor heartbeat.
  bool heard_ = false;
  bool asked_ = false;
  int calls_ = 0;                                        ///< unanswered, since it was asked last
  bus::NodeState node_state_ = bus::NodeState::unknown;  ///< as it told last
  Instant started_at_ = kLongAgo;                        ///< when it was told to become operational
  std::vector<std::uint8_t> width_;                      ///< bytes of each object, as the drive answered last
  std::vector<bool> mapped_;                             ///< objects that come by TPDO
  Instant twin_until_ = kLongAgo;                        ///< alarm duplicate_node
  Disarming disarming_;
  bus::OrderId closing_order_ = 0;
  std::optional<Closing> closing_{};
  std::function<void()> closed_{};
};

}  // namespace axisgate::drive
