// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/dds_clients.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "gateway/upstream/dds/dds_session.hpp"

namespace axisgate::dds {
namespace {

constexpr std::size_t kEntityKey = 3;  // DDSI-RTPS 2.2, 9.3.1.2; the last byte of the GUID is the entity's kind

/// Where a writer comes from is its participant: a new writer of it takes an orphan of an old one over.
Origin origin_of(const Guid& writer) {
  Origin origin{};
  std::copy_n(writer.begin(), kGuidPrefix, origin.begin());
  return origin;
}

std::string hex(const Guid& guid, std::size_t from, std::size_t count) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out;
  for (std::size_t i = from; i < from + count; ++i) {
    out += kDigits[guid[i] >> 4U];
    out += kDigits[guid[i] & 0xFU];
  }
  return out;
}

}  // namespace

std::string client_name(const Guid& writer, const std::string& where) {
  const std::string guid = hex(writer, 0, kGuidPrefix) + ":" + hex(writer, kGuidPrefix, kEntityKey);
  return where.empty() ? "dds " + guid : "dds " + where + " " + guid;
}

DdsClient* DdsClients::find(const Guid& writer) {
  const auto found = clients_.find(writer);
  return found == clients_.end() || found->second.life == nullptr ? nullptr : &found->second;
}

std::string DdsClients::name_of(const Guid& writer) const {
  const auto found = clients_.find(writer);
  return client_name(writer, found == clients_.end() ? std::string() : found->second.where);
}

std::size_t DdsClients::size() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(clients_, [](const auto& each) { return each.second.life != nullptr; }));
}

std::shared_ptr<ClientLife> DdsClients::new_life(const Guid& writer) {
  auto life = std::make_shared<ClientLife>();
  life->id = next_id_++;
  life->role = identities_.role_of(writer);
  life->origin = origin_of(writer);
  life->name = client_name(writer, {});
  life->strength = 0;
  return life;
}

std::size_t DdsClients::beating_alone() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(clients_, [](const auto& each) { return each.second.beats_alone; }));
}

// Those that beat alone take nobody's.
bool DdsClients::has_place(const Guid& writer) const {
  const auto found = clients_.find(writer);
  const bool has_one = found != clients_.end() && !found->second.beats_alone;
  return has_one || clients_.size() - beating_alone() < kMaxWritersKnown;
}

DdsClient& DdsClients::know(const Guid& writer) {
  const auto [at, is_new] = clients_.try_emplace(writer);
  DdsClient& client = at->second;
  if (!is_new) return client;
  const auto before = gone_owners_.find(writer);
  for (const auto& axis : image_.axes()) {
    const auto& owner = axis->lease.owner;
    if (!owner || owner->connected || owner->origin != origin_of(writer)) continue;
    client.left.push_back({axis->number, owner->id, before != gone_owners_.end() && before->second == owner->id});
  }
  return client;
}

// Design 3.5 and 4: a sign of life of its own program takes an orphan lease over. Of a writer that was heard already
// when the owner went it is none for the owner's axes: they are stopped when their time is over.
void DdsClients::take_back(const Guid& writer, bool own_alone, Instant now) {
  const auto found = clients_.find(writer);
  if (found == clients_.end()) return;
  found->second.heard = true;
  std::vector<LeftAxis>& all = found->second.left;
  const auto rest =
      std::stable_partition(all.begin(), all.end(), [&](const LeftAxis& each) { return own_alone && !each.own; });
  const std::vector<LeftAxis> taken(rest, all.end());
  all.erase(rest, all.end());
  for (const LeftAxis& each : taken) {
    const AxisImage* const axis = image_.find(each.axis);
    if (axis == nullptr || !axis->lease.owned_by(each.owner)) continue;
    const DdsClient* const client = on_sample(writer, std::nullopt, true, now);
    if (client == nullptr) return;
    WriteBatch sign;
    sign.client = client->life->id;
    sign.role = client->life->role;
    sign.life = client->life;
    sign.reclaims = sign.beats = true;
    static_cast<void>(commands_.submit(each.axis, sign, [](const BatchResult&) {}));
  }
}

