// SPDX-License-Identifier: Apache-2.0
// Whether a world's motor may do what is seen.
#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "tests/model/contract.hpp"
#include "tests/model/judge.hpp"

namespace axisgate::test::reference {
namespace {

constexpr std::int64_t kEnableMs = 2000;  // from an accepted enable to the torque, at most

bool moved_before(const World& world) {
  return std::ranges::any_of(world.earlier, [](const Motion& m) { return m.kind != Motor::stands; });
}

int way(const Sight& sight) { return sight.velocity == 0 ? 0 : sight.velocity > 0 ? 1 : -1; }

/// Creeping by a count is no motion: rounding.
constexpr std::int64_t kCreep = 10'000;

/// By so much a drive may turn faster or slower than it was told.
std::int64_t off(std::int64_t speed) {
  constexpr std::int64_t kSpeedShare = 50;  // one part in so many
  constexpr std::int64_t kSlowest = 1'500;  // a drive that counts whole rpm
  return std::max(speed / kSpeedShare, kSlowest);
}

/// Whether a motor that begins to turn as it is seen does so for this motion.
bool leads_there(const Motion& motion, const Sight& sight) {
  const std::int64_t way = motion.kind == Motor::moves ? motion.value - sight.position : motion.value;
  if (motion.kind == Motor::stands) return false;
  if (motion.kind == Motor::unknown || (motion.kind == Motor::moves && std::abs(way) <= kClose)) return true;
  return way != 0 && (way > 0) == (sight.velocity > 0);
}

}  // namespace

bool Contract::settled(const World& world) const {
  return !trouble_ && world.awaits == 0 && sight_.now_ms - world.changed_ms >= options_.settles_ms;
}

bool Contract::settled() const {
  return std::ranges::all_of(worlds_, [this](const World& w) { return settled(w); });
}

// P: "No drive is ever enabled but by an explicit command" (section 7, point 7).
bool Contract::enabling_fits(World& world, const Sight& sight) const {
  if (!sight.enabled || !was_enabled_) return true;
  if (sight.now_ms <= anothers_until_ms_) {
    world.enabled = *sight.enabled;
    return true;
  }
  if (*sight.enabled && !*was_enabled_)
    return world.enabled || sight.now_ms - world.enable_asked_ms <= kEnableMs || !world.pending.empty();
  if (!*sight.enabled && *was_enabled_ && world.enabled && !world.latched) {
    const bool enabling = std::ranges::any_of(world.pending, [](const auto& p) { return p.second.enables; });
    if (sight.now_ms - world.off_asked_ms <= options_.settles_ms && (!trouble_ || enabling)) return true;
    if (!trouble_ && !world.broken && !world.faulted && sight.now_ms > world.taken_back_by_ms) return false;
    const World before = world;
    world.enabled = false;
    world.motor = Motor::stands;
    world.jog = 0;
    world.ladder = 0;
    changed(world, before);
  }
  // "Done" (3.4, command 1) was not said of what is not.
  if (!*sight.enabled && world.enabled && !world.latched && !world.broken && !world.faulted && settled(world) &&
      sight.now_ms > world.taken_back_by_ms)
    return false;
  // Disabled long ago, by a command: torque is off.
  if (*sight.enabled && !world.enabled && !world.latched && !world.broken && settled(world)) return false;
  return true;
}

bool Contract::motion_fits(World& world, const Sight& sight) const {
  const bool settled = this->settled(world);
  if (settled) world.earlier.clear();
  const bool stands = sight.velocity == 0;
  const Motion motion = world.motion();
  // 3.3: "Limits per axis ..., whatever the role and the way in", and whatever the drive holds (MOVE-16).
  const std::int64_t fastest = std::min(options_.velocity_limit, motion.kind == Motor::stands ? kNever : world.fastest);
  if (!trouble_ && std::abs(sight.velocity) > fastest + off(fastest)) return false;
  if (motion.kind == Motor::unknown) return true;
  // A count, as rounding has it.
  if (std::abs(sight.position - stood_at_) <= kClose && std::abs(sight.velocity) <= kCreep) return true;
  if (!settled) {
    // It brakes, or goes on: what began that way was judged then.
    if (stands || way_ == way(sight)) return stands || motion.kind != Motor::stands || moved_before(world);
    // 3.4, command 4: "target = actual is set": where a drive has no other stop it comes back to where that was read.
    if (moved_before(world) && leads_there({Motor::moves, world.stopped_at}, sight)) return true;
    return leads_there(motion, sight) ||
           std::ranges::any_of(world.earlier, [&](const Motion& m) { return leads_there(m, sight); });
  }
  // It was broken off, and stays where it is: "a drive restart, a disable, link_state 4 or 5 ... end every motion for
  // good" (3.4).
  if (stands && world.broken && sight.now_ms - since_ms_ >= kClearMs) {
    world.motor = Motor::stands;
    world.jog = 0;
    world.broken = false;
    return true;
  }
  switch (motion.kind) {
    case Motor::moves: {
      const std::int64_t way = motion.value - sight.position;
      if (std::abs(way) <= kClose) return true;
      return stands ? world.broken : (way > 0) == (sight.velocity > 0);
    }
    case Motor::runs:
      if (motion.value == 0) return stands;
      return std::abs(sight.velocity - motion.value) <= off(std::abs(motion.value));
    default:
      // 3.4, command 4: "target = actual is set": it still comes back, the way it did before.
      return stands || (way_ == way(sight) && leads_there({Motor::moves, world.stopped_at}, sight));
  }
}

// 3.1: "owner: 0 nobody, 1 this client, 2 another"; 3.4 Owed stops: "The latch is set when the stop is accepted or the
// lease ends".
bool Contract::shown(std::size_t client, const Told& told) {
  const auto unsure = [](const World& world) { return world.lease_unsure || !world.pending.empty(); };
  // What nobody was told the end of.
  const bool under_way = sight_.now_ms - unanswered_ms_ < kUnderWayMs;
  if (lost_count_ || trouble_ || under_way || std::ranges::any_of(worlds_, unsure)) return true;
  const auto fits = [&](const World& world) {
    const bool former =
        (world.orphan || world.retake_unsure) && !options_.by_address;  // a connection that has ended is another client
    const int expected = !world.owner ? 0 : *world.owner == client ? 1 : 2;
    // 3.5: "until ... its lease runs out".
    constexpr std::int64_t kUnsureMs = 60;
    const std::int64_t least = std::max<std::int64_t>(0, world.lease_ends_ms - sight_.now_ms - kUnsureMs);
    const std::int64_t most = world.lease_ends_by_ms - sight_.now_ms + kUnsureMs;
    // Of one that is open to all, which readings may have joined with one that nobody has, nothing is said.
    const bool lasts =
        !world.owner ||
        (world.lease_ends_ms == kNever ? told.lease_ms == 0 : told.lease_ms >= least && told.lease_ms <= most);
    const bool in_mode = !told.mode || !world.mode || *world.mode == *told.mode;  // 3.1; 3.3: "mode_display is awaited"
    return in_mode && (world.latched == told.latched || world.latch_unsure || world.faulted) && lasts &&
           (told.owner == expected || (former && expected == 1 && told.owner == 2));
  };
  std::vector<World> fitting;
  std::ranges::copy_if(worlds_, std::back_inserter(fitting), fits);
  if (fitting.empty()) return false;
  worlds_ = std::move(fitting);
  for (World& world : worlds_) {
    world.enabled = world.enabled && (!told.latched || world.latched);
    world.latched = told.latched;
    world.latch_unsure = false;
  }
  return true;
}

// 3.3: "a PLC never sees the target_reached of the move before"; 3.1: motion_state 2 is a motion that is completed.
bool Contract::may_be_over() const {
  if (lost_count_ || trouble_) return true;
  return std::ranges::any_of(worlds_, [&](const World& world) {
    const bool far = std::abs(world.target - sight_.position) > kClose;
    return world.motor != Motor::moves || !far || world.broken || world.awaits != 0 || !world.pending.empty();
  });
}

void Contract::Asked::see(const Sight& sight) {
  const std::int64_t speed = std::abs(sight.velocity);
  obeyed = obeyed || speed == 0 || speed < fastest || !sight.torque;
  fastest = std::max(fastest, speed);
}

bool Contract::see(const Sight& sight) {
  if ((sight.velocity == 0) != (sight_.velocity == 0)) since_ms_ = sight.now_ms;
  sight_ = sight;
  for (auto& [request, asked] : asked_) asked.see(sight);
  if (sight.velocity == 0) stood_at_ = sight.position;
  pass_time(sight.now_ms);
  if (!lost_count_) {
    for (World& world : worlds_) world.faulted = sight.faulted;
    std::vector<bool> fits;
    for (World& world : worlds_) fits.push_back(enabling_fits(world, sight) && motion_fits(world, sight));
    if (std::ranges::count(fits, true) == 0) return false;
    std::erase_if(worlds_,
                  [&](const World& world) { return !fits[static_cast<std::size_t>(&world - worlds_.data())]; });
  }
  if (sight.velocity == 0 || std::abs(sight.velocity) > kCreep) way_ = way(sight);
  was_enabled_ = sight.enabled;
  return true;
}

}  // namespace axisgate::test::reference
