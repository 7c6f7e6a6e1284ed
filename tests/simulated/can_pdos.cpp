// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/can_pdos.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::size_t predefined = 4;
constexpr std::uint32_t without_identifier = 0x80000000;
constexpr std::uint8_t last_synchronous = 240;

std::size_t bytes_in(std::uint32_t entry) { return (entry & 0xFFU) / 8; }
ObjectKey object_in(std::uint32_t entry) {
  return {static_cast<std::uint16_t>(entry >> 16), static_cast<std::uint8_t>(entry >> 8)};
}

}  // namespace

CanPdos::CanPdos(const PdoFacts& facts, std::uint8_t node) : facts_(facts) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(facts.count); ++i) {
    const auto offset = static_cast<std::uint32_t>(i) * cob::next_pdo + node;
    Pdo pdo;
    pdo.type = facts.type;
    pdo.cob_id = i < predefined ? cob::first_rpdo + offset : without_identifier;
    settings_.receive.push_back(pdo);
    deliver(settings_.receive.back(), facts.receive, i);
    pdo.cob_id = i < predefined ? cob::first_tpdo + offset : without_identifier;
    settings_.transmit.push_back(pdo);
    deliver(settings_.transmit.back(), facts.transmit, i);
  }
  stored_ = settings_;
  sending_.resize(settings_.transmit.size());
}

void CanPdos::deliver(Pdo& pdo, const std::vector<PdoFacts::Delivered>& facts, std::size_t number) {
  if (number >= facts.size()) return;
  pdo.event = facts[number].event;
  pdo.mapped = facts[number].mapped;
  std::copy(facts[number].map.begin(), facts[number].map.end(), pdo.map.begin());
}

std::optional<CanPdos::Place> CanPdos::place_of(ObjectKey key) const {
  const std::size_t number = key.index & 0x1FFU;
  const auto base = static_cast<std::uint16_t>(key.index & ~0x1FFU);
  if (number >= settings_.transmit.size()) return std::nullopt;
  if (base != 0x1400 && base != 0x1600 && base != 0x1800 && base != 0x1A00) return std::nullopt;
  return Place{base >= 0x1800, base == 0x1600 || base == 0x1A00, number};
}

bool CanPdos::has(ObjectKey key) const { return place_of(key).has_value(); }

const CanPdos::Pdo& CanPdos::pdo_at(const Place& place) const {
  return (place.transmit ? settings_.transmit : settings_.receive).at(place.number);
}

ObjectReply CanPdos::read(ObjectKey key) const {
  const Place place = *place_of(key);
  const Pdo& pdo = pdo_at(place);
  if (place.mapping) {
    if (key.sub == 0) return {0, {pdo.mapped}};
    if (key.sub > facts_.entries) return {sdo_abort::no_such_sub};
    return {0, little_endian(pdo.map[key.sub - 1U], 4)};
  }
  const bool timer = has_timers(place);
  switch (key.sub) {
    case 0:
      return {0, {static_cast<std::uint8_t>(timer ? 5 : place.transmit ? 3 : 2)}};
    case 1:
      return {0, little_endian(pdo.cob_id, 4)};
    case 2:
      return {0, {pdo.type}};
    case 3:
      if (place.transmit || timer) return {0, little_endian(pdo.inhibit, 2)};
      break;
    case 4:
      if (facts_.compatibility) return {0, {pdo.reserved}};
      break;
    case 5:
      if (timer) return {0, little_endian(pdo.event, 2)};
      break;
    default:
      break;
  }
  return {sdo_abort::no_such_sub};
}

std::uint32_t CanPdos::write(ObjectKey key, CanView bytes, bool preoperational, CanDevice& device, Time now) {
  const ObjectReply present = read(key);
  if (present.abort != 0) return present.abort;
  if (bytes.size() != present.bytes.size()) return abort_of(Refusal::wrong_width);
  const Place place = *place_of(key);
  Pdo& pdo = (place.transmit ? settings_.transmit : settings_.receive).at(place.number);
  if (!place.mapping) return write_parameter(pdo, place, key.sub, little_endian(bytes), bytes.size());
  if (!preoperational || (pdo.valid() && !facts_.free_mapping)) return abort_of(Refusal::device_state);
  return write_mapping(pdo, place, key.sub, little_endian(bytes), device, now);
}

