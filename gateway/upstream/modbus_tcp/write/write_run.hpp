// SPDX-License-Identifier: Apache-2.0
// One write request on its way through the command port: its write batches one after another, then the mailbox.
// Promises one outcome, the first failure's or `ok`, and that the client's result registers follow every write batch,
// also when its connection has gone meanwhile. Never repeats anything.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "gateway/core/log.hpp"
#include "gateway/image/command_port.hpp"
#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/write/write_plan.hpp"

namespace axisgate::modbus_tcp {

class WriteRun : public std::enable_shared_from_this<WriteRun> {
 public:
  using OnDone = std::function<void(const Outcome&)>;

  /// The deadlines hold for the request as a whole (start_deadline_ms, reply_deadline_ms).
  WriteRun(CommandPort& commands, const std::shared_ptr<Client>& client, WritePlan plan, Instant now,
           const ListenerSettings& settings, const Log& log);

  /// With a value: that is the end, and `on_done` is never called. Without: it is called once, later.
  [[nodiscard]] std::optional<Outcome> start(OnDone on_done);
  /// Nobody waits any longer: what was submitted goes on, nothing more is submitted.
  void abandon();

 private:
  [[nodiscard]] std::optional<Outcome> carry_on();
  void on_result(std::uint64_t submission, const BatchResult& result);
  /// The client's result reads "pending"; gives the number by which settle() knows whether it is still the newest.
  std::uint64_t begin(std::uint16_t command_id);
  [[nodiscard]] Outcome answered(const Outcome& outcome) const;
  void forget();
  /// What registers 25 to 27 tell the client, and of which of its write batches.
  struct Shown {
    LatestResult result;
    std::uint64_t submission;
  };
  [[nodiscard]] std::optional<Shown> shown() const;
  [[nodiscard]] std::optional<Shown> shown_pending() const;
  [[nodiscard]] std::optional<std::uint16_t> row_of(const BatchResult& result) const;
  void tell_refused(const Refused& refused, const std::optional<Shown>& stays);
  [[nodiscard]] Outcome done();
  void tell_not_new();
  void settle(std::uint64_t submission, const BatchResult& result);
  void note_presses(ClientAxis& axis, const BatchResult& result) const;
  [[nodiscard]] Outcome submit_object();
  void settle_object(const BatchResult& result);
  [[nodiscard]] Outcome end(const Outcome& outcome);
  [[nodiscard]] ClientAxis* own() const;

  CommandPort& commands_;
  std::weak_ptr<Client> client_;
  WritePlan plan_;
  const Log& log_;
  Instant asked_at_;
  std::size_t next_ = 0;
  std::uint64_t submission_ = 0;  ///< its client's newest as it has left it
  bool abandoned_ = false;
  OnDone on_done_;
};

}  // namespace axisgate::modbus_tcp
