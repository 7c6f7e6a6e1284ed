#include "gateway/drive/ownership.hpp"

namespace axisgate::drive {
namespace {

bool same_hand(const ClientLife& a, const ClientLife& b) { return a.origin == b.origin && a.role == b.role; }

// Both are DDS writers: a Modbus client has no strength, and loses nothing to one that has.
bool stronger(const ClientLife& a, const ClientLife& b) {
  return a.strength && b.strength && *a.strength > *b.strength;
}

}  // namespace

// A returning PLC must not wait for the lease of its own lost connection. Where that has not ended yet (a cable was
// pulled, nobody has sent a reset) its silence tells: a client that is there asks more often than that.
Ownership::Taken Ownership::how(const ClientLife& client, Instant now) const {
  if (!lease_.running) return Taken::free;
  if (!lease_.owner) return Taken::open;
  if (stronger(client, *lease_.owner)) return Taken::weaker;
  if (!same_hand(*lease_.owner, client)) return Taken::lower_rank;
  if (!lease_.owner->connected) return Taken::orphan;
  return now - lease_.owner->last_request > lease_.rules.timeout / 2 ? Taken::half_open : Taken::lower_rank;
}

Errc Ownership::judge(const ClientPtr& client, bool claims, Instant now) const {
  if (!lease_.rules.on || !client || !lease_.owner || lease_.owner->id == client->id) return Errc::ok;
  return claims && how(*client, now) != Taken::lower_rank ? Errc::ok : Errc::not_owner;
}

Ownership::Taken Ownership::take(const ClientPtr& client, Instant now) {
  if (!lease_.rules.on || !client || lease_.owned_by(client->id)) return Taken::nothing;
  const Taken taken = how(*client, now);
  lease_.owner = client;
  lease_.running = true;
  lease_.renewed = now;
  return taken;
}

void Ownership::wrote(const ClientPtr& client, bool beats, Instant now) {
  if (!client || !lease_.owned_by(client->id)) return;
  if (beats || lease_.rules.renew != LeaseRenewal::heartbeat) lease_.renewed = now;
}

Errc Ownership::may_take_over(const ClientPtr& client) const {
  if (!lease_.rules.on) return Errc::not_supported;
  if (!client || !lease_.owner || lease_.owner->id == client->id) return Errc::ok;
  return lease_.owner->rank < client->rank ? Errc::ok : Errc::not_owner;
}

Errc Ownership::release(const ClientPtr& client, bool enabled, Instant now) {
  if (!lease_.rules.on) return Errc::not_supported;
  if (!lease_.owner) return Errc::ok;
  if (!client || lease_.owner->id != client->id) return Errc::not_owner;
  lease_.owner.reset();
  lease_.running = enabled;
  lease_.renewed = now;
  return Errc::ok;
}

void Ownership::open(Instant now) {
  if (!lease_.rules.on || lease_.running) return;
  lease_.owner.reset();
  lease_.running = true;
  lease_.renewed = now;
}

std::optional<Ownership::Expired> Ownership::take_expired(Instant now) {
  if (!lease_.running || now < lease_.until()) return std::nullopt;
  Expired expired{!lease_.owner, lease_.owner};
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
    case Ownership::Taken::half_open:
      return client.name + " is back and goes on as the owner: its other connection had fallen silent";
    case Ownership::Taken::weaker:
      return client.name + " has taken the axis over from a weaker DDS writer";
    case Ownership::Taken::lower_rank:
      return client.name + " has taken the axis over from a lower rank";
  }
  return {};
}

}  // namespace axisgate::drive
