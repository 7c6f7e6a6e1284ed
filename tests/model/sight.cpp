// Whether a world's motor may do what is seen.
#include <algorithm>
#include <cstdlib>

#include "tests/model/contract.hpp"

namespace axisgate::test::model {
namespace {

constexpr std::int64_t kEnableMs = 2000;  // from an accepted enable to the torque, at most

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
  if (*sight.enabled && !*was_enabled_)
    return world.enabled || sight.now_ms - world.enable_asked_ms <= kEnableMs || !world.pending.empty();
  if (!*sight.enabled && *was_enabled_ && world.enabled && !world.latched) {
    if (sight.now_ms - world.off_asked_ms <= options_.settles_ms && !trouble_) return true;
    if (!trouble_ && !world.broken && !world.faulted) return false;
    const Motion before = world.motion();
    world.enabled = false;
    world.motor = Motor::stands;
    world.jog = 0;
    world.ladder = 0;
    changed(world, before);
  }
  // Disabled long ago, by a command: torque is off.
  if (*sight.enabled && !world.enabled && !world.latched && !world.broken && settled(world)) return false;
  return true;
}

bool Contract::motion_fits(World& world, const Sight& sight) const {
  constexpr std::int64_t kSpeedShare = 50;  // one part in so many
  constexpr std::int64_t kSlowest = 1'500;  // a drive that counts whole rpm
  constexpr std::int64_t kCreep = 10'000;
  const bool settled = this->settled(world);
  if (settled) world.earlier.clear();
  const bool stands = sight.velocity == 0;
  const Motion motion = world.motion();
  if (motion.kind == Motor::unknown) return true;
  // A count, as rounding has it.
  if (std::abs(sight.position - stood_at_) <= kClose && std::abs(sight.velocity) <= kCreep) return true;
  if (!settled) {
    if (stands || motion.kind != Motor::stands) return true;
    return std::ranges::any_of(world.earlier, [](const Motion& m) { return m.kind != Motor::stands; });
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
      return std::abs(sight.velocity - motion.value) <= std::max(std::abs(motion.value) / kSpeedShare, kSlowest);
    default:
      return stands;
  }
}

bool Contract::see(const Sight& sight) {
  if ((sight.velocity == 0) != (sight_.velocity == 0)) since_ms_ = sight.now_ms;
  sight_ = sight;
  if (sight.velocity == 0) stood_at_ = sight.position;
  pass_time(sight.now_ms);
  std::vector<World> fitting;
  if (!lost_count_) {
    for (World& world : worlds_) world.faulted = sight.faulted;
    for (World& world : worlds_)
      if (enabling_fits(world, sight) && motion_fits(world, sight)) fitting.push_back(std::move(world));
    if (fitting.empty()) return false;
    worlds_ = std::move(fitting);
  }
  was_enabled_ = sight.enabled;
  return true;
}

}  // namespace axisgate::test::model