// A heartbeat is a topic of its own: it may be here before anything else of its writer is.
DdsClient& DdsClients::beating(const Guid& writer, bool is_new, Instant now) {
  if (is_new) make_room_to_beat();
  DdsClient& client = know(writer);
  client.beats_alone = client.beats_alone || is_new;
  if (client.beats_alone) {
    client.returns_by = now + kReturnsWithin;
    look_at_deadlines();
  }
  return client;
}

/// Of those that beat alone the one that was heard longest ago is forgotten.
void DdsClients::make_room_to_beat() {
  if (beating_alone() < kMaxBeatsBefore) return;
  const auto longest = std::ranges::min_element(clients_, [](const auto& a, const auto& b) {
    return std::tuple(!a.second.beats_alone, a.second.returns_by) <
           std::tuple(!b.second.beats_alone, b.second.returns_by);
  });
  clients_.erase(longest);
}

bool DdsClients::makes_way(const DdsClient& client) const {
  return client.life != nullptr && !client.unleased && client.held.empty() && !owns(client.life->id);
}

bool DdsClients::owns(ClientId client) const {
  return std::ranges::any_of(image_.axes(), [&](const auto& axis) { return axis->lease.owned_by(client); });
}

/// Of those that make way the one that was heard longest ago is no client any more, until it asks again.
bool DdsClients::make_room() {
  if (size() < kMaxWriters) return true;
  DdsClient* longest = nullptr;
  for (auto& [guid, client] : clients_) {
    if (!makes_way(client)) continue;
    if (longest == nullptr || client.life->last_request < longest->life->last_request) longest = &client;
  }
  if (longest == nullptr) return false;
  end(*longest);
  longest->released.clear();
  longest->commands = false;
  return true;
}

std::shared_ptr<ClientLife> DdsClients::stranger(const Guid& writer, Instant now) {
  auto life = new_life(writer);
  life->last_request = now;
  return life;
}

std::string DdsClients::on_writer(const WriterRecord& record) {
  std::string told;
  if (record.gone) {
    if (const auto found = clients_.find(record.writer); found != clients_.end()) forget(found);
  } else if (has_place(record.writer)) {
    DdsClient& client = know(record.writer);
    client.strength = record.strength;
    client.where = record.where;
    client.returns_by = kNever;
    client.beats_alone = false;
    if (client.life != nullptr) {
      client.life->strength = record.strength;
      client.life->name = name_of(record.writer);
    }
    told = liveliness_remark(record.liveliness);
    if (!told.empty()) told = std::exchange(client.liveliness_logged, true) ? "" : name_of(record.writer) + ": " + told;
  }
  look_at_deadlines();
  return told;
}

// As of when they were said: they may have lain in the socket while this gateway stood still.
void DdsClients::on_beats(const BeatRecord& record, Instant now) {
  const Instant said = record.said == 0 ? now : std::min(now, Instant(Duration(record.said)));
  for (const Guid& writer : record.writers) {
    take_back(writer, true, now);
    DdsClient* const client = find(writer);
    if (client == nullptr) continue;
    client->life->last_request = std::max(client->life->last_request, said);
    client->life->heartbeat = std::max(client->life->heartbeat, said);
    client->returns_by = kNever;
  }
  look_at_deadlines();
}

// What it says of the lease counts as long as its writer is there, also once it has fallen silent, and also if it has
// asked for nothing yet: a program that dies right after its first command is stopped as soon as it wished.
void DdsClients::on_heartbeat(const HeartbeatRecord& record, Instant now) {
  const auto known = clients_.find(record.client);
  // Who ends it says that its program has nothing more to say. Its writer is there still: by a sample it comes back.
  if (record.gone) {
    if (known != clients_.end() && same_participant(record.writer, record.client)) leave(known->first, known->second);
    return;
  }
  if (!signs_.counts(record, known == clients_.end() ? std::nullopt : known->second.counter, now)) return;
  DdsClient& client = beating(record.client, known == clients_.end(), now);
  client.counter = record.counter;
  client.lease_limit.reset();
  if (record.lease_ms != 0) client.lease_limit = std::chrono::milliseconds(record.lease_ms);
  take_back(record.client, false, now);
  if (client.life == nullptr) return;
  client.life->last_request = client.life->heartbeat = now;
  client.life->lease_limit = client.lease_limit;
}

