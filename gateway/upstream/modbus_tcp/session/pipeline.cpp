// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/session/pipeline.hpp"

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

#include "gateway/core/words.hpp"
#include "gateway/upstream/modbus_tcp/read/reads.hpp"
#include "gateway/upstream/modbus_tcp/read/references.hpp"
#include "gateway/upstream/modbus_tcp/session/device_identification.hpp"

namespace axisgate::modbus_tcp {
namespace {

constexpr Byte kExceptionBit = 0x80;  // V1.1b3 section 7

/// What is carried out by the command port, or may be; all else is answered from the image.
bool is_carried_out(const Request& request) { return request.writes() || request.reference.has_value(); }

/// "writes": "posted": what range, role, owner and queue checks found is the answer; what became of the write otherwise
/// is told by registers 25, 26 and 30, so that FC 23 never loses its read to a link.
bool found_by_checks(Errc code) {
  return command_result(code) == CommandResult::none || code == Errc::not_owner || code == Errc::not_new;
}

}  // namespace

Pipeline::Pipeline(const SessionContext& context, Role role, std::shared_ptr<Client> client, Instant now, Emit emit,
                   OnResult on_result)
    : context_(context),
      role_(role),
      client_(std::move(client)),
      emit_(std::move(emit)),
      on_result_(std::move(on_result)),
      words_(std::make_shared<ConnectionWords>(ConnectionWords{now})) {}

Pipeline::~Pipeline() { abandon(); }

Onlooker Pipeline::onlooker(Instant now) const {
  return {context_.image, context_.commands, context_.settings, *client_, words_, role_, now};
}

void Pipeline::accept(const Frame& frame, Instant now, Instant came) {
  assert(entries_.size() < kMaxPipelined);
  ++context_.clients.counters.messages;
  ++context_.clients.figures.requests;
  const auto view = UnitView::of(frame.unit, context_.settings, context_.image);
  std::variant<Request, ModbusException> decoded = decode_request(frame.pdu);
  Request* const request = std::get_if<Request>(&decoded);
  const bool writes = request != nullptr && (request->writes() || (request->reference && request->reference->write));
  Instant& heard = client_->life->last_request;
  if (!context_.settings.client_is_address) heard = std::max(heard, came);
  on_deadline(now);
  // The common case, and the only one that must be quick: a read with nothing before it.
  if (entries_.empty() && view && request != nullptr && !is_carried_out(*request)) {
    return send(frame.transaction, frame.unit, answer(*request, *view, now), now - came);
  }
  Entry& entry = entries_.emplace_back();
  entry.number = ++last_number_;
  entry.arrived = now;
  entry.came = came;
  entry.waited = came < now;
  entry.transaction = frame.transaction;
  entry.unit = frame.unit;
  entry.view = view;
  if (!view) {
    entry.reply = exception_pdu(frame.pdu[0], ModbusException::gateway_path_unavailable);
  } else if (request == nullptr) {
    entry.reply = exception_pdu(frame.pdu[0], std::get<ModbusException>(decoded));
  } else {
    entry.stage = is_carried_out(*request) ? Stage::waiting : Stage::at_turn;
    entry.request = *request;
    entry.axis = axis_of(*request, *view);
    if (const AxisImage* const axis = context_.image.find(entry.axis)) entry.point = axis->record.now();
  }
  const bool is_write = writes || (request == nullptr && is_write_function(frame.pdu[0]));
  if (context_.settings.staged_halves && is_write) stage_half(entry, now);
  start_ready(now);
  flush(now);
}

/// A first half is answered as written, and waits; with the second one the row is written whole. Any other write, also
/// one that is refused, drops a half that waits.
void Pipeline::stage_half(Entry& entry, Instant now) {
  const auto half = entry.view ? half_write(entry.request, *entry.view, context_.image) : std::nullopt;
  if (!half) return drop_half("another write came between");
  const auto other = half_.take_other(*half);
  if (!other) drop_half("another write came between");
  const Request whole = whole_write(*half, other ? other->word : std::uint16_t{0});
  if (!other) {
    if (const Errc wrong = check_row(whole, *entry.view, onlooker(now)); wrong != Errc::ok) {
      tell_refused(entry, {wrong}, now);
      return finish(entry, {wrong, 0});
    }
    half_.keep(*half, now);
  }
  entry.reply = write_reply(entry.request);
  entry.stage = other ? Stage::waiting : Stage::answered;
  entry.halves = true;
  if (!other) return;
  entry.request = whole;
  note_whole_row(client_->at(half->axis));
}

AxisNumber Pipeline::axis_of(const Request& request, const UnitView& view) const {
  if (!request.reference) return axis_of_write(request, view, context_.image);
  const AxisImage* const axis = view.axis_of_node(request.reference->node, context_.image);
  return axis == nullptr ? AxisNumber{0} : axis->number;
}

void Pipeline::on_deadline(Instant now) {
  if (half_.until() <= now) drop_half("the other half did not come within a second");
}

void Pipeline::drop_half(const char* why) {
  if (const auto half = half_.take()) tell_dropped_half(half->axis, half->row, why, *client_, context_.log);
}

/// FC 22 masks the value at the moment it is carried out, so what this connection writes to the same axis must have
/// ended first. What follows such a write to that axis keeps its place.
bool Pipeline::must_wait(std::size_t position) const {
  const Entry& entry = entries_[position];
  const bool masks = entry.request.function == Function::mask_write_register;
  for (std::size_t i = 0; i < position; ++i) {
    const Entry& before = entries_[i];
    if ((before.stage == Stage::waiting || (masks && before.is_running_write())) && before.axis == entry.axis)
      return true;
  }
  return false;
}

/// On arrival, all that can be; what has to wait is passed by stops alone.
void Pipeline::start_ready(Instant now) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    if (entry.stage != Stage::waiting) continue;
    if (must_wait(i)) {
      entry.waited = true;
      if (!asks_for_a_stop(entry.request, *entry.view, onlooker(now))) continue;
      drop_waiting_before(i);
    } else if (const Errc why = entry.waited ? too_late(entry, now) : Errc::ok;
               why != Errc::ok && !asks_for_a_stop(entry.request, *entry.view, onlooker(now))) {
      drop(entry, why);
      continue;
    }
    start(entry, now);
  }
}

