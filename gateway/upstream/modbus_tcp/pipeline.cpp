#include "gateway/upstream/modbus_tcp/pipeline.hpp"

#include <cassert>
#include <string>
#include <utility>

#include "gateway/upstream/modbus_tcp/device_identification.hpp"
#include "gateway/upstream/modbus_tcp/reads.hpp"

namespace axisgate::modbus_tcp {
namespace {

/// "writes": "posted": what range, role, owner and queue checks found is the answer; what became of the write otherwise
/// is told by registers 25, 26 and 30, so that FC 23 never loses its read to a link.
bool found_by_checks(Errc code) { return command_result(code) == CommandResult::none || code == Errc::not_owner; }

}  // namespace

Pipeline::Pipeline(const SessionContext& context, Role role, std::shared_ptr<Client> client, Emit emit,
                   OnResult on_result)
    : context_(context),
      role_(role),
      client_(std::move(client)),
      emit_(std::move(emit)),
      on_result_(std::move(on_result)) {}

Pipeline::~Pipeline() { abandon(); }

Onlooker Pipeline::onlooker(Instant now) const {
  return {context_.image, context_.commands, context_.settings, *client_, role_, now};
}

void Pipeline::accept(const Frame& frame, Instant now) {
  assert(entries_.size() < kMaxPipelined);
  ++context_.clients.counters.messages;
  const auto view = UnitView::of(frame.unit, context_.settings, context_.image);
  std::variant<Request, ModbusException> decoded = decode_request(frame.pdu);
  Request* const request = std::get_if<Request>(&decoded);
  // The common case, and the only one that must be quick: a read with nothing before it.
  if (entries_.empty() && view && request != nullptr && !request->writes()) {
    return send(frame.transaction, frame.unit, answer(*request, *view, now));
  }
  Entry& entry = entries_.emplace_back();
  entry.number = ++last_number_;
  entry.transaction = frame.transaction;
  entry.unit = frame.unit;
  entry.view = view;
  if (!view) {
    entry.reply = exception_pdu(frame.pdu[0], ModbusException::gateway_path_unavailable);
  } else if (request == nullptr) {
    entry.reply = exception_pdu(frame.pdu[0], std::get<ModbusException>(decoded));
  } else {
    entry.stage = request->writes() ? Stage::waiting : Stage::at_turn;
    entry.request = *request;
  }
  start_ready(now);
  flush(now);
}

/// FC 22 masks the value at the moment it is carried out, so what this connection has under way must have ended first.
bool Pipeline::must_wait(std::size_t position) const {
  if (entries_[position].request.function != Function::mask_write_register) return false;
  for (std::size_t i = 0; i < position; ++i)
    if (entries_[i].stage == Stage::running) return true;
  return false;
}

/// On arrival, all that can be; behind a request that has to wait only stops, so that writes keep their order.
void Pipeline::start_ready(Instant now) {
  bool held_back = false;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    if (entry.stage != Stage::waiting) continue;
    const bool stop = asks_for_a_stop(entry.request, *entry.view, context_.image);
    if (!stop && (held_back || must_wait(i))) {
      held_back = true;
      continue;
    }
    if (stop && held_back) drop_waiting_before(i);
    start(entry, now);
  }
}

/// What the client asked for before it asked to stop must not be carried out after the stop.
void Pipeline::drop_waiting_before(std::size_t stop) {
  const AxisNumber axis = axis_of_write(entries_[stop].request, *entries_[stop].view, context_.image);
  for (std::size_t i = 0; i < stop; ++i) {
    Entry& entry = entries_[i];
    if (entry.stage == Stage::waiting && axis_of_write(entry.request, *entry.view, context_.image) == axis) {
      finish(entry, {Errc::dropped_by_stop, 0});
    }
  }
}

void Pipeline::start(Entry& entry, Instant now) {
  Planned planned = plan_write(entry.request, *entry.view, onlooker(now), *client_);
  if (const Errc* const refused = std::get_if<Errc>(&planned)) {
    // The outcome table's "command_result 0": no older result may be taken for this write's.
    if (const AxisNumber axis = axis_of_write(entry.request, *entry.view, context_.image); axis != 0) {
      ClientAxis& own = client_->at(axis);
      own.used = true;
      own.result = {};
      ++own.submission;
    }
    return finish(entry, {*refused, 0});
  }
  entry.run = std::make_shared<WriteRun>(context_.commands, client_, std::get<WritePlan>(std::move(planned)), now,
                                         context_.settings);
  entry.stage = Stage::running;
  const bool posted = context_.settings.posted_writes;
  WriteRun::OnDone on_done;
  if (!posted) on_done = [this, number = entry.number](const Outcome& outcome) { on_result_(number, outcome); };
  const std::optional<Outcome> at_once = entry.run->start(std::move(on_done));
  if (posted) {
    finish(entry, at_once && found_by_checks(at_once->code) ? *at_once : Outcome{});
  } else if (at_once) {
    finish(entry, *at_once);
  }
}

void Pipeline::finish(Entry& entry, const Outcome& outcome) {
  entry.run = nullptr;
  if (outcome.code != Errc::ok) {
    if (context_.log.wants(LogLevel::debug)) {
      context_.log.write(LogLevel::debug, "modbus",
                         "write to " + std::to_string(entry.request.write_address) + " ended: " +
                             std::string(text(outcome.code)) + ", detail " + std::to_string(outcome.detail));
    }
    return refuse(entry, modbus_exception(outcome.code));
  }
  if (entry.request.reads()) {
    entry.stage = Stage::at_turn;
    return;
  }
  entry.stage = Stage::answered;
  entry.reply = write_reply(entry.request);
}

void Pipeline::refuse(Entry& entry, ModbusException exception) {
  entry.stage = Stage::answered;
  entry.reply = exception_pdu(static_cast<Byte>(entry.request.function), exception);
}

void Pipeline::conclude(std::uint64_t number, const Outcome& outcome, Instant now) {
  for (Entry& entry : entries_) {
    if (entry.number != number || entry.stage != Stage::running) continue;
    finish(entry, outcome);
    start_ready(now);
    return flush(now);
  }
}

void Pipeline::flush(Instant now) {
  while (!entries_.empty() && entries_.front().stage >= Stage::at_turn) {
    Entry& first = entries_.front();
    if (first.stage == Stage::at_turn) first.reply = answer(first.request, *first.view, now);
    send(first.transaction, first.unit, first.reply);
    entries_.pop_front();
  }
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

void Pipeline::send(std::uint16_t transaction, std::uint8_t unit, const Pdu& reply) {
  ++context_.clients.counters.server_messages;
  if ((reply[0] & 0x80U) != 0) ++context_.clients.counters.exceptions;
  emit_(transaction, unit, reply);
}

void Pipeline::abandon() {
  context_.clients.counters.unanswered += static_cast<std::uint32_t>(entries_.size());
  for (Entry& entry : entries_)
    if (entry.run != nullptr) entry.run->abandon();
  entries_.clear();
}

}  // namespace axisgate::modbus_tcp
