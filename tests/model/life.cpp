// SPDX-License-Identifier: Apache-2.0
// Leases, jog buttons, deaths and losses: what ends without being asked.
#include <algorithm>
#include <utility>

#include "tests/model/contract.hpp"
#include "tests/model/judge.hpp"

namespace axisgate::test::reference {
namespace {

constexpr std::int64_t kUnsureMs = 40;  // two clocks that read the same instant

/// A lease or a jog button has run out. Whether its stop counts as another client's (3.3 Edges) is not said.
void ended_by_nobody(World& world) {
  for (auto& [number, pending] : world.pending) pending.overtaken = true;  // 3.3: "dropped by a stop"
  for (ClientMemory& client : world.clients) {
    client.command.ended = client.controlword.ended = true;
    client.command.unsure = client.controlword.unsure = true;
    for (Item& coil : client.coils) coil.ended = coil.unsure = true;
  }
}

}  // namespace

// 3.5: "renew": any request; 3.5 Signs of life: an orphan lease is taken over by "a write to this axis ... of the same
// address and role, on a connection opened after the owner's last request".
void Contract::take_over(World& world, std::size_t client, Readings& readings) const {
  world.retaken = world.owner && world.orphan && options_.address_of(*world.owner) == options_.address_of(client);
  if (world.retaken && !is_dds(client) && !options_.by_address) {
    constexpr std::int64_t kSameInstantMs = 1;
    const std::int64_t later_ms = opened_ms_[client] - world.orphan_asked_ms;
    world.retaken = later_ms > kSameInstantMs || (later_ms >= -kSameInstantMs && readings.other());
  }
  if (world.retaken) world.owner = client;
  if (world.owner != client) return;
  // Of a write that is refused nobody can tell whether it has taken it over.
  if (std::exchange(world.orphan, false))
    world.lease_ends_by_ms = sight_.now_ms + options_.lease_of(client);
  else
    renew(world, client);
}

// 3.5 Signs of life: "While an axis is disabled only requests that ask for something renew its lease": of those that
// are refused, or that repeat, nobody can tell.
void Contract::renew(World& world, std::size_t client) const {
  const std::int64_t ends_ms = sight_.now_ms + options_.lease_of(client);
  if (world.enabled && !world.retake_unsure) return world.lease_until(ends_ms);
  world.lease_ends_by_ms = ends_ms;
  // Whether a sign of life that does not renew ends what it was prolonged by is not said.
  if (is_dds(client) && graced_.at(client - kModbus))
    world.lease_ends_ms = std::min(world.lease_ends_ms, sight_.now_ms);
}

void Contract::heard(std::size_t client) {
  if (is_dds(client)) graced_.at(client - kModbus) = false;
}

// Design 4: "when axisgate-dds dies its clients' leases are prolonged once by 3 s": from when they were heard last, and
// what it finds when it is back was not heard of.
void Contract::dds_died() {
  for (World& world : worlds_) {
    if (!world.owner || *world.owner >= kClients || !is_dds(*world.owner) || world.orphan) continue;
    if (graced_.at(*world.owner - kModbus)) continue;
    world.lease_ends_by_ms += kGraceMs;
    // Where a sign of life need not renew, whether it ends this is not said.
    if (world.enabled && !options_.only_writes_renew) world.lease_ends_ms += kGraceMs;
  }
  graced_.fill(true);
}

// 3.5: "renew": any request of the owner; 3.5 Signs of life: "While an axis is disabled only requests that ask for
// something".
void Contract::asked(std::size_t client) {
  if (!is_dds(client)) asked_ms_[client] = sight_.now_ms;
  // 3.5 Signs of life: "With "client": "address" only writes renew"; 3.5, "renew": "a write to this axis".
  if ((options_.by_address && !is_dds(client)) || options_.only_writes_renew) return heard(client);
  for (World& world : worlds_)
    if (world.owner == client && !world.orphan) renew(world, client);
  heard(client);
}

void Contract::beats(std::size_t client, std::int64_t lease_ms) {
  options_.limits.at(client - kModbus) = lease_ms;
  for (World& world : worlds_)
    if (world.owner == client && !world.enabled) world.lease_ends_ms = std::min(world.lease_ends_ms, sight_.now_ms);
  asked(client);
}

// 3.5: on_expiry "acts only if the axis is enabled"; 3.4: "quick_stop and a lease's action set" the latch.
void Contract::expire(World& world) const {
  const World before = world;
  world.owner.reset();
  world.orphan = world.found = false;
  world.lease_until(kNever);
  // Whether a loss has closed the gate of an axis whose state is the gateway's own is not known until it is read.
  world.latch_unsure = trouble_ || world.adopted || (world.latch_unsure && !world.enabled);
  if (!world.enabled || !options_.expiry_acts) return;
  world.motor = Motor::stands;
  world.jog = 0;
  world.mode.reset();
  world.latched = true;
  world.enabled = false;
  world.off_asked_ms = sight_.now_ms;
  world.ladder = 0;
  world.stale_speed = true;
  ended_by_nobody(world);
  changed(world, before);
  world.changed_ms = sight_.now_ms;
}

/// Leases that may have run out by now, or not.
void Contract::add_expired() {
  std::vector<World> more;
  for (const World& world : worlds_) {
    if (!world.lease_unsure) continue;
    more.push_back(world);
    expire(more.back());
  }
  worlds_.insert(worlds_.end(), more.begin(), more.end());
  keep_different();
}

void Contract::pass_time(std::int64_t now_ms) {
  std::vector<World> more;
  for (World& world : worlds_) {
    if (world.jog != 0 && now_ms >= world.jog_ends_ms) {
      const World before = world;
      world.motor = Motor::stands;
      world.jog = 0;
      world.mode.reset();
      world.stale_speed = true;
      ended_by_nobody(world);
      changed(world, before);
    }
    if (world.lease_ends_ms == kNever) continue;
    if (now_ms >= world.lease_ends_by_ms + kUnsureMs) {
      expire(world);
    } else if (now_ms >= world.lease_ends_ms - kUnsureMs) {
      world.lease_unsure = true;
      more.push_back(world);
      expire(more.back());
    }
  }
  if (more.empty()) return;
  worlds_.insert(worlds_.end(), more.begin(), more.end());
  keep_different();
}

// SECURITY.md: with "lease": null a drive without a watchdog of its own is stopped when its client's connection ends.
void Contract::may_have_stopped_for_good() {
  if (options_.leases || !options_.by_gateway) return;
  const std::vector<World> now = worlds_;
  for (const World& world : now) {
    worlds_.push_back(world);
    expire(worlds_.back());
    // 3.4 Stops: "accepted in every state": one that is being disabled still turns, and is latched by it.
    // And a start may be on its way.
    worlds_.back().latched =
        worlds_.back().latched || !world.pending.empty() || sight_.now_ms - world.off_asked_ms < options_.settles_ms;
  }
}

void Contract::left(std::size_t client, bool silently) {
  if (!silently || is_dds(client)) may_have_stopped_for_good();
  if (!is_dds(client)) opened_ms_[client] = sight_.now_ms;
  if (is_dds(client)) {
    options_.limits.at(client - kModbus) = kNever;
    said_.at(client - kModbus) = {};
    heard(client);
  }
  for (World& world : worlds_) {
    if (options_.by_address && !is_dds(client)) {
      world.clients[client].half.reset();  // 3.1 Panels: "same connection"
      world.orphan = world.orphan || (world.owner == client && !silently);
      continue;  // 3.3 Edges: "until 60 s after its last connection"
    }
    if (world.owner == client && silently && !world.orphan) world.owner = kGhost + client;
    if (world.owner == client && !world.orphan) {
      world.orphan = true;
      if (!is_dds(client)) world.orphan_asked_ms = asked_ms_[client];
    }
    // 3.4 Jog: a new connection has no button of an old one's.
    if (world.jog != 0 && world.jog_client == client) world.jog_client = kGhost + client;
    if (is_dds(client)) {
      world.pressed.at(client - kModbus) = 0;
      continue;
    }
    ClientMemory next;
    next.id = world.clients[client].id;  // 3.3 Edges: "kept 60 s after its last connection"
    next.ids = world.clients[client].ids;
    world.clients[client] = next;
  }
}

void Contract::trouble_begins() {
  trouble_ = true;
  for (auto& [number, asked] : asked_) asked.troubled = true;
  for (World& world : worlds_) {
    world.mode.reset();
    world.stale_speed = true;
    world.accepted.erase(row::homing_method);  // 3.4, command 10: "since bring-up"
    world.broken = world.motor != Motor::stands ||
                   std::ranges::any_of(world.earlier, [](const Motion& m) { return m.kind != Motor::stands; });
    // 3.3 Edges: "a fault, a link loss": a level or a command held since asks for nothing; what counts as one is not
    // said.
    for (ClientMemory& client : world.clients) {
      client.command.unsure = client.controlword.unsure = true;
      for (Item& coil : client.coils) coil.unsure = true;
    }
  }
}

// 3.5: "An axis found enabled at bring-up with a lease configured gets an orphan lease open to every operator ...,
// otherwise on_expiry is carried out". When it was found nobody outside knows.
void Contract::trouble_ends() {
  trouble_ = false;
  std::vector<World> more;
  for (World& world : worlds_) {
    world.changed_ms = sight_.now_ms;
    world.mode.reset();
    world.stale_speed = true;
    world.latch_unsure = true;  // whether what ended out of sight was enabled then the gateway has not seen
    // Of an axis whose state is the gateway's own nobody knows what it has made of a loss.
    world.adopted = options_.by_gateway && world.enabled;
    // "Done" may have been said of a drive that had lost its power meanwhile, and nobody knew (3.4, command 1: "Already
    // enabled: nothing is sent").
    if (sight_.enabled == false && world.pending.empty() && world.enabled) {
      world.enabled = false;
      world.motor = Motor::stands;
      world.jog = world.ladder = 0;
    }
    // Whether a 6 or 7 of before the loss is a step out of the latch still (3.4) is not said.
    if (world.latched && world.ladder != 0) {
      more.push_back(world);
      more.back().ladder = 0;
    }
    if (!options_.leases || !world.enabled || world.owner) continue;
    // One that another master has enabled was not found so.
    if (was_anothers_) more.push_back(world);
    world.found = true;  // 3.5 Signs of life: "an adopted axis [is taken over] by any write but an all-zero block"
    if (gateway_is_new_ || world.lease_ends_ms == kNever) world.lease_until(sight_.now_ms + options_.lease_ms);
    world.lease_unsure = true;
    more.push_back(world);
    expire(more.back());
  }
  gateway_is_new_ = was_anothers_ = false;
  worlds_.insert(worlds_.end(), more.begin(), more.end());
  keep_different();
}

void Contract::drive_restarted() {
  for (World& world : worlds_) {
    const World before = world;
    world.motor = Motor::stands;
    world.jog = 0;
    world.stale_speed = true;
    world.enabled = world.faulted = false;
    world.ladder = 0;
    world.other_mode = true;  // which one it begins with is its own affair
    changed(world, before);
  }
}

// What another master commands the contract does not say; that stops, leases and buttons act, it does.
void Contract::commanded_by_another() {
  constexpr std::int64_t kObeysMs = 40;
  for (World& world : worlds_) {
    const World before = world;
    world.motor = Motor::unknown;
    world.broken = world.other_mode = true;
    world.ladder = 0;
    changed(world, before);
  }
  was_anothers_ = true;
  anothers_until_ms_ = sight_.now_ms + kObeysMs;
}

void Contract::drive_tripped() {
  drive_restarted();
  for (World& world : worlds_) world.faulted = world.stale_speed = true;
}

// A gateway that has died commands nothing; a motor goes on until its drive misses the master.
void Contract::gateway_died() {
  trouble_begins();
  may_have_stopped_for_good();
  options_.limits.fill(kNever);
  said_ = {};
  graced_ = {};
  // What it still owed dies with it.
  std::vector<World> owed;
  for (const World& world : worlds_) {
    const bool turns = world.motor == Motor::stands && sight_.velocity != 0;
    if (!turns && (world.enabled || sight_.enabled != true)) continue;
    owed.push_back(world);
    owed.back().enabled = sight_.enabled.value_or(true);
    if (turns) owed.back().motor = Motor::unknown;
  }
  worlds_.insert(worlds_.end(), owed.begin(), owed.end());
  for (World& world : worlds_) {
    world.clients = {};
    world.pressed = {};
    world.owner.reset();
    world.orphan = false;
    world.lease_until(kNever);
    world.raw_mode.reset();
    world.held = false;
    world.accepted.clear();
    if (world.jog != 0) world.motor = Motor::unknown;  // nobody ends it now
    world.jog = 0;
  }
}

// The latch was the gateway's.
void Contract::gateway_started() {
  gateway_is_new_ = true;
  opened_ms_.fill(sight_.now_ms);
  std::vector<World> worlds;
  for (World& world : worlds_) {
    world.found = options_.leases;
    if (world.latched) {
      World other = world;
      other.latched = false;
      worlds.push_back(std::move(other));
    }
    worlds.push_back(world);
  }
  worlds_ = std::move(worlds);
  keep_different();
}

}  // namespace axisgate::test::reference