/// What the client asked for before it asked to stop must not be carried out after the stop.
void Pipeline::drop_waiting_before(std::size_t stop) {
  for (std::size_t i = 0; i < stop; ++i) {
    Entry& entry = entries_[i];
    if (entry.stage == Stage::waiting && entry.writes() && entry.axis == entries_[stop].axis)
      drop(entry, Errc::dropped_by_stop);
  }
}

/// Why what had to wait is not begun any more: it came too long ago, or its axis was stopped since, by whomever. A
/// fault and a loss have stopped it as well.
Errc Pipeline::too_late(const Entry& entry, Instant now) const {
  constexpr ClientId kAnybody = ~ClientId{0};
  const AxisImage* const axis = context_.image.find(entry.axis);
  if (entry.writes() && axis != nullptr && axis->record.interrupted(entry.point, kAnybody))
    return Errc::dropped_by_stop;
  return now - entry.came >= context_.settings.start_deadline ? Errc::never_started : Errc::ok;
}

void Pipeline::drop(Entry& entry, Errc why) {
  if (entry.request.writes() && entry.axis != 0) {
    ClientAxis& own = client_->at(entry.axis);
    own.used = true;
    own.result = {command_result(why), 0, 0};
    ++own.submission;
  }
  finish(entry, {why, 0});
}

void Pipeline::start(Entry& entry, Instant now) {
  if (entry.request.reference) return start_object(entry, now);
  Planned planned = plan_write(entry.request, *entry.view, onlooker(now), *client_);
  if (const Refused* const refused = std::get_if<Refused>(&planned)) {
    tell_refused(entry, *refused, now);
    carry_out(refused->stops, entry.arrived);
    return finish(entry, {refused->code, 0});
  }
  const bool reads_alone = std::get<WritePlan>(planned).reads_alone;
  entry.run = std::make_shared<WriteRun>(context_.commands, client_, std::get<WritePlan>(std::move(planned)),
                                         entry.arrived, context_.settings, context_.log);
  entry.stage = Stage::running;
  const bool posted = context_.settings.posted_writes;
  WriteRun::OnDone on_done;
  if (!posted) on_done = [this, number = entry.number](const Outcome& outcome) { on_result_(number, outcome); };
  const std::optional<Outcome> at_once = entry.run->start(std::move(on_done));
  if (!reads_alone && (!at_once || at_once->code == Errc::ok)) note_accepted_write(entry);
  if (posted) {
    finish(entry, at_once && found_by_checks(at_once->code) ? *at_once : Outcome{});
  } else if (at_once) {
    finish(entry, *at_once);
  }
}

