// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/beginning.hpp"

#include <stdexcept>

namespace axisgate::test::judged {

using namespace model;

namespace {

constexpr std::int64_t kJogSpeed = 45'000, kHomeSwitch = 19;

ContractOptions options_of(const obey::Plant& plant, const Program& program, std::uint64_t seed) {
  const Subject subject = program.subject;
  ContractOptions options;
  options.by_address = plant.listener.client_is_address;
  options.staged = plant.listener.staged_halves;
  options.leases = program.leases;
  const LeaseRules lease = lease_of(program, seed);
  options.expiry_acts = lease.on_expiry != LeaseAction::none;
  options.only_writes_renew = lease.renew == LeaseRenewal::write;
  options.no_halt = obey::is_kinco(subject) && !obey::is_md(subject) && program.flavour != Flavour::speeds;
  options.by_gateway = !obey::is_cia402(subject);
  if (obey::has_positions(subject)) options.rows.insert(row::target_position);
  if (obey::has_speeds(subject)) options.rows.insert(row::target_velocity);
  options.rows.insert(row::mode);
  // It has no ramp of the client's, and comes back to where its stop was asked for.
  constexpr std::int64_t kComesBackMs = 5'000;
  if (obey::is_keya(subject) && obey::has_positions(subject)) options.settles_ms = kComesBackMs;
  return options;
}

}  // namespace

LeaseRules lease_of(const Program& program, std::uint64_t seed) {
  LeaseRules rules;
  if (seed % 7 == 3) rules.on_expiry = LeaseAction::halt;
  if (seed % 7 == 5) rules.on_expiry = LeaseAction::disable;
  // A drive that must be told again and again stops when nobody owns it.
  if (seed % 7 == 6 && obey::is_cia402(program.subject)) rules.on_expiry = LeaseAction::none;
  if (seed % 5 == 4) rules.renew = LeaseRenewal::write;
  return rules;
}

Beginning begin(obey::Plant& plant, const Program& program, std::uint64_t seed) {
  constexpr std::int64_t kSinceReady = 100;
  plant.ready();
  Beginning out{.options = options_of(plant, program, seed)};
  const auto fitter = plant.connection_from(obey::Plant::kHostOfFitter, obey::plain(plant.listener));
  Rows rows;
  if (obey::has_speeds(program.subject)) rows[row::jog_velocity] = kJogSpeed;
  if (obey::has_homing(program.subject)) rows[row::homing_method] = kHomeSwitch;
  for (const auto& [offset, value] : rows)
    if (!fitter->row(offset, value).ok()) throw std::runtime_error("row " + std::to_string(offset) + " was refused");
  out.world.accepted = rows;
  fitter->command(0);
  if (!rows.empty()) fitter->command(kRelease);
  out.commands = static_cast<std::uint32_t>(fitter->wide(obey::shown::supported_commands));
  if ((out.commands >> kSetPosition & 1U) != 0) out.options.rows.insert(row::set_position_value);
  out.world.enabled = true;
  // It was released: the lease is open, and began a moment ago.
  if (program.leases) out.world.lease_until(out.options.lease_ms - (rows.empty() ? kSinceReady : 0));
  return out;
}

}  // namespace axisgate::test::judged
