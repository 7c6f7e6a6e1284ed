// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/beginning.hpp"

#include <array>
#include <stdexcept>
#include <utility>

namespace axisgate::test::judged {

using namespace reference;

namespace {

constexpr std::int64_t kJogSpeed = 45'000, kHomeSwitch = 19;
/// And their bits in `supported` (3.1).
constexpr std::array<std::pair<std::uint16_t, unsigned>, 10> kParameters{
    {{46, 18}, {47, 19}, {62, 24}, {64, 25}, {66, 26}, {68, 27}, {70, 28}, {72, 29}, {74, 30}, {76, 31}}};

ContractOptions options_of(const obey::Plant& plant, const Program& program, std::uint64_t seed) {
  const Subject subject = program.subject;
  ContractOptions options;
  options.by_address = plant.listener.client_is_address;
  options.together = together(seed);
  options.velocity_limit = velocity_limit(subject, seed).value_or(kNever);
  options.reads_fail = plant.listener.offline_reads_fail;
  options.staged = plant.listener.staged_halves;
  options.leases = program.leases;
  options.rearm_ms = plant.listener.rearm / std::chrono::milliseconds(1);
  const LeaseRules lease = lease_of(program, seed);
  options.lease_ms = lease.timeout / std::chrono::milliseconds(1);
  options.expiry_acts = lease.on_expiry != LeaseAction::none;
  options.only_writes_renew = lease.renew == LeaseRenewal::write;
  options.no_halt = is_kinco(subject) && !is_md(subject);
  options.both_modes = program.flavour != Flavour::speeds;
  options.by_gateway = !is_cia402(subject);
  if (has_positions(subject)) options.rows.insert(row::target_position);
  if (has_speeds(subject)) options.rows.insert({row::target_velocity, row::jog_velocity});
  options.rows.insert(row::mode);
  // It has no ramp of the client's, and comes back to where its stop was asked for.
  constexpr std::int64_t kComesBackMs = 5'000;
  if (is_keya(subject) && has_positions(subject)) options.settles_ms = kComesBackMs;
  return options;
}

}  // namespace

LeaseRules lease_of(const Program& program, std::uint64_t seed) {
  LeaseRules rules;
  if (seed % 7 == 3) rules.on_expiry = LeaseAction::halt;
  if (seed % 7 == 5) rules.on_expiry = LeaseAction::disable;
  // A drive that must be told again and again stops when nobody owns it.
  if (seed % 7 == 6 && is_cia402(program.subject)) rules.on_expiry = LeaseAction::none;
  if (seed % 5 == 4) rules.renew = LeaseRenewal::write;
  if (seed % 4 == 2) rules.timeout = std::chrono::milliseconds(seed % 8 == 2 ? 700 : 5000);
  return rules;
}

// A Keya's moves and an iD286pro's homing have speeds that the gateway does not know.
std::optional<std::int64_t> velocity_limit(Subject subject, std::uint64_t seed) {
  constexpr std::int64_t kLimit = 160'000;  // no program asks for more
  const bool known = is_cia402(subject) || (is_keya(subject) && !has_positions(subject));
  return known && seed % 5 == 3 ? std::optional(kLimit) : std::nullopt;
}

std::size_t together(std::uint64_t seed) {
  if (seed % 4 == 1) return 1;  // "client": "address"
  return seed % 3 == 2 ? 2 : seed % 6 == 0 ? reference::kModbus : 1;
}

Beginning begin(obey::Plant& plant, const Program& program, std::uint64_t seed) {
  constexpr std::int64_t kSinceReady = 100;
  plant.ready();
  Beginning out{.options = options_of(plant, program, seed)};
  const auto fitter = plant.connection_from(obey::Plant::kHostOfFitter, obey::plain(plant.listener));
  Rows rows;
  if (has_speeds(program.subject)) rows[row::jog_velocity] = kJogSpeed;
  if (has_homing(program.subject)) rows[row::homing_method] = kHomeSwitch;
  for (const auto& [offset, value] : rows)
    if (!fitter->row(offset, value).ok()) throw std::runtime_error("row " + std::to_string(offset) + " was refused");
  out.world.accepted = rows;
  if (const Rows profile = plant.profile_rows(); profile.contains(row::profile_velocity)) {
    out.options.rows.insert(row::profile_velocity);
    out.world.accepted[row::profile_velocity] = profile.at(row::profile_velocity);
  }
  fitter->command(0);
  if (!rows.empty()) fitter->command(kRelease);
  out.commands = static_cast<std::uint32_t>(fitter->wide(obey::shown::supported_commands));
  if ((out.commands >> kSetPosition & 1U) != 0) out.options.rows.insert(row::set_position_value);
  for (const auto& [offset, bit] : kParameters) {
    if (!plant.has(bit)) continue;
    out.options.parameters.insert(offset);
    out.parameters[offset] = is_wide(offset) ? static_cast<std::int32_t>(fitter->wide(offset)) : fitter->word(offset);
  }
  if (out.parameters.contains(row::homing_speed_switch))
    out.options.homing_speed =
        std::max(out.parameters[row::homing_speed_switch], out.parameters[row::homing_speed_zero]);
  // More than that is refused, though the drive may hold it.
  for (const std::uint16_t speed : {row::homing_speed_switch, row::homing_speed_zero, row::max_velocity})
    if (const auto held = out.parameters.find(speed); held != out.parameters.end())
      held->second = std::min(held->second, out.options.velocity_limit);
  out.world.enabled = true;
  // It was released: the lease is open, and began a moment ago.
  if (program.leases) out.world.lease_until(out.options.lease_ms - (rows.empty() ? kSinceReady : 0));
  return out;
}

}  // namespace axisgate::test::judged