/// A client that is an address has programs that only look, or may write nothing: what they ask, and what is refused
/// them, is no sign of the one that commands.
void Pipeline::note_accepted_write(const Entry& entry) {
  Instant& last = client_->life->last_request;
  if (role_ >= Role::operator_) last = std::max(last, entry.came);
}

/// The outcome table's "command_result 0": no older result may be taken for this write's.
void Pipeline::tell_refused(const Entry& entry, const Refused& refused, Instant now) {
  const AxisNumber axis = entry.axis;
  if ((axis == 0 || !refused.row) && refused.code != Errc::link_lost)
    log_refused_write(block_write(entry.request, axis), {refused.code}, *client_, now, context_.log);
  if (axis == 0) return;
  ClientAxis& own = client_->at(axis);
  if (refused.row) {
    show_refused(own, *refused.row);
    return log_refused(block_write(entry.request, axis), {*refused.row, refused.code}, *client_, context_.log);
  }
  own.used = true;
  own.result = {};
  ++own.submission;
}

/// Nobody is told: the answer is of what was refused. What does not come through is owed (design 3.4 Owed stops).
void Pipeline::carry_out(const std::vector<AxisStop>& stops, Instant arrived) {
  for (const AxisStop& stop : stops) {
    WriteBatch batch = stop.batch;
    batch.start_by = arrived + context_.settings.start_deadline;
    batch.answer_by = arrived + context_.settings.reply_deadline;
    static_cast<void>(context_.commands.submit(stop.axis, batch, [](const BatchResult&) {}));
  }
}

/// "writes": "posted" changes nothing here: the reply is the only place that tells how it ended.
void Pipeline::start_object(Entry& entry, Instant now) {
  ReferencePlan plan = plan_reference(entry.request, *entry.view, onlooker(now), *client_);
  if (plan.refused != Errc::ok) {
    const GeneralReference& reference = *entry.request.reference;
    if (reference.write) log_refused_object(reference, {plan.refused}, *client_, now, context_.log);
    return refuse(entry, modbus_exception(plan.refused));
  }
  entry.object_axis = plan.axis;
  entry.stage = Stage::at_turn;
  const bool writes = entry.request.reference->write;
  if (!plan.batch) {
    if (writes) note_accepted_write(entry);
    return;
  }
  plan.batch->start_by = entry.arrived + context_.settings.start_deadline;
  plan.batch->answer_by = entry.arrived + context_.settings.reply_deadline;
  entry.object_run = std::make_shared<ObjectRun>(client_, plan.axis);
  entry.stage = Stage::running;
  const auto at_once =
      entry.object_run->start(context_.commands, *plan.batch, [this, number = entry.number](const BatchResult& result) {
        for (Entry& each : entries_)
          if (each.number == number) finish_object(each, result);
        on_result_(number, result.outcome);
      });
  if (writes && (!at_once || at_once->outcome.code == Errc::ok)) note_accepted_write(entry);
  if (at_once) finish_object(entry, *at_once);
}

/// Its reply, and what it does to the client's buffers, come at its turn.
void Pipeline::finish_object(Entry& entry, const BatchResult& result) {
  entry.object_run = nullptr;
  entry.object_result = result;
  entry.stage = Stage::at_turn;
  log_failure(entry.request, result.outcome);
}

void Pipeline::finish(Entry& entry, const Outcome& outcome) {
  entry.run = nullptr;
  log_failure(entry.request, outcome);
  if (outcome.code == Errc::not_new) log_not_new(entry);
  if (outcome.code != Errc::ok) return refuse(entry, modbus_exception(outcome.code));
  if (entry.request.reads()) {
    entry.stage = Stage::at_turn;
    return;
  }
  entry.stage = Stage::answered;
  if (!entry.halves) entry.reply = write_reply(entry.request);
}

