// SPDX-License-Identifier: Apache-2.0
// The requests of one connection that are under way, at most kMaxPipelined: started on arrival, answered in order.
// Promises each request exactly one reply and that a stop never waits behind a slow write. Pure: replies go to `emit`.
// Never knows bytes on the stream: frames come in, PDUs go out.
#pragma once

#include <boost/noncopyable.hpp>
#include <deque>
#include <functional>
#include <memory>

#include "gateway/upstream/modbus_tcp/read/unit_view.hpp"
#include "gateway/upstream/modbus_tcp/session/object_run.hpp"
#include "gateway/upstream/modbus_tcp/session/session.hpp"
#include "gateway/upstream/modbus_tcp/wire/mbap.hpp"
#include "gateway/upstream/modbus_tcp/wire/pdu.hpp"
#include "gateway/upstream/modbus_tcp/write/staged_half.hpp"
#include "gateway/upstream/modbus_tcp/write/write_run.hpp"

namespace axisgate::modbus_tcp {

class Pipeline : boost::noncopyable {
 public:
  using Emit = std::function<void(std::uint16_t transaction, std::uint8_t unit, const Pdu& reply)>;
  /// `on_result` is called with the number of a request whose write, or whose object, has ended, never from inside
  /// accept().
  using OnResult = std::function<void(std::uint64_t number, const Outcome& outcome)>;

  Pipeline(const SessionContext& context, Role role, std::shared_ptr<Client> client, Instant now, Emit emit,
           OnResult on_result);
  ~Pipeline();

  [[nodiscard]] std::size_t under_way() const { return entries_.size(); }
  /// Only while under_way() < kMaxPipelined. `came`: it waits since then, in its socket perhaps.
  void accept(const Frame& frame, Instant now, Instant came);
  /// The end of a request, as on_result reported it. Unknown numbers are harmless.
  void conclude(std::uint64_t number, const Outcome& outcome, Instant now);
  /// When something is to be done although nothing came: on_deadline().
  [[nodiscard]] Instant next_deadline() const { return half_.until(); }
  void on_deadline(Instant now);
  /// Nobody is left to answer.
  void abandon();

 private:
  enum class Stage : std::uint8_t {
    waiting,   ///< a write, or a function 43/13, that has not begun
    running,   ///< in the command port
    at_turn,   ///< answered when all before it are: the newest values, and the effect of its own write (FC 23)
    answered,  ///< the reply stands
  };
  struct Entry {
    std::uint64_t number = 0;
    Instant arrived;
    Instant came;
    AxisNumber axis = 0;          ///< that it is carried out on; 0: none
    AxisRecord::Point point = 0;  ///< of that axis's record, when it arrived
    bool waited = false;
    std::uint16_t transaction = 0;
    std::uint8_t unit = 0;
    Stage stage = Stage::answered;
    std::optional<UnitView> view;
    Request request;
    Pdu reply;  ///< of a write of two halves it is made on arrival: it repeats the second one
    bool halves = false;
    std::shared_ptr<WriteRun> run;
    // Of function 43/13.
    std::shared_ptr<ObjectRun> object_run;
    AxisNumber object_axis = 0;
    std::optional<BatchResult> object_result;

    [[nodiscard]] bool writes() const { return request.writes() || (request.reference && request.reference->write); }
    /// What has to have ended before a value is masked.
    [[nodiscard]] bool is_running_write() const { return stage == Stage::running && writes(); }
  };

  void stage_half(Entry& entry, Instant now);
  void drop_half(const char* why);
  void start_ready(Instant now);
  [[nodiscard]] bool must_wait(std::size_t position) const;
  void drop_waiting_before(std::size_t stop);
  [[nodiscard]] Errc too_late(const Entry& entry, Instant now) const;
  void drop(Entry& entry, Errc why);
  void start(Entry& entry, Instant now);
  void note_accepted_write(const Entry& entry);
  void carry_out(const std::vector<AxisStop>& stops, Instant arrived);
  void start_object(Entry& entry, Instant now);
  void finish(Entry& entry, const Outcome& outcome);
  void finish_object(Entry& entry, const BatchResult& result);
  void log_not_new(const Entry& entry);
  void log_failure(const Request& request, const Outcome& outcome) const;
  void log_exception(const Pdu& reply) const;
  void tell_refused(const Entry& entry, const Refused& refused, Instant now);
  void refuse(Entry& entry, ModbusException exception);
  void flush(Instant now);
  [[nodiscard]] AxisNumber axis_of(const Request& request, const UnitView& view) const;
  [[nodiscard]] Pdu answer(const Entry& entry, Instant now) const;
  [[nodiscard]] Pdu answer(const Request& request, const UnitView& view, Instant now) const;
  [[nodiscard]] Onlooker onlooker(Instant now) const;
  /// `took`: since it came.
  void send(std::uint16_t transaction, std::uint8_t unit, const Pdu& reply, Duration took);

  SessionContext context_;
  Role role_;
  std::shared_ptr<Client> client_;
  Emit emit_;
  OnResult on_result_;
  std::shared_ptr<ConnectionWords> words_;
  std::deque<Entry> entries_;
  StagedHalf half_;
  std::uint64_t last_number_ = 0;
};

}  // namespace axisgate::modbus_tcp
