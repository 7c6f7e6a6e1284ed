// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/motion/ownership.hpp"

namespace axisgate::drive {
namespace {

// Both are DDS writers: a Modbus client has no strength, and loses nothing to one that has.
bool stronger(const ClientLife& a, const ClientLife& b) {
  return a.strength && b.strength && *a.strength > *b.strength;
}

}  // namespace

// A returning PLC must not wait for the lease of its own connection that has ended. One that has not ended yet (a cable
// was pulled, nobody has sent a reset) is somebody's until its lease runs out, or until command take_over.
Ownership::Taken Ownership::how(const ClientLife& client) const {
  if (!lease_.running) return Taken::free;
  if (!lease_.owner) return Taken::open;
  if (may_be_back_as(client, *lease_.owner)) return Taken::orphan;  // however strong: nobody is its own rival
  if (stronger(client, *lease_.owner)) return Taken::weaker;
  return same_origin_and_role(*lease_.owner, client) ? Taken::same_origin_and_role : Taken::lower_rank;
}

Errc Ownership::judge(const ClientPtr& client, bool claims) const {
  if (!lease_.rules.on || !client || !lease_.owner || lease_.owner->id == client->id) return Errc::ok;
  const Taken taken = how(*client);
  return taken == Taken::orphan || (claims && taken == Taken::weaker) ? Errc::ok : Errc::not_owner;
}

bool Ownership::waits_for(const ClientPtr& client, bool all_zero) const {
  if (!lease_.rules.on || !client || !lease_.running) return false;
  // What was released must not be taken back by the block that its scanner goes on writing.
  return lease_.owner ? how(*client) == Taken::orphan : adopted_ && !all_zero;
}

Ownership::Taken Ownership::take(const ClientPtr& client, Instant now) {
  if (!lease_.rules.on || !client || lease_.owned_by(client->id)) return Taken::nothing;
  const Taken taken = how(*client);
  lease_.owner = client;
  lease_.running = true;
  lease_.renewed = now;
  return taken;
}

void Ownership::wrote(const ClientPtr& client, bool beats, bool asks, Instant now) {
  if (!client || !lease_.owned_by(client->id)) return;
  const bool is_sign = beats || lease_.rules.renew != LeaseRenewal::heartbeat;
  if (lease_.any_sign ? is_sign : asks) lease_.renewed = now;
}

void Ownership::set_armed(bool armed) {
  if (armed == lease_.any_sign) return;
  // What kept the lease alive until now goes on counting from its own time.
  lease_.renewed = lease_.last_sign();
  lease_.any_sign = armed;
}

Errc Ownership::may_take_over(const ClientPtr& client) const {
  if (!lease_.rules.on) return Errc::not_supported;
  if (!client || !lease_.owner || lease_.owner->id == client->id) return Errc::ok;
  // Strength, not the hand, decides between DDS writers that are there.
  const Taken taken = how(*client);
  const bool same_program = taken == Taken::orphan || (taken == Taken::same_origin_and_role && !client->strength);
  return same_program || lease_.owner->rank < client->rank ? Errc::ok : Errc::not_owner;
}

Errc Ownership::release(const ClientPtr& client, bool enabled, Instant now) {
  if (!lease_.rules.on) return Errc::not_supported;
  if (!lease_.owner) return Errc::ok;
  if (!client || lease_.owner->id != client->id) return Errc::not_owner;
  lease_.owner.reset();
  adopted_ = false;
  lease_.running = enabled;
  lease_.renewed = now;
  return Errc::ok;
}

void Ownership::open(Instant now) {
  if (!lease_.rules.on || lease_.running) return;
  lease_.owner.reset();
  adopted_ = true;
  lease_.running = true;
  lease_.renewed = now;
}

std::optional<Ownership::Expired> Ownership::take_expired(Instant now) {
  if (!lease_.running || now < lease_.until()) return std::nullopt;
  Expired expired{!lease_.owner, lease_.owner, lease_.timeout()};
  lease_.owner.reset();
  lease_.running = false;
  return expired;
}

std::string text(Ownership::Taken taken, const ClientLife& client) {
  switch (taken) {
    case Ownership::Taken::nothing:
      return {};
    case Ownership::Taken::free:
      return client.name + " owns the axis";
    case Ownership::Taken::open:
      return client.name + " owns the axis, which was enabled without an owner";
    case Ownership::Taken::orphan:
      return client.name + (client.strength ? " goes on as the owner, for another writer of its participant"
                                            : " is back and goes on as the owner: its connection had ended");
    case Ownership::Taken::same_origin_and_role:
      return client.name + " has taken the axis over from another connection of its address";
    case Ownership::Taken::weaker:
      return client.name + " has taken the axis over from a weaker DDS writer";
    case Ownership::Taken::lower_rank:
      return client.name + " has taken the axis over from a lower rank";
  }
  return {};
}

}  // namespace axisgate::drive