DdsClient* DdsClients::on_sample(const Guid& writer, std::optional<std::int32_t> strength, bool fresh, Instant now) {
  const bool is_told_of = clients_.contains(writer);
  DdsClient* client = find(writer);
  if (client == nullptr) {
    if (!has_place(writer) || !make_room()) return nullptr;
    client = &know(writer);
    client->life = new_life(writer);
    client->life->name = name_of(writer);
    client->life->strength = client->strength;
    client->life->lease_limit = client->lease_limit;
    recall_held(writer, *client);
  }
  client->beats_alone = false;
  client->heard = true;
  if (strength) client->life->strength = strength;
  if (fresh) client->life->last_request = now;
  if (!is_told_of || client->returns_by != kNever) {
    client->returns_by = now + kReturnsWithin;
    look_at_deadlines();
  }
  return client;
}

bool DdsClients::asks_for_objects(const ClientLife& owner, const ClientLife& other) const {
  if (owner.id == other.id || owner.origin != other.origin) return false;
  return std::ranges::any_of(clients_, [&owner](const auto& each) {
    return each.second.life != nullptr && each.second.life->id == owner.id && !each.second.commands;
  });
}

void DdsClients::on_link_up(Instant now) {
  link_up_ = true;
  for (auto& [guid, client] : clients_) client.returns_by = now + kReturnsWithin;
  look_at_deadlines();
}

// Once: it is a time added to when a client was last heard, so a second loss of the link before that adds nothing.
void DdsClients::on_link_down(Instant now) {
  link_up_ = false;
  for (auto& [guid, client] : clients_)
    if (client.life != nullptr) client.life->grace = {kGrace, now};
  look_at_deadlines();
}

void DdsClients::end(DdsClient& client) {
  const std::shared_ptr<ClientLife> life = std::exchange(client.life, nullptr);
  if (life == nullptr) return;
  life->connected = false;
  life->grace = {};
  commands_.client_gone(life->id);
}

void DdsClients::remember_held(const Guid& writer, DdsClient& client) {
  if (client.held.empty()) return;
  for (auto& [axis, jog] : client.held) jog.starting = false;
  held_before_.emplace_back(writer, std::exchange(client.held, {}));
  if (held_before_.size() > kMaxWriters) held_before_.pop_front();
}

void DdsClients::recall_held(const Guid& writer, DdsClient& client) {
  const auto found = std::ranges::find_if(held_before_, [&](const auto& each) { return each.first == writer; });
  if (found == held_before_.end()) return;
  client.held = std::move(found->second);
  held_before_.erase(found);
}

/// Its axes wait for its own return, and for a writer that is made as this one is deleted, and may be told of first.
void DdsClients::leave_axes(const Guid& writer, const ClientLife& life) {
  gone_owners_[writer] = life.id;
  for (auto& [guid, other] : clients_) {
    if (other.heard || !same_participant(guid, writer)) continue;
    for (const auto& axis : image_.axes()) {
      if (!axis->lease.owned_by(life.id)) continue;
      std::erase_if(other.left, [&](const LeftAxis& each) { return each.axis == axis->number; });
      other.left.push_back({axis->number, life.id, false});
    }
  }
}

/// No client any more, until it asks again.
void DdsClients::leave(const Guid& writer, DdsClient& client) {
  remember_held(writer, client);
  std::erase_if(gone_owners_, [&](const auto& each) { return !owns(each.second); });
  if (client.life != nullptr && owns(client.life->id)) leave_axes(writer, *client.life);
  end(client);
  client.unleased = false;
}

DdsClients::Clients::iterator DdsClients::forget(Clients::iterator client) {
  leave(client->first, client->second);
  return clients_.erase(client);
}

void DdsClients::on_time(Instant now) {
  if (now < deadline_) return;
  for (auto each = clients_.begin(); each != clients_.end();)
    each = each->second.returns_by <= now ? forget(each) : std::next(each);
  look_at_deadlines();
}

// While the link is down nobody can come back.
void DdsClients::look_at_deadlines() {
  deadline_ = kNever;
  if (!link_up_) return;
  for (const auto& [guid, client] : clients_) deadline_ = std::min(deadline_, client.returns_by);
}

}  // namespace axisgate::dds
