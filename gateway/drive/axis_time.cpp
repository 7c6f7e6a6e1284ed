// What becomes due on an axis: the answers of groups that take too long, a lease, a jog; and whoever is to be told.
#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "gateway/drive/axis.hpp"

namespace axisgate::drive {

// The latest start is the bus's to judge; who joined with an earlier one must not have it stretched.
Instant Axis::deadline_of(const Pending& pending, const Waiting& client) {
  const bool may_expire = client.start_by < pending.start_by && !pending.conversation->begun();
  return may_expire ? std::min(client.start_by, client.answer_by) : client.answer_by;
}

void Axis::on_time(Instant now) {
  std::vector<bus::OrderId> late;
  const auto is_late = [now](const Pending& p) {
    return [now, &p](const Waiting& client) { return now >= deadline_of(p, client); };
  };
  for (const Pending& p : pending_)
    if (std::any_of(p.callbacks.begin(), p.callbacks.end(), is_late(p))) late.push_back(p.id);
  for (const bus::OrderId id : late) {
    Pending* pending = find(id);
    Conversation& conversation = *pending->conversation;
    auto& clients = pending->callbacks;
    const auto first = std::stable_partition(clients.begin(), clients.end(), std::not_fn(is_late(*pending)));
    if (first != clients.begin()) {
      // Others still wait for it.
      const bool sent = conversation.begun() || conversation.is_stop();
      Due& due = due_.emplace_back();
      due.result.outcome = {sent ? Errc::timed_out : Errc::never_started, 0};
      due.callbacks.assign(std::make_move_iterator(first), std::make_move_iterator(clients.end()));
      clients.erase(first, clients.end());
      continue;
    }
    if (conversation.is_stop() && !conversation.stop_is_over()) {
      // Its client has its answer; the stop goes on until it shows, or was repeated as often as it may.
      Due& due = due_.emplace_back();
      due.result.outcome = {Errc::timed_out, 0};
      due.callbacks = std::exchange(pending->callbacks, {});
      continue;
    }
    conversation.abort({conversation.begun() ? Errc::timed_out : Errc::never_started, 0});
    complete(id, conversation.result());
  }
  core_.now = now;
  core_.link = host_.link_state();
  end_expired_lease();
  if (jog_.expired(now)) halt_jog("its coil was not written 1 again in time");
}

Instant Axis::next_deadline() const {
  Instant next = std::min({core_.motion.deadline(), core_.fault.deadline(), ownership_.until(), jog_.until(),
                           owed_.next_deadline(core_.now)});
  for (const Pending& p : pending_)
    for (const Waiting& client : p.callbacks) next = std::min(next, deadline_of(p, client));
  for (const Due& d : due_)
    for (const Waiting& client : d.callbacks) next = std::min(next, client.answer_by);
  return next;
}

// A reply waits for the image to show the statusword that it is about: a fault is shown when its cause is known.
void Axis::call_back() {
  std::vector<Due> due;
  due.swap(due_);
  const auto waits = [this](const Due& d) {
    return core_.fault.withheld() && std::none_of(d.callbacks.begin(), d.callbacks.end(),
                                                  [this](const Waiting& c) { return core_.now >= c.answer_by; });
  };
  const auto waiting = std::stable_partition(due.begin(), due.end(), std::not_fn(waits));
  due_.assign(std::make_move_iterator(waiting), std::make_move_iterator(due.end()));
  due.erase(waiting, due.end());
  for (Due& d : due)
    for (const Waiting& client : d.callbacks) client.tell(d.result);
}

}  // namespace axisgate::drive