std::uint32_t CanPdos::write_parameter(Pdo& pdo, const Place& place, std::uint8_t sub, std::uint32_t value,
                                       std::size_t size) {
  if (sub == 0) return abort_of(Refusal::read_only);
  if (sub == 1) {
    const bool on = (value & 0x80000000U) == 0;
    const std::uint32_t id = value & 0x7FFU;
    const bool reserved = id <= 0x100 || (id >= 0x580 && id < 0x680) || id > 0x6DF;
    if ((value & 0x20000000U) != 0 || (on && reserved)) return abort_of(Refusal::value_range);
    // The identifier changes only while the PDO is off.
    if (pdo.valid() && on && id != pdo.id()) return abort_of(Refusal::device_state);
    pdo.cob_id = value;
  } else if (sub == 2) {
    const bool refused = (value > last_synchronous && value < 252) || (value == 254 && !facts_.takes_type_254);
    if (refused || (!place.transmit && (value == 252 || value == 253))) return abort_of(Refusal::value_range);
    pdo.type = static_cast<std::uint8_t>(value);
  } else if (sub == 3) {
    pdo.inhibit = static_cast<std::uint16_t>(value);
  } else if (sub == 4) {
    pdo.reserved = static_cast<std::uint8_t>(value);
  } else {
    pdo.event = static_cast<std::uint16_t>(value);
  }
  if (place.transmit && size > 0) sending_[place.number] = {};
  return 0;
}

std::uint32_t CanPdos::write_mapping(Pdo& pdo, const Place& place, std::uint8_t sub, std::uint32_t value,
                                     CanDevice& device, Time now) {
  if (sub == 0) {
    if (value > facts_.entries) return abort_of(Refusal::value_range);
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < value; ++i) {
      if (pdo.map[i] == 0) return abort_of(Refusal::no_such_object);
      bytes += bytes_in(pdo.map[i]);
    }
    if (bytes > longest_can_frame) return sdo_abort::mapping_too_long;
    pdo.mapped = static_cast<std::uint8_t>(value);
    return 0;
  }
  if (pdo.mapped != 0 && !facts_.free_mapping) return abort_of(Refusal::device_state);
  if (value != 0) {
    const ObjectKey key = object_in(value);
    const ObjectReply found = device.read(key, now);
    if (found.abort != 0) return found.abort;
    const auto direction = place.transmit ? PdoDirection::from_drive : PdoDirection::to_drive;
    if (!device.may_be_mapped(key, direction)) return sdo_abort::no_mapping;
    if ((value & 0xFFU) != 8 * found.bytes.size()) return sdo_abort::no_mapping;
  }
  pdo.map[sub - 1U] = value;
  return 0;
}

BusFrame CanPdos::frame_of(const Pdo& pdo, CanDevice& device, Time now) {
  BusFrame frame;
  frame.id = pdo.id();
  for (std::size_t i = 0; i < pdo.mapped; ++i) {
    const auto value = device.mapped(object_in(pdo.map[i]), now);
    for (std::size_t byte = 0; value && byte < bytes_in(pdo.map[i]); ++byte) {
      frame.data.at(frame.size++) = static_cast<std::uint8_t>(*value >> (8 * byte));
    }
  }
  return frame;
}

void CanPdos::put_values(const Pdo& pdo, CanView bytes, CanDevice& device, std::uint64_t tag, Time now) {
  for (std::size_t i = 0; i < pdo.mapped; ++i) {
    const std::size_t size = bytes_in(pdo.map[i]);
    if (bytes.size() < size) return;
    (void)device.write(object_in(pdo.map[i]), bytes.first(size), tag, now);
    bytes = bytes.subspan(size);
  }
}

void CanPdos::start(Time now) {
  running_ = true;
  looked_ = now - one_millisecond;
  for (Sending& sending : sending_) {
    sending = {};
    sending.at = now;
  }
  waiting_.clear();
}

