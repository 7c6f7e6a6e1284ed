// SPDX-License-Identifier: Apache-2.0
#include "tests/model/contract.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "tests/model/judge.hpp"

namespace axisgate::test::reference {
namespace {

void make_uncertain(Item& item) {
  item.unsure = true;
  item.acted = item.spoilt = false;
  item.refused = true;
}

/// Too many readings of what was remembered: from now on of each thing that acts by edges both are allowed until it is
/// written with another value. What the motor does and who owns the axis stays apart.
void blur(World& world, const World& first) {
  for (std::size_t c = 0; c < world.clients.size(); ++c) {
    ClientMemory& client = world.clients[c];
    client.rows = first.clients[c].rows;
    client.rows_unsure = true;
    client.make_uncertain();
    const auto any = [](Item& item) { item.ended = item.changed = true; };
    any(client.command);
    any(client.controlword);
    for (Item& coil : client.coils) any(coil);
  }
}

/// Of two worlds that differ in nothing but when something happened: what is under way is as new, and leases are as
/// unsure, as in either.
void add_times(World& world, const World& other) {
  world.lease_ends_ms = std::min(world.lease_ends_ms, other.lease_ends_ms);
  world.lease_ends_by_ms = std::max(world.lease_ends_by_ms, other.lease_ends_by_ms);
  world.lease_unsure = world.lease_unsure || other.lease_unsure;
  world.broken = world.broken || other.broken;
  world.fastest = std::max(world.fastest, other.fastest);
  for (const auto at : {&World::started_ms, &World::changed_ms, &World::enable_asked_ms, &World::off_asked_ms,
                        &World::taken_back_by_ms})
    world.*at = std::max(world.*at, other.*at);
  for (const Motion& motion : other.earlier)
    if (std::ranges::find(world.earlier, motion) == world.earlier.end()) world.earlier.push_back(motion);
}

World without_times(World world) {
  const std::int64_t none = 0;
  for (const auto at : {&World::started_ms, &World::changed_ms, &World::enable_asked_ms, &World::off_asked_ms,
                        &World::taken_back_by_ms, &World::lease_ends_ms, &World::lease_ends_by_ms, &World::stopped_at})
    world.*at = none;
  world.lease_unsure = world.broken = false;
  world.fastest = kNever;
  world.earlier.clear();
  return world;
}

template <class Call>
std::string each_once(const std::vector<World>& worlds, Call&& call) {
  std::set<std::string> lines;
  for (const World& world : worlds) lines.insert(call(world));
  std::string out;
  for (const std::string& line : lines) out += (out.empty() ? "" : " | ") + line;
  return out;
}

}  // namespace

void ClientMemory::make_uncertain() {
  reference::make_uncertain(command);
  reference::make_uncertain(controlword);
  for (Item& coil : coils) reference::make_uncertain(coil);
}

Motion World::motion() const {
  const auto of = [&](std::uint16_t offset) { return accepted.contains(offset) ? accepted.at(offset) : 0; };
  if (motor == Motor::moves) return {motor, target};
  const std::uint16_t speed = jog != 0 ? row::jog_velocity : row::target_velocity;
  if (motor == Motor::runs && !accepted.contains(speed)) return {Motor::unknown, 0};
  if (motor == Motor::runs) return {motor, jog != 0 ? jog * of(speed) : of(speed)};
  return {motor, 0};
}

bool World::arrived(const Seen& seen) const {
  return motor == Motor::moves && seen.stands && seen.clear && std::abs(target - seen.position) <= kClose;
}

std::string text(const World& world) {
  std::string out = world.faulted   ? "faulted, "
                    : world.latched ? "latched, "
                    : world.enabled ? "enabled, "
                                    : "disabled, ";
  const Motion motion = world.motion();
  if (motion.kind == Motor::stands) out += "stands";
  if (motion.kind == Motor::moves) out += "moves to " + std::to_string(motion.value);
  if (motion.kind == Motor::runs) out += (world.jog != 0 ? "jogs at " : "runs at ") + std::to_string(motion.value);
  if (motion.kind == Motor::unknown) out += "nobody can tell";
  if (world.broken && motion.kind != Motor::stands) out += ", or was broken off";
  if (world.mode) out += ", in mode " + std::to_string(*world.mode);
  if (world.owner)
    out += std::string(", owned by ") + (*world.owner == 0       ? "a"
                                         : *world.owner == 1     ? "b"
                                         : *world.owner == 2     ? "c"
                                         : *world.owner < kGhost ? "dds " + std::to_string(*world.owner - kModbus + 1)
                                                                 : "one who is gone");
  return out;
}

Seen Contract::seen() const {
  return {sight_.now_ms, sight_.position, sight_.velocity == 0, sight_.now_ms - since_ms_ >= kClearMs, trouble_};
}

void Contract::changed(World& world, const World& was) const {
  const Motion before = was.arrived(seen()) ? Motion{} : was.motion();
  if (world.motion() == before && world.earlier.empty()) return;
  if (std::ranges::find(world.earlier, before) == world.earlier.end()) world.earlier.push_back(before);
  world.changed_ms = sight_.now_ms;
  world.broken = world.broken && world.motor != Motor::stands && before.kind == world.motor;
}

// 3.3: "superseded before it was sent · dropped by a stop": 0x06. So what waits may be told when another comes, and
// what comes while a stop waits.
void Contract::overtake(World& world, Pending& newest, bool rows) {
  for (auto& [number, pending] : world.pending) {
    if (newest.verdict.stop || (pending.setpoints && rows)) pending.overtaken = true;
    if (pending.verdict.stop) newest.overtaken = true;
  }
}

/// 3.4 Owed stops: a stop "is owed all the same"; what stands beside it was not carried out.
World Contract::owed_alone(World stopped, const World& none) {
  stopped.accepted = none.accepted;
  stopped.owner = none.owner;
  stopped.orphan = none.orphan;
  stopped.lease_ends_ms = none.lease_ends_ms;
  stopped.lease_ends_by_ms = none.lease_ends_by_ms;
  stopped.lease_unsure = none.lease_unsure;
  return stopped;
}

// Design 4: "request ids seen in the last 10 s"; 3.4 Stops: "One acts if the command or the id differs from what is
// remembered": that is what its writer has asked of the axis last.
SeenBefore Contract::seen_before(std::size_t client, const Write& write) {
  constexpr std::int64_t kKeptMs = 10'000, kUnsureMs = 20;
  if (!is_dds(client)) return SeenBefore::no;
  AllSaid& said = said_.at(client - kModbus);
  const std::int64_t command = write.sample.contains(row::command) ? write.sample.at(row::command) : 0;
  if (write.flaw != Flaw::none) {
    if (lets_go(command)) said.last = SIZE_MAX;
    return SeenBefore::no;
  }
  if (write.repeats == 0) {
    said.last = said.all.size();
    said.all.push_back({command, sight_.now_ms});
    return SeenBefore::no;
  }
  const std::size_t which = said.all.size() - write.repeats;
  const std::int64_t age_ms = sight_.now_ms - std::exchange(said.all.at(which).at_ms, sight_.now_ms);
  const bool newest = std::exchange(said.last, which) == which;
  if ((is_stop(command) || command == kJogEnd) && !newest) return SeenBefore::no;
  return age_ms < kKeptMs - kUnsureMs   ? SeenBefore::yes
         : age_ms > kKeptMs + kUnsureMs ? SeenBefore::no
                                        : SeenBefore::perhaps;
}

int Contract::send(std::size_t client, const Write& write) {
  const int number = ++requests_;
  if (lost_count_) return number;
  const SeenBefore seen_before = this->seen_before(client, write);
  asked_[number] = {client, trouble_, sight_.now_ms, asserts_stop(write)};
  asked_[number].see(sight_);
  if (!is_dds(client)) asked_ms_[client] = sight_.now_ms;
  std::vector<World> worlds;
  std::set<std::string> said;
  add_expired();
  for (const World& world : worlds_) {
    Readings readings;
    if (worlds.size() > kMostBranches) lost_count_ = true;
    if (lost_count_) break;
    do {
      World next = world;
      const Seen seen = this->seen();
      // Design 4, age: "stale samples and heartbeats renew nothing"; nor does what may be for another gateway.
      if (write.flaw == Flaw::none) take_over(next, client, readings);
      Judge judge(options_, next, readings, seen, client);
      judge.seen_before(seen_before);
      Pending pending;
      pending.verdict = judge.write(write);
      // 3.5, "renew": whether "a write to this axis" that is refused is one is not said; nor whether half of a row is.
      const bool done = pending.verdict.answers.contains(0) && !next.clients[std::min(client, kModbus)].half;
      const bool by_writes = options_.only_writes_renew || (options_.by_address && !is_dds(client));
      if (by_writes && next.owner == world.owner && !done)
        next.lease_ends_ms = std::min(next.lease_ends_ms, world.lease_ends_ms);
      // Of one that is refused, or half of a row, nobody can tell whether it has taken an orphan lease over.
      if (next.retaken && next.owner == client && !done) {
        next.retake_unsure = true;
        next.lease_ends_ms = world.lease_ends_ms;
        next.orphan = readings.other();
        if (next.orphan) next.owner = world.owner;
      }
      pending.verdict.stop = judge.stopped();
      pending.verdict.takes_over = judge.takes_over();
      pending.verdict.any_answer = pending.verdict.any_answer || judge.unclear();
      // 3.5 Signs of life: "an adopted axis [is taken over] by any write but an all-zero block", a stop too, perhaps
      // (3.4).
      if (next.owner) next.found = false;
      if (next.found && readings.other()) {
        next.owner = client;
        next.lease_until(sight_.now_ms + options_.lease_of(client));
      }
      // What else is written to another motion may change what it goes by.
      if (!pending.verdict.starts && (next.motor != Motor::moves || world.motor != Motor::moves)) next.fastest = kNever;
      said.insert(std::exchange(pending.verdict.says, {}));
      const Rows rows = write.coils() ? Rows{} : rows_of(write);
      pending.more = rows.size() > 1;
      const bool sets = !rows.empty() || half_row(write);
      pending.setpoints = sets && !pending.verdict.acts;
      pending.enables = next.enable_asked_ms != world.enable_asked_ms;
      overtake(next, pending, sets);
      next.pending[number] = pending;
      changed(next, world);
      if ((world.enabled && !next.enabled) || (next.latched && !world.latched)) next.off_asked_ms = sight_.now_ms;
      if (next.motion() != world.motion() || next.enabled != world.enabled || next.latched != world.latched ||
          pending.verdict.starts)
        next.awaits = number;
      // The same in a world where it never came to be: only trouble can be the cause, and the answer tells. A stop is
      // owed all the same (3.4 Owed stops).
      World none = world;
      none.clients = next.clients;
      none.pressed = next.pressed;
      if (none.owner == next.owner) none.lease_ends_by_ms = std::max(none.lease_ends_by_ms, next.lease_ends_by_ms);
      if (trouble_ && pending.verdict.stop) none = owed_alone(next, none);
      overtake(none, pending, sets);
      pending.void_ = true;
      pending.enables = false;
      none.pending[number] = pending;
      const bool differs = !(none.motion() == next.motion()) || none.accepted != next.accepted ||
                           none.enabled != next.enabled || none.latched != next.latched ||
                           none.faulted != next.faulted || none.owner != next.owner;
      // Of function 23 the read is judged first, and where that is answered 0x0B nothing is written (ANS-11).
      if (options_.reads_fail && write.function == fc::read_write && trouble_ && !pending.verdict.stop) {
        worlds.push_back(world);
        (worlds.back().pending[number] = pending).unread = true;
      }
      worlds.push_back(std::move(next));
      if (!differs) continue;
      worlds.back().pending[number].alone = false;
      worlds.push_back(none);
      // Whether what was not carried out has claimed the axis is not said.
      if (none.owner == worlds[worlds.size() - 2].owner) continue;
      none.owner = worlds[worlds.size() - 2].owner;
      none.lease_until(worlds[worlds.size() - 2].lease_ends_ms);
      worlds.push_back(std::move(none));
    } while (readings.advance());
  }
  if (lost_count_) return number;
  worlds_ = std::move(worlds);
  if (is_dds(client) && write.flaw == Flaw::none) {
    // Whether a write ends a grace before it renews, or after, is not said.
    for (World& world : worlds_)
      if (options_.only_writes_renew && graced_.at(client - kModbus) && world.owner == client)
        world.lease_ends_by_ms += kGraceMs;
    heard(client);
  }
  keep_different();
  predicted_.clear();
  for (const std::string& one : said) predicted_ += (predicted_.empty() ? "" : " | ") + one;
  return number;
}

void Contract::drop_equal() {
  if (worlds_.size() < 2) return;  // and most of the time there is one
  std::vector<World> different, timeless;
  for (World& world : worlds_) {
    World key = without_times(world);
    const auto found = std::ranges::find(timeless, key);
    if (found == timeless.end()) {
      different.push_back(std::move(world));
      timeless.push_back(std::move(key));
    } else {
      add_times(different[static_cast<std::size_t>(found - timeless.begin())], world);
    }
  }
  worlds_ = std::move(different);
}

void Contract::keep_different() {
  if (worlds_.size() > kMaxWorlds)
    for (World& world : worlds_) blur(world, worlds_.front());
  drop_equal();
  lost_count_ = lost_count_ || worlds_.size() > kMaxWorlds;
  if (lost_count_) worlds_.resize(1);
}

std::string Contract::expected() const {
  return each_once(worlds_, [](const World& world) { return text(world); });
}

}  // namespace axisgate::test::reference
