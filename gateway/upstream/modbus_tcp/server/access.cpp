// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/server/access.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace axisgate::modbus_tcp {
namespace {

bool same_bits(const Address& a, const Address& b, std::uint8_t bits) {
  const std::size_t whole = bits / 8U;
  if (!std::equal(a.begin(), a.begin() + whole, b.begin())) return false;
  if (bits % 8U == 0) return true;
  const unsigned mask = 0xFFU << (8U - bits % 8U);
  return ((static_cast<unsigned>(a[whole]) ^ b[whole]) & mask & 0xFFU) == 0;
}

const AllowEntry* deciding_entry(const ListenerSettings& settings, const Address& address) {
  const AllowEntry* best = nullptr;
  for (const AllowEntry& entry : settings.allow) {
    if (holds(entry, address) && (best == nullptr || entry.prefix > best->prefix)) best = &entry;
  }
  return best;
}

}  // namespace

bool is_loopback(const Address& address) {
  if (is_mapped(address)) return address[kMappedBytes] == 127;
  return std::all_of(address.begin(), address.end() - 1, [](std::uint8_t b) { return b == 0; }) && address[15] == 1;
}

bool holds(const AllowEntry& entry, const Address& address) {
  return same_bits(entry.network, address, std::min<std::uint8_t>(entry.prefix, 128));
}

Role role_of(const ListenerSettings& settings, const Address& address) {
  if (!settings.has_allow) return is_loopback(address) ? Role::engineer : Role::viewer;
  const AllowEntry* entry = deciding_entry(settings, address);
  return entry == nullptr ? Role::none : entry->role;
}

std::uint8_t rank_of(const ListenerSettings& settings, const Address& address) {
  const AllowEntry* entry = settings.has_allow ? deciding_entry(settings, address) : nullptr;
  return entry == nullptr ? std::uint8_t{0} : entry->rank;
}

std::uint32_t kept_for_operators(const ListenerSettings& settings) {
  const bool named = settings.has_allow &&
                     std::ranges::any_of(settings.allow, [](const AllowEntry& e) { return e.role > Role::viewer; });
  return named ? settings.max_clients / 10 : 0;
}

std::string text(ConnectionVerdict verdict, const ListenerSettings& settings) {
  switch (verdict) {
    case ConnectionVerdict::admitted:
      return "admitted";
    case ConnectionVerdict::not_allowed:
      return "`allow` does not name this address";
    case ConnectionVerdict::listener_full:
      return "max_clients (" + std::to_string(settings.max_clients) + ") is reached";
    case ConnectionVerdict::address_full:
      return "max_clients_per_address (" + std::to_string(settings.max_clients_per_address) + ") is reached";
    case ConnectionVerdict::kept_for_operators:
      return "the last " + std::to_string(modbus_tcp::kept_for_operators(settings)) + " of max_clients (" +
             std::to_string(settings.max_clients) + ") are kept for operators and engineers";
    case ConnectionVerdict::no_descriptor:
      return "the system's descriptor limit is reached; raise LimitNOFILE";
  }
  return {};
}

ConnectionVerdict ClientCounts::admit(const ListenerSettings& settings, const Address& address, Role role,
                                      std::uint32_t descriptors_for) {
  if (role == Role::none) return ConnectionVerdict::not_allowed;
  if (total_ >= settings.max_clients) return ConnectionVerdict::listener_full;
  if (total_ >= descriptors_for) return ConnectionVerdict::no_descriptor;
  if (settings.max_clients_per_address != 0 && of(address) >= settings.max_clients_per_address) {
    return ConnectionVerdict::address_full;
  }
  const std::uint32_t room = std::min(settings.max_clients, descriptors_for);
  if (role == Role::viewer && total_ + modbus_tcp::kept_for_operators(settings) >= room) {
    return ConnectionVerdict::kept_for_operators;
  }
  ++total_;
  ++by_address_[address];
  return ConnectionVerdict::admitted;
}

void ClientCounts::release(const Address& address) {
  const auto found = by_address_.find(address);
  assert(found != by_address_.end() && total_ > 0);
  --total_;
  if (--found->second == 0) by_address_.erase(found);
}

std::uint32_t ClientCounts::of(const Address& address) const {
  const auto found = by_address_.find(address);
  return found == by_address_.end() ? 0 : found->second;
}

std::optional<std::uint64_t> LineLimit::admit(Instant now) {
  if (last_ && now - *last_ < interval_) {
    ++left_out_;
    return std::nullopt;
  }
  last_ = now;
  return std::exchange(left_out_, 0);
}

}  // namespace axisgate::modbus_tcp