BusFrame CanPdos::send(std::size_t number, const BusFrame& frame, Time now) {
  Sending& sending = sending_[number];
  sending.last = frame;
  sending.sent = true;
  sending.at = now;
  return frame;
}

std::vector<BusFrame> CanPdos::due(CanDevice& device, Time now) {
  std::vector<BusFrame> frames;
  if (!running_) return frames;
  const bool looks = facts_.on_change && now / one_millisecond != looked_ / one_millisecond;
  if (looks) looked_ = now;
  for (std::size_t number = 0; number < sending_.size(); ++number) {
    const Pdo& pdo = settings_.transmit[number];
    const Sending& sending = sending_[number];
    if (!by_event(pdo)) continue;
    // The event timer outranks the inhibit time (MD 4.4).
    const bool timer = pdo.event != 0 && now - sending.at >= pdo.event * one_millisecond;
    const bool inhibited = sending.sent && now - sending.at < pdo.inhibit * facts_.inhibit_unit;
    if (!timer && (inhibited || !looks)) continue;  // whatever it holds
    const BusFrame frame = frame_of(pdo, device, now);
    if (timer || !sending.sent || frame != sending.last) frames.push_back(send(number, frame, now));
  }
  return frames;
}

std::vector<BusFrame> CanPdos::sync(CanDevice& device, std::uint64_t tag, Time now) {
  std::vector<BusFrame> frames;
  if (!running_) return frames;
  for (const Waiting& waiting : waiting_)
    put_values(settings_.receive[waiting.number], waiting.bytes, device, tag, now);
  waiting_.clear();
  for (std::size_t number = 0; number < sending_.size(); ++number) {
    const Pdo& pdo = settings_.transmit[number];
    Sending& sending = sending_[number];
    if (!pdo.valid() || pdo.mapped == 0 || pdo.type > last_synchronous) continue;
    const BusFrame frame = frame_of(pdo, device, now);
    const bool turn = pdo.type == 0 ? !sending.sent || frame != sending.last : ++sending.syncs >= pdo.type;
    if (!turn) continue;
    sending.syncs = 0;
    frames.push_back(send(number, frame, now));
  }
  return frames;
}

std::optional<BusFrame> CanPdos::asked_for(std::uint32_t id, CanDevice& device, Time now) {
  if (!running_) return std::nullopt;
  for (std::size_t number = 0; number < sending_.size(); ++number) {
    const Pdo& pdo = settings_.transmit[number];
    if (!pdo.valid() || pdo.mapped == 0 || pdo.id() != id || (pdo.cob_id & 0x40000000U) != 0) continue;
    return send(number, frame_of(pdo, device, now), now);
  }
  return std::nullopt;
}

bool CanPdos::take(const BusFrame& frame, CanDevice& device, std::uint64_t tag, Time now) {
  if (!running_ || frame.remote) return false;
  for (std::size_t number = 0; number < settings_.receive.size(); ++number) {
    const Pdo& pdo = settings_.receive[number];
    if (!pdo.valid() || pdo.id() != frame.id || pdo.mapped == 0) continue;
    std::size_t needed = 0;
    for (std::size_t i = 0; i < pdo.mapped; ++i) needed += bytes_in(pdo.map[i]);
    if (frame.size < needed) return true;
    const CanView bytes = bytes_of(frame);
    if (pdo.type <= last_synchronous) {
      std::erase_if(waiting_, [number](const Waiting& waiting) { return waiting.number == number; });
      waiting_.push_back({number, {bytes.begin(), bytes.end()}});
    } else {
      put_values(pdo, bytes, device, tag, now);
    }
    return true;
  }
  return false;
}

std::optional<Time> CanPdos::next_look(Time now) const {
  if (!running_ || !std::ranges::any_of(settings_.transmit, [this](const Pdo& pdo) { return by_event(pdo); })) {
    return std::nullopt;
  }
  return (now / one_millisecond + 1) * one_millisecond;
}

}  // namespace axisgate::simulated
