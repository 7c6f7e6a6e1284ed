#include "gateway/upstream/modbus_tcp/client_registry.hpp"

#include <algorithm>
#include <cassert>

namespace axisgate::modbus_tcp {

const ClientAxis* Client::find(AxisNumber axis) const {
  const auto found = axes.find(axis);
  return found == axes.end() ? nullptr : &found->second;
}

std::optional<std::uint16_t> Client::last_id(AxisNumber axis) const {
  const auto found = host->ids.find(axis);
  return found == host->ids.end() ? std::nullopt : found->second.last;
}

ClientRegistry::Connected ClientRegistry::connect(const Address& address, bool shared, Instant now) {
  Connected connected;
  Entry& entry = hosts_[address];
  const bool expired = entry.host != nullptr && entry.host->connections == 0 && now - entry.host->left_at >= kHostKept;
  ClientId id = 0;
  if (entry.host == nullptr || expired) {
    // What it wrote is forgotten, but who comes back is the client that left: nothing it commanded may end by that.
    if (shared && entry.shared_client != nullptr) id = entry.shared_client->id;
    entry = {std::make_shared<Host>(), nullptr};
  }
  ++entry.host->connections;
  connected.client = shared ? entry.shared_client : nullptr;
  if (connected.client == nullptr) {
    connected.client = std::make_shared<Client>();
    connected.client->id = id != 0 ? id : ++last_id_;
    connected.client->address = address;
    connected.client->host = entry.host;
    if (shared) entry.shared_client = connected.client;
  }
  if (!connected.forgotten) connected.forgotten = forget_oldest_idle();
  return connected;
}

std::optional<ClientId> ClientRegistry::disconnect(const std::shared_ptr<Client>& client, Instant now) {
  Host& host = *client->host;
  assert(host.connections > 0);
  if (--host.connections == 0) host.left_at = now;
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
