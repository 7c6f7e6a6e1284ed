// SPDX-License-Identifier: Apache-2.0
// The queue of one axis: its write batches wait for the bus, are carried out one exchange at a time, and end with one
// result for each client, at its own deadline. Promises that a stop waits for nothing here, that one stop serves all
// who ask for the same, and that nobody is called back before the axis's image shows the result. Never decides what
// may be carried out: its axis does.
#pragma once

#include <boost/noncopyable.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "adapters/bus/exchange.hpp"
#include "gateway/drive/axis/axis_host.hpp"
#include "gateway/drive/axis/pending_batches.hpp"

namespace axisgate::drive {

/// Clients that may wait for one and the same read or stop.
inline constexpr std::size_t kMaxJoined = 64;
/// So soon what waits for an older stop looks again.
inline constexpr Duration kStopsFirst = std::chrono::milliseconds(20);

/// What the queue asks of its axis, and reports to it.
class QueueOwner : boost::noncopyable {
 public:
  virtual ~QueueOwner() = default;
  /// Its turn has come: ok, or why it ends here.
  [[nodiscard]] virtual Errc may_go_on(Pending& pending) = 0;
  /// Something of it is carried out. `done`: all of it.
  virtual void on_begun(const Pending& pending, bool done) = 0;
  /// Its stop is over. `ended`: it as well; else what stood beside it goes on.
  virtual void on_stop_over(const Pending& pending, bool ended) = 0;
  /// All clients of a stop have their answer, and the stop goes on.
  virtual void on_stop_late(const Pending& pending, const Outcome& outcome) = 0;
  /// It has ended, and is no more in the queue. What is left in its `callbacks` is answered with what is returned.
  [[nodiscard]] virtual BatchResult on_ended(Pending& pending) = 0;
};

class BatchQueue {
 public:
  BatchQueue(AxisCore& core, AxisSlot slot, AxisHost& host, QueueOwner& owner)
      : core_(core), slot_(slot), host_(host), owner_(owner) {}

  /// The same stop waits already: this client waits with the others. False: there is none.
  [[nodiscard]] bool join_stop(const WriteBatch& batch, BatchCallback& on_result);
  /// A stop was accepted: what waits or is under way is overtaken by it.
  void overtake(const WriteBatch& stop);
  /// ok: it waits for the bus. `joined`: with one that reads the same, in whose place it is asked.
  struct Pushed {
    Errc code = Errc::ok;
    bool joined = false;
  };
  [[nodiscard]] Pushed push(Pending pending, bool stop);
  [[nodiscard]] const PendingBatches& pending() const { return pending_; }

  /// The bus job's next exchange; none: it waits or has just ended.
  [[nodiscard]] std::optional<bus::Exchange> on_grant(bus::JobId id);
  [[nodiscard]] bool passes_resync(bus::JobId id);
  void on_result(bus::JobId id, const bus::ExchangeResult& result, Instant sent_at, bool trusted);
  void on_job_ended(bus::JobId id, Errc code);
  /// Deadlines of clients.
  void on_time();
  [[nodiscard]] Instant next_deadline() const;

  /// The gateway ends: what waits ends as never started; what has begun ends after its exchange; stops go on to their
  /// end.
  void close();
  void reopen() { closing_ = false; }
  [[nodiscard]] bool closing() const { return closing_; }

  /// These are called back with the others.
  void answer(const BatchResult& result, std::vector<Waiting> waiting);
  void call_back();
  [[nodiscard]] bool has_due() const { return !due_.empty(); }

 private:
  struct Due {
    BatchResult result;
    std::vector<Waiting> callbacks;
  };
  [[nodiscard]] static Instant deadline_of(const Pending& pending, const Waiting& client);
  void hold_rest(const Pending& pending);
  void carry_on(Pending& pending);
  [[nodiscard]] bool ends_with_gateway(const Pending& pending) const;
  void expire(Pending& pending);
  void complete(bus::JobId id);

  AxisCore& core_;
  AxisSlot slot_;
  AxisHost& host_;
  QueueOwner& owner_;
  PendingBatches pending_;
  std::vector<Due> due_;
  bool closing_ = false;  ///< the gateway ends, or lets go of the drive
};

}  // namespace axisgate::drive
