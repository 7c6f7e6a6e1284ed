// SPDX-License-Identifier: Apache-2.0
// What the drives of CanLine answer, and the faults in it.
#include "tests/simulated/can_line.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::uint32_t highest_standard_identifier = 0x7FF;
constexpr Time shortest_babble = std::chrono::microseconds(100);

CanBytes recorded(const BusFrame& frame) {
  CanBytes bytes = little_endian(frame.id, frame.extended ? 4 : 2);
  const CanView data = bytes_of(frame);
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

// CiA 301 section 7.2.4.3 and Keya's own protocol: a frame that names an object has its index in bytes 1 and 2, its sub
// in 3. Segments name none.
std::optional<DriveFaults::Spoilt> spoilt_by(const DriveFaults& faults, const BusFrame& frame) {
  constexpr std::uint8_t specifier = 0xE0, download = 0x20, upload = 0x40, block_upload = 0xA0, block_download = 0xC0;
  const std::uint8_t command = frame.data[0] & specifier;
  const bool write = command == download || command == block_download;
  if (frame.remote || frame.size < 4 || (!write && command != upload && command != block_upload)) return std::nullopt;
  return faults.spoilt({static_cast<std::uint16_t>(frame.data[1] | frame.data[2] << 8), frame.data[3]}, write);
}

}  // namespace

void CanLine::request_arrives(std::size_t position, const BusFrame& frame, std::uint64_t tag, Time at) {
  Slot& slot = slots_[position];
  take_output(position, at, nullptr);
  CanExchange exchange{tag, at, slot.node->node(), recorded(frame), {}, {}};
  const bool answerable = slot.node->wants_answer(frame);
  if (answerable && !frame.remote && owed_until_ > at) ++overlapping_;
  if (answerable && slot.faults.strikes(DriveFault::unresponsive, random_)) {
    journal_.record(std::move(exchange));
    return;
  }
  if (answerable && slot.faults.strikes(DriveFault::restart, random_)) {
    const bool acts = slot.faults.restart_acts ? *slot.faults.restart_acts : random_.chance(0.5);
    if (acts) slot.node->hear(frame, tag, at);
    journal_.record(std::move(exchange));
    restart(position, at);
    return;
  }
  std::optional<std::uint32_t> refusal;
  const bool may_refuse = slot.node->may_refuse(frame);
  if (may_refuse && slot.faults.strikes(DriveFault::exception, random_)) refusal = slot.faults.abort_code;
  const auto spoilt = answerable ? spoilt_by(slot.faults, frame) : std::nullopt;
  if (spoilt && (!spoilt->refused_with || !may_refuse)) {
    journal_.record(std::move(exchange));
    return;
  }
  if (spoilt) refusal = spoilt->refused_with;
  if (refusal) {
    answer(position, {tag, true, slot.node->refuse(frame, *refusal)}, at, &exchange);
  } else {
    slot.node->hear(frame, tag, at);
    take_output(position, at, &exchange);
  }
  journal_.record(std::move(exchange));
}

void CanLine::take_output(std::size_t position, Time at, CanExchange* exchange) {
  for (const CanOutput& output : slots_[position].node->take_output()) {
    if (!slots_[position].connected) continue;
    if (output.answer) {
      answer(position, output, at, exchange);
    } else {
      wait(at, position, output.tag, output.frame);
      const bool life = output.frame.id == slots_[position].node->life_sign({}).id;
      if (life && slots_[position].faults.strikes(DriveFault::heartbeat_twice, random_)) {
        wait(at, position, output.tag, output.frame);
      }
    }
  }
}

void CanLine::answer(std::size_t position, const CanOutput& output, Time at, CanExchange* exchange) {
  Slot& slot = slots_[position];
  BusFrame frame = output.frame;
  if (!frame.extended && !frame.remote && frame.id == cob::sdo_reply + slot.node->node()) {
    const CanView bytes = bytes_of(frame);
    frame = bus_frame(frame.id, slot.faults.sdo.spoil({bytes.begin(), bytes.end()}, random_));
  }
  const Time ready = std::max(at + options_.reply_delay, slot.free_at);
  const bool lost = slot.faults.strikes(DriveFault::lose, random_);
  const Time late = slot.faults.strikes(DriveFault::late, random_) ? slot.faults.late_by : Time{};
  if (slot.faults.strikes(DriveFault::wrong_station, random_)) {
    const std::uint32_t own = slot.node->node();
    frame.id = frame.id - own + own % highest_can_node + 1;
  }
  if (slot.faults.strikes(DriveFault::wrong_length, random_) && frame.size > 0) {
    frame.size = static_cast<std::uint8_t>(random_.below(frame.size));
    std::fill(frame.data.begin() + frame.size, frame.data.end(), std::uint8_t{0});
  }
  slot.free_at = ready + late;
  if (lost) return;
  const bool guarding = output.frame.id == slot.node->life_sign({}).id;
  if (!guarding && late == Time{}) owed_until_ = std::max(owed_until_, ready);
  if (exchange != nullptr) {
    if (exchange->sent.empty()) exchange->reply_ready = ready + late;
    const CanBytes bytes = recorded(frame);
    exchange->sent.insert(exchange->sent.end(), bytes.begin(), bytes.end());
  }
  wait(ready + late, position, output.tag, frame);
  if (slot.faults.strikes(DriveFault::duplicate, random_)) wait(ready + late, position, output.tag, frame);
}

void CanLine::babble(Time now) {
  for (std::size_t position = 0; position < slots_.size(); ++position) {
    Slot& slot = slots_[position];
    const bool storm = slot.faults.armed(DriveFault::emergencies);
    if ((!storm && !slot.faults.armed(DriveFault::babble)) || slot.next_babble > now) continue;
    slot.next_babble = now + std::max(slot.faults.babble_period, shortest_babble);
    if (!slot.connected) continue;
    if (storm && slot.faults.strikes(DriveFault::emergencies, random_)) {
      slot.node->announce_emergency(slot.faults.emergency_code, now);
      take_output(position, now, nullptr);
    }
    if (!slot.faults.strikes(DriveFault::babble, random_)) continue;
    CanBytes bytes(1 + random_.below(longest_can_frame));
    for (std::uint8_t& byte : bytes) byte = random_.byte();
    BusFrame frame = slot.node->life_sign(bytes);
    if (slot.faults.babble_id != 0) {
      frame.id = slot.faults.babble_id;
      frame.extended = frame.id > highest_standard_identifier;
    }
    wait(now, position, 0, frame);
  }
}

}  // namespace axisgate::simulated