void Pipeline::log_failure(const Request& request, const Outcome& outcome) const {
  if (outcome.code == Errc::ok || !context_.log.wants(LogLevel::debug)) return;
  const auto& reference = request.reference;
  const std::string what = reference ? "object " + hex_text({reference->head.data(), reference->head.size()})
                                     : "write to " + std::to_string(request.write_address);
  context_.log.write(LogLevel::debug, "modbus", client_->life->name + ": " + what + " ended: " + modbus_text(outcome));
}

void Pipeline::log_exception(const Pdu& reply) const {
  if (!context_.log.wants(LogLevel::debug)) return;
  const Byte function = reply[0] & static_cast<Byte>(~kExceptionBit);
  const auto word = name_of(WordKind::exception, reply[1]);
  context_.log.write(LogLevel::debug, "modbus",
                     client_->life->name + ": function 0x" + hex_text({&function, 1}) +
                         " is answered with exception 0x" + hex_text({&reply[1], 1}) + " " + std::string(word));
}

/// Once, until something of this client's acts again: a tool in a loop must not fill the log.
void Pipeline::log_not_new(const Entry& entry) {
  const AxisNumber axis = entry.axis;
  if (axis == 0) return;
  ClientAxis& own = client_->at(axis);
  if (own.not_new_logged) return;
  own.not_new_logged = true;
  context_.log.write(LogLevel::info, "modbus",
                     client_->life->name + ": a write to " + std::to_string(entry.request.write_address) + " (axis " +
                         std::to_string(axis) + ") is not new and does nothing: write 0 first");
}

void Pipeline::refuse(Entry& entry, ModbusException exception) {
  entry.stage = Stage::answered;
  entry.reply = exception_pdu(static_cast<Byte>(entry.request.function), exception);
}

void Pipeline::conclude(std::uint64_t number, const Outcome& outcome, Instant now) {
  for (Entry& entry : entries_) {
    if (entry.number != number) continue;
    if (entry.stage == Stage::running) finish(entry, outcome);
    start_ready(now);
    return flush(now);
  }
}

void Pipeline::flush(Instant now) {
  while (!entries_.empty() && entries_.front().stage >= Stage::at_turn) {
    Entry& first = entries_.front();
    if (first.stage == Stage::at_turn) first.reply = answer(first, now);
    send(first.transaction, first.unit, first.reply, now - first.came);
    entries_.pop_front();
  }
}

Pdu Pipeline::answer(const Entry& entry, Instant now) const {
  return entry.request.reference
             ? answer_reference(entry.request, entry.object_axis, entry.object_result, *client_, now)
             : answer(entry.request, *entry.view, now);
}

Pdu Pipeline::answer(const Request& request, const UnitView& view, Instant now) const {
  if (request.reads()) return answer_read(request, view, onlooker(now));
  if (request.function == Function::diagnostics) {
    return answer_diagnostics(request, role_, context_.clients.counters);
  }
  if (role_ < Role::viewer) {
    return exception_pdu(static_cast<Byte>(request.function), ModbusException::illegal_function);
  }
  return answer_identification(request, identification_objects(context_.image, context_.settings));
}

void Pipeline::send(std::uint16_t transaction, std::uint8_t unit, const Pdu& reply, Duration took) {
  RequestFigures& figures = context_.clients.figures;
  ++context_.clients.counters.server_messages;
  figures.took.add(took);
  if ((reply[0] & kExceptionBit) != 0) {
    ++context_.clients.counters.exceptions;
    if (reply[1] < figures.exceptions.size()) ++figures.exceptions[reply[1]];
    log_exception(reply);
  }
  emit_(transaction, unit, reply);
}

void Pipeline::abandon() {
  drop_half("its connection has ended");
  context_.clients.counters.unanswered += static_cast<std::uint32_t>(entries_.size());
  for (Entry& entry : entries_) {
    if (entry.run != nullptr) entry.run->abandon();
    if (entry.object_run != nullptr) entry.object_run->abandon();
  }
  entries_.clear();
}

}  // namespace axisgate::modbus_tcp
