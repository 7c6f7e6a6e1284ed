// SPDX-License-Identifier: Apache-2.0
// What becomes due on an axis: the answers of write batches that take too long, a lease, a jog; and whoever is to be
// told.
#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "gateway/drive/axis/axis.hpp"

namespace axisgate::drive {

// The latest start is the bus's to judge; who joined with an earlier one must not have it stretched.
Instant Axis::deadline_of(const Pending& pending, const Waiting& client) {
  const bool may_expire = client.start_by < pending.start_by && !pending.command_sequence->begun();
  return may_expire ? std::min(client.start_by, client.answer_by) : client.answer_by;
}

void Axis::on_time() {
  const Instant now = core_.turn.now;
  std::vector<bus::JobId> late;
  const auto is_late = [now](const Pending& p) {
    return [now, &p](const Waiting& client) { return now >= deadline_of(p, client); };
  };
  for (const Pending& p : pending_)
    if (std::any_of(p.callbacks.begin(), p.callbacks.end(), is_late(p))) late.push_back(p.id);
  for (const bus::JobId id : late) {
    Pending* pending = pending_.find(id);
    if (pending == nullptr) continue;  // what was withdrawn for another has dropped it
    CommandSequence& command_sequence = *pending->command_sequence;
    auto& clients = pending->callbacks;
    const auto first = std::stable_partition(clients.begin(), clients.end(), std::not_fn(is_late(*pending)));
    if (first != clients.begin()) {
      // Others still wait for it.
      Due& due = due_.emplace_back();
      due.result.outcome = command_sequence.outcome_if_late();
      due.callbacks.assign(std::make_move_iterator(first), std::make_move_iterator(clients.end()));
      clients.erase(first, clients.end());
      continue;
    }
    if (command_sequence.is_stop() && !command_sequence.stop_is_over()) {
      // Its client has its answer; the stop goes on until it shows, or was repeated as often as it may.
      Due& due = due_.emplace_back();
      due.result.outcome = command_sequence.outcome_if_late();
      due.callbacks = std::exchange(pending->callbacks, {});
      if (due.result.outcome.code == Errc::not_reached) tell_not_reached(*pending);
      tell_ended(*pending, due.result.outcome);
      continue;
    }
    command_sequence.expire();
    complete(id, command_sequence.result());
  }
  end_expired_lease();
  if (jog_.expired(now)) halt_jog("its coil was not written 1 again in time");
  end_jog_at_limit();
}

Instant Axis::next_deadline() const {
  Instant next = std::min({core_.motion.deadline(), core_.fault.deadline(), ownership_.until(), jog_.until(),
                           jog_limit_due(), owed_.next_deadline(core_.turn.now)});
  for (const Pending& p : pending_)
    for (const Waiting& client : p.callbacks) next = std::min(next, deadline_of(p, client));
  return next;
}

// --- What did not come in time -------------------------------------------------------------------------------------

// What might still happen is withdrawn before the answer, and the answer is not late for it.
Instant Axis::decide_by(const WriteBatch& batch) const {
  const Instant now = core_.turn.now;
  constexpr Duration kWithdrawing = std::chrono::milliseconds(100);
  const bool withdrawable = batch.command == Command::enable || batch.mode || needs_ready(batch.command);
  if (!withdrawable || batch.answer_by == kNever || batch.answer_by <= now) return batch.answer_by;
  return batch.answer_by - std::min(kWithdrawing, (batch.answer_by - now) / 4);
}

void Axis::tell_not_reached(const Pending& pending) {
  const WriteBatch& batch = pending.command_sequence->batch();
  const std::string who = batch.life ? batch.life->name + ": " : std::string();
  const std::string what = batch.command == Command::none ? "a write" : std::string(text(batch.command));
  host_.event(image_.number, EventKind::command, static_cast<std::uint32_t>(batch.command),
              who + what + " was not reached: " + pending.command_sequence->missed());
}

// In its client's name: it has ended nothing of its own. Not confirmed, the stop is owed.
void Axis::withdraw(const WriteBatch& asked, Command stop, const BatchResult& answer, std::vector<Waiting> waiting) {
  constexpr Duration kMostWaits = std::chrono::seconds(1);  // of a request without a time of its own
  WriteBatch batch;
  batch.client = asked.client;
  batch.role = Role::engineer;
  batch.command = stop;
  batch.answer_by = std::min(asked.answer_by, core_.turn.now + kMostWaits);
  host_.event(image_.number, EventKind::command, static_cast<std::uint32_t>(stop),
              std::string(text(asked.command)) + " is withdrawn: " + std::string(text(stop)));
  accept_stop(batch);
  // Where nobody answers a frame, the read that shows it disabled does not tell that the withdrawal has arrived.
  if (stop == Command::disable) late_enable_.withdrawn(core_.turn.now);
  Pending pending;
  pending.by_mailbox = true;  // the client's result is that of what it asked for
  pending.command_sequence = std::make_unique<CommandSequence>(core_, batch, true);
  bus::BusJob job = job_for(core_, batch, true);
  job.axis = slot_;
  const AxisHost::Queued queued = host_.queue(std::move(job));
  if (queued.code != Errc::ok) {
    due_.push_back({answer, std::move(waiting)});
    return;
  }
  pending.id = queued.id;
  BatchCallback tell = [answer, waiting = std::move(waiting)](const BatchResult&) {
    for (const Waiting& client : waiting) client.tell(answer);
  };
  pending.callbacks.push_back({std::move(tell), kNever, batch.answer_by});
  pending_.push_back(std::move(pending));
}

void Axis::call_back() {
  for (Due& due : std::exchange(due_, {}))
    for (const Waiting& client : due.callbacks) client.tell(due.result);
}

}  // namespace axisgate::drive
