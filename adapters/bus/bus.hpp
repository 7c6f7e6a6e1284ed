// SPDX-License-Identifier: Apache-2.0
// One bus: the arbiter, the wire and the timer of one physical line, brought together.
// Promises that every grant becomes one exchange, every exchange gets one result within its timeout, and that a stop
// goes next as soon as the exchange on the wire has ended. Never decides whose turn it is (arbiter) nor what to send
// (drive).
#pragma once

#include <boost/noncopyable.hpp>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "adapters/bus/arbiter.hpp"
#include "adapters/bus/exchange_times.hpp"
#include "adapters/bus/load_meter.hpp"
#include "adapters/bus/part_write.hpp"
#include "adapters/bus/wire.hpp"
#include "gateway/core/log.hpp"

namespace axisgate::bus {

/// A drive, as its bus sees it.
class BusDrive : boost::noncopyable {
 public:
  virtual ~BusDrive() = default;
  /// The wire is this drive's for one exchange: for a bus job, or for a poll. No value: nothing to send after
  /// all. A suspect drive may answer with its resynchronisation read instead of what the bus job wants; the bus job
  /// then stays.
  [[nodiscard]] virtual std::optional<Exchange> on_grant(const Arbiter::Grant& grant) = 0;
  virtual void on_result(const Exchange& exchange, const ExchangeResult& result) = 0;
  /// The arbiter has ended this bus job of the drive: its exchange, if one is on the wire, still gets its on_result().
  virtual void on_job_ended(const Arbiter::Ending& ending) = 0;
  virtual void on_link(bool up) = 0;
  /// The number by which unsolicited events name it; 0: it takes none.
  [[nodiscard]] virtual std::uint8_t node() const { return 0; }
  /// Its unsolicited event. Where it has restarted or is gone, its exchange on the wire has ended before (link_lost).
  virtual void on_unsolicited(const UnsolicitedEvent& /*unsolicited*/) {}
};

/// Unsolicited events that wait while a drive is being called; the oldest process data goes first.
inline constexpr std::size_t kMaxUnsolicited = 256;

struct BusSettings {
  std::string name;
  Duration timeout = std::chrono::milliseconds(100);  ///< from the request's sending to its last byte of reply
  Duration min_gap{};                                 ///< silence between two exchanges
  Duration settle{};                                  ///< silence after a timeout, where two talkers could collide
  std::uint32_t bit_rate = 0;                         ///< of a wire that counts its bits; 0: of another
};

class Bus final : private WireEvents {
 public:
  Bus(BusSettings settings, std::size_t drives, std::unique_ptr<Wire> wire, Runtime& runtime, const Log& log);
  ~Bus() override;
  /// All drives must be attached before start(). A drive must outlive the bus.
  void attach(DriveSlot slot, BusDrive& drive);
  void start();

  /// Also `offline` while the link is down. Never calls a drive before it has returned: what follows comes with the
  /// next turn of the loop, at once.
  [[nodiscard]] Arbiter::Submission submit(const BusJob& job);
  void wait(JobId id, Instant until);
  void finish(JobId id);
  /// As Arbiter::go_on_as().
  [[nodiscard]] bool go_on_as(JobId id, const BusJob& rest);
  void set_poll_due(DriveSlot drive, Instant due);
  void end_drive(DriveSlot drive, Errc waiting, Errc started);
  void map_process_data(std::uint8_t node, std::uint8_t number, const ProcessMap& objects) {
    wire_->map_process_data(node, number, objects);
  }
  [[nodiscard]] bool call(std::uint8_t node) { return up_ && wire_->call(node); }

  [[nodiscard]] const BusSettings& settings() const { return settings_; }
  [[nodiscard]] bool up() const { return up_; }
  [[nodiscard]] Instant now() const { return runtime_.now(); }
  [[nodiscard]] Statistics statistics() const;
  struct Times {
    const ExchangeTimes& exchanges;
    const ExchangeTimes& waits;  ///< as Arbiter::waits()
    Duration busy;               ///< how long an exchange was on the wire; on CAN, any frame
  };
  [[nodiscard]] Times times() const;
  [[nodiscard]] std::size_t queue_depth() const;
  /// Share of the last whole second in which an exchange was on the wire, in 0.1 %; on CAN, in which any frame was.
  [[nodiscard]] std::uint16_t load_permille() const;
  void set_decode(bool on);
  /// When it wants its next turn of the loop; long past: the loop does not give it one.
  [[nodiscard]] Instant turn_due() const { return turn_due_; }

 private:
  void on_wire_up() override;
  void on_wire_down(std::string_view why) override;
  void on_reply(const ExchangeResult& result) override;
  void on_unsolicited(const UnsolicitedEvent& unsolicited) override;

  struct Outstanding {
    Exchange exchange;
    DriveSlot drive = 0;
    Priority priority = Priority::poll;
    Instant sent = kLongAgo;
    Instant deadline = kNever;    ///< of the answer
    Instant goes_on_at = kNever;  ///< a part's write goes then, behind its read
    PartWrite part{};
    std::uint32_t bad_frames = 0;  ///< of the wire, when it was sent
  };
  /// Timeouts of a drive in a row, each with a bad frame in place of its answer, after which the log says so.
  static constexpr int kNoisyTimeoutsReported = 3;
  /// Callbacks to drives in one turn of the loop; more go on in the next turn, so that other buses keep their
  /// deadlines.
  static constexpr int kMaxTurnsPerPump = 64;

  void pump();
  bool take_wire_event();
  bool take_unsolicited();
  bool take_turn();
  void grant(const Arbiter::Grant& grant);
  void send(const Exchange& exchange);
  void look_for_noise();
  void end_exchange(const ExchangeResult& result, Duration silence);
  void link_down(const std::string& why);
  void soon();
  void turn_at(Instant due);
  [[nodiscard]] LogSource log_source() const { return bus_source(settings_.name); }

  BusSettings settings_;
  Arbiter arbiter_;
  Runtime& runtime_;
  const Log& log_;
  Instant turn_due_ = kNever;
  bool up_ = false;
  bool pumping_ = false;
  std::vector<BusDrive*> drives_;
  std::vector<int> noisy_timeouts_;  ///< by drive
  std::optional<Outstanding> outstanding_;
  // What the wire said while a callback of ours was running, in the order in which it is taken up.
  std::optional<ExchangeResult> heard_reply_;
  std::optional<std::string> heard_down_;
  bool heard_up_ = false;
  std::deque<UnsolicitedEvent> heard_unsolicited_;
  struct Counted : Statistics {
    ExchangeTimes times{};
  };
  Counted statistics_;  // requests, replies, timeouts
  LoadMeter load_;
  BitMeter bits_;
  // Last, so that they go first: neither may call into a bus that is half gone.
  std::unique_ptr<Timer> timer_;
  std::unique_ptr<Wire> wire_;
};

}  // namespace axisgate::bus
