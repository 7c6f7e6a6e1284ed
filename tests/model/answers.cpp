// SPDX-License-Identifier: Apache-2.0
// What an answer, or none, says of the readings: those that it contradicts are none any more.
#include <algorithm>
#include <cstdlib>
#include <utility>

#include "tests/model/contract.hpp"

namespace axisgate::test::reference {
namespace {

// 3.3 Outcomes: not started, nothing was sent, outcome unknown; 3.1, 43/13: an extended exception. 0x02: an object
// whose answers a bad line has taken three times is given up for a while, and what needs it is not there.
const std::set<int> kTrouble{2, 3, 4, 6, 10, 11, 0xFF};

}  // namespace

bool Contract::answered(int request, const std::set<int>& exceptions) {
  if (lost_count_) return true;
  const Asked asked = asked_.at(request);
  asked_.erase(request);
  constexpr int kNoAnswer = 0x0B;
  const bool done = exceptions.contains(0);
  // 3.4 Stops: "a stop is answered when the state shows it and the velocity falls or is 0".
  const auto stops = [&](const World& world) { return world.pending.at(request).verdict.stop; };
  if (exceptions == std::set{0} && asked.stops && !asked.obeyed && std::ranges::all_of(worlds_, stops)) return false;
  std::vector<World> fitting;
  for (const World& world : worlds_) {
    const Pending& pending = world.pending.at(request);
    const auto any = [&](const std::set<int>& of) {
      return std::ranges::any_of(exceptions, [&](int each) { return of.contains(each); });
    };
    const bool expected = pending.verdict.any_answer || any(pending.verdict.answers);
    const bool dropped = exceptions.contains(6) && pending.overtaken;
    const bool lost = asked.troubled && any(kTrouble);
    // 3.3 Outcomes: "not started within start_deadline_ms (500)": others may have kept the drive that long.
    constexpr std::int64_t kStartMs = 480;
    const bool late = exceptions.contains(6) && sight_.now_ms - asked.at_ms >= kStartMs && !pending.verdict.stop;
    // 3.3: "dropped by a stop": of a stop itself only what stands beside it. "Outcome unknown", 0x0B: both. Nothing was
    // sent, 0x0A: a stop is owed all the same (3.4 Owed stops).
    const bool not_done = pending.void_ || pending.alone;
    const bool unclear = pending.verdict.any_answer && !done;
    // 3.3 Not reached: what a drive has acknowledged and does not show is answered 0x04, and "before the answer the
    // gateway withdraws what might still happen ...; unconfirmed: an owed stop".
    const bool withdrawn = asked.troubled && pending.verdict.starts && !pending.void_ && exceptions.contains(4);
    const bool fits = withdrawn || (expected && (!pending.void_ || unclear)) || (late && not_done) ||
                      (dropped && (not_done || pending.more || !pending.verdict.stop)) ||
                      (lost && (not_done || exceptions.contains(kNoAnswer) || pending.verdict.stop));
    if (pending.unread ? !exceptions.contains(kNoAnswer) : !fits) continue;
    const std::optional<std::int64_t> is_at = pending.verdict.position;
    if (done && is_at && !asked.troubled && std::abs(sight_.position - *is_at) > kClose) continue;
    World next = world;
    next.pending.erase(request);
    if (next.awaits == request) {
      next.awaits = 0;
      next.changed_ms = sight_.now_ms;
    }
    // Whether it is remembered is not said. Of a posted write that a stop or a loss has met register 25 may tell of an
    // older one.
    const bool perhaps_done = done && (dropped || lost);
    if (!pending.unread && (!expected || (!done && pending.verdict.any_answer) || perhaps_done))
      next.clients[std::min(asked.client, kModbus)].make_uncertain();
    // 3.5, "renew": whether a request that waits for the drive renews when it comes or when it is answered is not said.
    if (asked.troubled && next.owner == asked.client && !next.orphan)
      next.lease_ends_by_ms = std::max(next.lease_ends_by_ms, sight_.now_ms + options_.lease_of(asked.client));
    if (done && pending.verdict.takes_over) {
      // 3.4, command 14: "after a halt": whatever its old owner has asked for meanwhile.
      const World before = next;
      if (!asked.troubled) next.motor = Motor::stands, next.jog = 0;
      changed(next, before);
      next.owner = asked.client;
      next.lease_until(sight_.now_ms + options_.lease_of(asked.client));
    }
    // An enable of which nobody knows: whether it is taken back once it shows is not said (ANS-6).
    constexpr std::int64_t kTakenBackMs = 6000;
    if (lost && pending.enables && exceptions.contains(kNoAnswer)) next.taken_back_by_ms = sight_.now_ms + kTakenBackMs;
    // Whoever asked is gone: whether that is withdrawn by a stop, also what was refused, is not said.
    if (exceptions.contains(kNoAnswer)) next.stale_speed = true;
    if (withdrawn && !expected) {
      const World before = next;
      next.motor = Motor::stands;
      next.jog = 0;
      next.stale_speed = next.latch_unsure = true;
      changed(next, before);
      World quick = next;  // 3.4 Owed stops: "An owed halt becomes quick_stop"
      quick.latched = true;
      quick.enabled = false;
      quick.ladder = 0;
      fitting.push_back(std::move(quick));
    }
    // An enable that was broken off between its steps.
    if (!done && pending.enables && next.enabled && sight_.enabled == false) {
      World off = next;
      off.enabled = false;
      off.motor = Motor::stands;
      off.ladder = 0;
      fitting.push_back(std::move(off));
    }
    fitting.push_back(std::move(next));
  }
  if (fitting.empty()) return false;
  worlds_ = std::move(fitting);
  keep_different();
  return true;
}

bool Contract::surely_acts(int request) const {
  return std::ranges::all_of(worlds_, [&](const World& world) {
    const auto pending = world.pending.find(request);
    return pending != world.pending.end() && pending->second.verdict.acts;
  });
}

void Contract::unanswered(int request) {
  if (lost_count_) return;
  asked_.erase(request);
  unanswered_ms_ = sight_.now_ms;
  for (World& world : worlds_) {
    world.pending.erase(request);
    if (world.awaits != request) continue;
    world.awaits = 0;
    world.changed_ms = sight_.now_ms;
  }
  keep_different();
}

}  // namespace axisgate::test::reference
