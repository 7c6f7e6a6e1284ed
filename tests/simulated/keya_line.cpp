// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/keya_line.hpp"

#include <algorithm>
#include <stdexcept>

namespace axisgate::simulated {

KeyaLine::KeyaLine(const KeyaLineOptions& options, Random random, ToHostSink sink)
    : ByteLine(options.baud, random, std::move(sink)), options_(options), journal_(options.journal_capacity) {}

KeyaDrive& KeyaLine::add(const KeyaOptions& options) {
  if (options_.wiring == KeyaWiring::rs232 && !slots_.empty()) {
    throw std::invalid_argument("RS232 goes from point to point: one Keya on it");
  }
  Slot slot;
  slot.drive = std::make_unique<KeyaDrive>(options, interface_of(options_.wiring));
  slot.drive->advance(now_);
  slot.heartbeat = options_.wiring == KeyaWiring::rs232 ? options.heartbeat : Time{};
  slot.next_heartbeat = now_ + slot.heartbeat;
  slots_.push_back(std::move(slot));
  count_one_more();
  return *slots_.back().drive;
}

bool KeyaLine::has(DriveFault fault) const {
  switch (fault) {
    case DriveFault::wrong_length:
    case DriveFault::glued:
    case DriveFault::exception:
    case DriveFault::emergencies:
      return false;
    case DriveFault::wrong_station:
      return options_.wiring == KeyaWiring::rs485;
    case DriveFault::heartbeat_twice:
      return options_.wiring == KeyaWiring::rs232;
    default:
      return true;
  }
}

void KeyaLine::set_heartbeat(std::size_t position, Time period) {
  slots_.at(position).heartbeat = period;
  slots_[position].next_heartbeat = now_ + period;
}

void KeyaLine::cut() {
  ByteLine::cut();
  for (Slot& slot : slots_) slot.receiver.forget();
}

std::optional<Time> KeyaLine::next_event() const {
  std::optional<Time> next = ByteLine::next_event();
  for (const Slot& slot : slots_) {
    if (slot.heartbeat > Time{}) next = next ? std::min(*next, slot.next_heartbeat) : slot.next_heartbeat;
  }
  return next;
}

void KeyaLine::byte_arrives(std::uint8_t byte, Time at) {
  for (std::size_t position = 0; position < slots_.size(); ++position) {
    Slot& slot = slots_[position];
    slot.drive->advance(at);
    const auto frame = slot.receiver.receive(byte, at);
    if (frame && keya_hears(*slot.drive, options_.wiring, *frame)) request_arrives(position, *frame, at);
  }
}

void KeyaLine::request_arrives(std::size_t position, const KeyaFrame& request, Time at) {
  Slot& slot = slots_[position];
  DriveFaults& with = faults(position);
  KeyaExchange exchange{++tags_, at, slot.drive->options().node, {request.begin(), request.end()}, {}, {}};
  if (with.strikes(DriveFault::unresponsive, random_)) {
    journal_.record(std::move(exchange));
    return;
  }
  if (with.strikes(DriveFault::restart, random_)) {
    const bool acts = with.restart_acts ? *with.restart_acts : random_.chance(0.5);
    if (acts) (void)keya_answer(*slot.drive, options_.wiring, request, at);
    restart(position, at);
    journal_.record(std::move(exchange));
    return;
  }
  const auto answer = keya_answer(*slot.drive, options_.wiring, request, at);
  const auto query = keya_query(options_.wiring, request);  // the sheet knows no refusal here: silence it is
  const bool mute = query && with.spoilt({*query, 0}, false);
  if (answer && !mute && !with.strikes(DriveFault::lose, random_)) reply(position, *answer, at, exchange);
  journal_.record(std::move(exchange));
}

void KeyaLine::reply(std::size_t position, const KeyaFrame& frame, Time at, KeyaExchange& exchange) {
  Slot& slot = slots_[position];
  DriveFaults& with = faults(position);
  const bool late = with.strikes(DriveFault::late, random_);
  slot.free_at = std::max(slot.free_at, at + options_.reply_delay + (late ? with.late_by : Time{}));
  exchange.reply_ready = slot.free_at;
  exchange.sent = distort(position, frame);
  const bool twice = with.strikes(DriveFault::duplicate, random_);
  send_reply(position, exchange.tag, exchange.sent);
  if (twice) send_reply(position, exchange.tag, exchange.sent);
}

std::vector<std::uint8_t> KeyaLine::distort(std::size_t position, KeyaFrame reply) {
  if (options_.wiring == KeyaWiring::rs485 && faults(position).strikes(DriveFault::wrong_station, random_)) {
    reply[1] = static_cast<std::uint8_t>(reply[1] % 127 + 1);
    reply = seal_keya(reply);
  }
  std::vector<std::uint8_t> bytes(reply.begin(), reply.end());
  spoil(position, bytes);
  put_noise_around(position, bytes);
  return bytes;
}

void KeyaLine::send_reply(std::size_t position, std::uint64_t tag, const std::vector<std::uint8_t>& bytes) {
  Slot& slot = slots_[position];
  DriveFaults& with = faults(position);
  if (bytes.size() < 2 || !with.strikes(DriveFault::split, random_)) {
    Chunk chunk{tag, ByteOrigin::reply, position, bytes};
    if (with.strikes(DriveFault::glitch, random_)) {
      slot.split_from = slot.free_at;  // no heartbeat comes between the two
      slot.free_at = outgoing_.send_behind_glitch(slot.free_at, std::move(chunk), with);
      slot.split_until = slot.free_at;
    } else {
      outgoing_.send(slot.free_at, std::move(chunk));
    }
    return;
  }
  const auto cut_at = static_cast<std::ptrdiff_t>(1 + random_.below(bytes.size() - 1));
  outgoing_.send(slot.free_at, {tag, ByteOrigin::reply, position, {bytes.begin(), bytes.begin() + cut_at}});
  if (slot.free_at > slot.split_until) slot.split_from = slot.free_at;
  slot.free_at += byte_time(options_.baud, static_cast<std::size_t>(cut_at)) + with.split_gap;
  outgoing_.send(slot.free_at, {tag, ByteOrigin::reply, position, {bytes.begin() + cut_at, bytes.end()}});
  slot.split_until = slot.free_at;
}

// Heartbeats and noise.
void KeyaLine::own_accord(Time now) {
  for (std::size_t position = 0; position < slots_.size(); ++position) {
    Slot& slot = slots_[position];
    slot.drive->advance(now);
    if (slot.heartbeat > Time{} && slot.next_heartbeat <= now) {
      slot.next_heartbeat = now + slot.heartbeat;
      if (slot.drive->booting()) continue;
      const KeyaFrame frame = keya_heartbeat(*slot.drive);
      const int times = faults(position).strikes(DriveFault::heartbeat_twice, random_) ? 2 : 1;
      // What it has begun to say it says to the end; a reply that is only late does not hold the heartbeat back.
      const bool inside = slot.split_from <= now && now < slot.split_until;
      for (int i = 0; i < times; ++i) {
        outgoing_.send(inside ? slot.split_until : now, {0, ByteOrigin::noise, position, {frame.begin(), frame.end()}});
      }
    }
    babble(position, now);
  }
}

void KeyaLine::restart(std::size_t position, Time now) {
  outgoing_.forget(position);
  slots_[position].receiver.forget();
  slots_[position].free_at = Time{};
  slots_[position].drive->restart(now);
}

}  // namespace axisgate::simulated
