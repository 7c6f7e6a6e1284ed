// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/axis/batch_queue.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "gateway/drive/plan/admission.hpp"

namespace axisgate::drive {

// --- What comes in ---------------------------------------------------------------------------------------------------

// Two panels pressing the same stop need it on the wire once. What else stands beside one is not the other's result;
// and what was asked between the two, an enable perhaps, the later stop must end: it is a bus job of its own.
bool BatchQueue::join_stop(const WriteBatch& batch, BatchCallback& on_result) {
  if (!stops_alone(batch)) return false;
  for (auto newest = pending_.rbegin(); newest != pending_.rend(); ++newest) {
    Pending& p = *newest;
    const WriteBatch& waiting = p.batch();
    if (!p.command_sequence->is_stop()) return false;
    if (p.command_sequence->begun() || p.callbacks.size() >= kMaxJoined) continue;
    if (p.refusal != Errc::ok || !stops_alone(waiting) || waiting.command != batch.command ||
        waiting.controlword != batch.controlword)
      continue;
    p.callbacks.push_back({std::move(on_result), kNever, batch.answer_by});
    return true;
  }
  return false;
}

void BatchQueue::overtake(const WriteBatch& stop) {
  for (Pending& p : pending_) {
    if (p.stopped_by) continue;
    p.stopped_by = stop.client;
    if (stop.life) p.stopped_by_name = stop.life->name;
  }
}

BatchQueue::Pushed BatchQueue::push(Pending pending, bool stop) {
  bus::BusJob job = job_for(core_, pending.batch(), stop);
  job.axis = slot_;
  const AxisHost::Queued queued = host_.queue(std::move(job));
  if (queued.code != Errc::ok) return {queued.code};
  if (queued.joined) {
    Pending* shared = pending_.find(queued.id);
    if (shared == nullptr || shared->callbacks.size() >= kMaxJoined) return {Errc::queue_full};
    shared->start_by = std::max(shared->start_by, pending.start_by);
    shared->callbacks.push_back(std::move(pending.callbacks.front()));
    return {Errc::ok, true};
  }
  pending.id = queued.id;
  pending_.push_back(std::move(pending));
  return {};
}

// --- Carrying it out -------------------------------------------------------------------------------------------------

// A stop ramps down, and still shows enabled: what would enable or start comes when it is over. What came later than a
// stop's own set-points comes after them (3.3, the order of one axis).
// The newer stop goes first; of what stands beside the two the older set-points are not the last ones accepted.
void BatchQueue::hold_rest(const Pending& pending) {
  CommandSequence& sequence = *pending.command_sequence;
  if (!sequence.began_as_stop() || stops_alone(sequence.batch())) return;
  sequence.hold_rest(pending_.is_behind_rest_of_stop(pending) ? core_.turn.now + kStopsFirst : kLongAgo);
}

std::optional<bus::Exchange> BatchQueue::on_grant(bus::JobId id) {
  Pending* pending = pending_.find(id);
  if (pending == nullptr) return std::nullopt;
  CommandSequence& sequence = *pending->command_sequence;
  if (ends_with_gateway(*pending)) {
    expire(*pending);
    return std::nullopt;
  }
  if (!sequence.is_stop() && pending_.waits_for_stop(*pending)) {
    host_.job_waits(id, core_.turn.now + kStopsFirst);
    return std::nullopt;
  }
  if (const Errc code = owner_.may_go_on(*pending); code != Errc::ok) {
    sequence.abort(refusal(code));
    complete(id);
    return std::nullopt;
  }
  hold_rest(*pending);
  const auto move = sequence.granted();
  owner_.on_begun(*pending, false);
  if (move.kind == CommandSequence::Move::Kind::exchange) return move.exchange;
  if (move.kind == CommandSequence::Move::Kind::wait)
    host_.job_waits(id, move.until);
  else
    complete(id);
  return std::nullopt;
}

bool BatchQueue::passes_resync(bus::JobId id) {
  Pending* pending = pending_.find(id);
  return pending != nullptr && pending->command_sequence->passes_resync();
}

void BatchQueue::on_result(bus::JobId id, const bus::ExchangeResult& result, Instant sent_at, bool trusted) {
  Pending* pending = pending_.find(id);
  if (pending == nullptr) return;
  pending->command_sequence->on_result(result, sent_at, trusted);
  carry_on(*pending);
}

void BatchQueue::carry_on(Pending& pending) {
  CommandSequence& sequence = *pending.command_sequence;
  hold_rest(pending);
  const auto move = sequence.advance();
  if (move.kind == CommandSequence::Move::Kind::finished) return complete(pending.id);
  if (ends_with_gateway(pending)) return expire(pending);
  if (move.kind == CommandSequence::Move::Kind::wait) host_.job_waits(pending.id, move.until);
  if (!sequence.stop_is_over()) return;
  owner_.on_stop_over(pending, false);
  // What commands waited behind this stop, and a later one drops it, as it drops whatever commands and waits.
  if (pending.stopped_by && asks_to_begin(sequence.batch())) return on_job_ended(pending.id, Errc::dropped_by_stop);
  // The stop is done; the rest of its write batch goes on where it stands, and has no precedence any more.
  bus::BusJob rest = job_for(core_, sequence.batch(), false);
  rest.read.reset();
  rest.setpoints_only = false;
  rest.start_by = kNever;
  if (host_.job_goes_on_as(pending.id, rest)) return sequence.stop_was_handed_over();
  sequence.abort({Errc::queue_full, 0});
  complete(pending.id);
}

void BatchQueue::on_job_ended(bus::JobId id, Errc code) {
  Pending* pending = pending_.find(id);
  if (pending == nullptr) return;
  CommandSequence& sequence = *pending->command_sequence;
  const bool begun = sequence.begun();
  const bool by_other = pending->stopped_by && *pending->stopped_by != sequence.batch().client;
  if (code == Errc::dropped_by_stop && begun && by_other) code = Errc::stopped_by_other;
  // Whether something was sent is what tells the two apart, not whether the bus had granted it a turn.
  if (code == Errc::link_lost && !begun) code = Errc::offline;
  if (code == Errc::offline && begun) code = Errc::link_lost;
  sequence.abort(refusal(code));
  complete(id);
}

void BatchQueue::complete(bus::JobId id) {
  const auto found = std::ranges::find_if(pending_, [&](const Pending& p) { return p.id == id; });
  if (found == pending_.end()) return;
  Pending pending = std::move(*found);
  pending_.erase(found);
  host_.job_done(id);
  const BatchResult result = owner_.on_ended(pending);
  answer(result, std::move(pending.callbacks));
}

// --- What becomes due ------------------------------------------------------------------------------------------------

// The latest start is the bus's to judge; who joined with an earlier one must not have it stretched.
Instant BatchQueue::deadline_of(const Pending& pending, const Waiting& client) {
  const bool may_expire = client.start_by < pending.start_by && !pending.command_sequence->begun();
  return may_expire ? std::min(client.start_by, client.answer_by) : client.answer_by;
}

void BatchQueue::on_time() {
  const Instant now = core_.turn.now;
  std::vector<bus::JobId> late;
  const auto is_late = [now](const Pending& p) {
    return [now, &p](const Waiting& client) { return now >= deadline_of(p, client); };
  };
  for (const Pending& p : pending_)
    if (std::ranges::any_of(p.callbacks, is_late(p))) late.push_back(p.id);
  for (const bus::JobId id : late) {
    Pending* pending = pending_.find(id);
    if (pending == nullptr) continue;  // what was withdrawn for another has dropped it
    CommandSequence& sequence = *pending->command_sequence;
    auto& clients = pending->callbacks;
    const auto first = std::stable_partition(clients.begin(), clients.end(), std::not_fn(is_late(*pending)));
    const bool stops = sequence.is_stop() && !sequence.stop_is_over();
    // Others still wait for it; or its clients have their answer, and the stop goes on until it shows, or was repeated
    // as often as it may.
    if (first == clients.begin() && !stops) {
      expire(*pending);
      continue;
    }
    const Outcome outcome = sequence.outcome_if_late();
    answer({.outcome = outcome}, {std::make_move_iterator(first), std::make_move_iterator(clients.end())});
    clients.erase(first, clients.end());
    if (clients.empty()) owner_.on_stop_late(*pending, outcome);
  }
}

Instant BatchQueue::next_deadline() const {
  Instant next = kNever;
  for (const Pending& p : pending_)
    for (const Waiting& client : p.callbacks) next = std::min(next, deadline_of(p, client));
  return next;
}

void BatchQueue::expire(Pending& pending) {
  pending.command_sequence->expire();
  complete(pending.id);
}

void BatchQueue::close() {
  closing_ = true;
  std::vector<bus::JobId> waiting;
  std::vector<bus::JobId> begun;
  for (const Pending& pending : pending_)
    if (ends_with_gateway(pending)) (pending.command_sequence->begun() ? begun : waiting).push_back(pending.id);
  for (const bus::JobId id : waiting) on_job_ended(id, Errc::never_started);
  // Those that wait for their next step have their turn at once; of one on the wire the reply is awaited. Some of its
  // steps were sent, and the rest will not be: what might still come of them is withdrawn, as at the end of a client's
  // time.
  for (const bus::JobId id : begun) host_.job_waits(id, core_.turn.now);
}

// Of a stop, what stands beside it ends with the gateway; the stop does not.
bool BatchQueue::ends_with_gateway(const Pending& pending) const {
  return closing_ && (!pending.command_sequence->is_stop() || pending.command_sequence->stop_is_over());
}

void BatchQueue::answer(const BatchResult& result, std::vector<Waiting> waiting) {
  if (!waiting.empty()) due_.push_back({result, std::move(waiting)});
}

void BatchQueue::call_back() {
  for (Due& due : std::exchange(due_, {}))
    for (const Waiting& client : due.callbacks) client.tell(due.result);
}

}  // namespace axisgate::drive
