// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace axisgate::modbus_tcp {

const ClientAxis* Client::find(AxisNumber axis) const {
  const auto found = axes.find(axis);
  return found == axes.end() ? nullptr : &found->second;
}

std::optional<std::uint16_t> Client::last_id(AxisNumber axis) const {
  const auto found = host->ids.find(axis);
  return found == host->ids.end() ? std::nullopt : found->second.last;
}

std::optional<std::uint16_t> Client::seen_id(AxisNumber axis) const {
  const auto found = host->ids.find(axis);
  return found == host->ids.end() ? std::nullopt : found->second.seen;
}

WriteBatch Client::new_batch(Role role) const {
  WriteBatch batch;
  batch.client = id;
  batch.role = role;
  batch.life = life;
  return batch;
}

std::shared_ptr<Client> ClientRegistry::make_client(std::shared_ptr<Host> host, std::shared_ptr<ClientLife> life) {
  auto client = std::make_shared<Client>();
  if (life == nullptr) {
    life = std::make_shared<ClientLife>();
    life->id = ++last_id_;
  }
  client->id = life->id;
  client->host = std::move(host);
  client->life = std::move(life);
  return client;
}

/// The rank of who owns an axis is not to be lowered by whom else the same address connects, through any listener.
void ClientRegistry::put_role(ClientLife& life, const Peer& peer, bool alone) {
  const bool commands = peer.role >= Role::operator_;
  if (alone && (commands || life.role < Role::operator_)) {
    life.role = peer.role;
    life.rank = peer.rank;
  } else if (commands) {
    life.role = std::max(life.role, peer.role);
    life.rank = std::max(life.rank, peer.rank);
  }
}

ClientRegistry::Connected ClientRegistry::connect(const Peer& peer, bool shared, Instant now) {
  Connected connected;
  Entry& entry = hosts_[peer.address];
  const bool expired = entry.host != nullptr && entry.host->connections == 0 && now - entry.host->left_at >= kHostKept;
  std::shared_ptr<ClientLife> life;
  if (entry.host == nullptr || expired) {
    // What it wrote is forgotten, but who comes back is the client that left: nothing it commanded may end by that, and
    // what it owns is still its own.
    if (shared && entry.shared_client != nullptr) life = entry.shared_client->life;
    entry = {std::make_shared<Host>(), nullptr};
  }
  ++entry.host->connections;
  connected.client = shared ? entry.shared_client : nullptr;
  if (connected.client == nullptr) {
    connected.client = make_client(entry.host, std::move(life));
    connected.client->address = peer.address;
    if (shared) entry.shared_client = connected.client;
  }
  ++connected.client->connections;
  ClientLife& alive = *connected.client->life;
  put_role(alive, peer, connected.client->connections == 1);
  alive.origin = peer.address;
  alive.name = shared ? text(peer.address) : text(peer);
  alive.connected = true;
  if (connected.client->connections == 1) alive.opened = now;
  alive.is_address = shared;
  connected.forgotten = forget_oldest_idle();
  return connected;
}

std::optional<ClientId> ClientRegistry::disconnect(const std::shared_ptr<Client>& client, Instant now) {
  Host& host = *client->host;
  assert(host.connections > 0 && client->connections > 0);
  if (--host.connections == 0) host.left_at = now;
  if (--client->connections == 0) client->life->connected = false;
  const auto entry = hosts_.find(client->address);
  const bool stays = entry != hosts_.end() && entry->second.shared_client == client;
  return stays ? std::nullopt : std::optional(client->id);
}

std::optional<ClientId> ClientRegistry::forget_oldest_idle() {
  std::size_t idle = 0;
  auto oldest = hosts_.end();
  for (auto each = hosts_.begin(); each != hosts_.end(); ++each) {
    if (each->second.host->connections != 0) continue;
    ++idle;
    if (oldest == hosts_.end() || each->second.host->left_at < oldest->second.host->left_at) oldest = each;
  }
  if (idle <= kMaxIdleHosts) return std::nullopt;
  const auto gone = oldest->second.shared_client;
  hosts_.erase(oldest);
  return gone == nullptr ? std::nullopt : std::optional(gone->id);
}

}  // namespace axisgate::modbus_tcp
