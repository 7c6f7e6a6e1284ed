// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/serial_line.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace axisgate::simulated {

SerialLine::SerialLine(const LineOptions& options, Random random, Sink sink)
    : ByteLine(options.baud, random, std::move(sink)), options_(options), journal_(options.journal_capacity) {}

KincoDrive& SerialLine::add(const DriveOptions& options) {
  const KincoModel& model = model_of(options.type);
  if (options_.wiring == Wiring::rs485 && !model.rs485_speaks_this_protocol) {
    throw std::invalid_argument("a Kinco " + std::string(model.name) + " speaks Modbus RTU on RS485: use RS232");
  }
  if (options.station < 1 || options.station > 127) {
    throw std::invalid_argument("station " + std::to_string(options.station) + " is outside 1 to 127");
  }
  Slot slot;
  slot.drive = std::make_unique<KincoDrive>(options);
  slot.drive->advance(now_);
  slots_.push_back(std::move(slot));
  count_one_more();
  return *slots_.back().drive;
}

bool SerialLine::has(DriveFault fault) const {
  return fault != DriveFault::half && fault != DriveFault::wrong_length && fault != DriveFault::exception &&
         fault != DriveFault::glued && fault != DriveFault::emergencies && fault != DriveFault::heartbeat_twice;
}

bool SerialLine::passes_on(const Slot& slot) const {
  return options_.wiring == Wiring::rs485 || (!slot.drive->booting() && slot.drive->cascade());
}

bool SerialLine::hears(std::size_t position) const {
  const Slot& slot = slots_[position];
  if (slot.drive->booting()) return false;
  if (options_.wiring == Wiring::rs485) return slot.drive->rs485_speaks_kinco();
  if (options_.check_baud && slot.drive->rs232_baud() != options_.baud) return false;
  return std::all_of(slots_.begin(), slots_.begin() + static_cast<std::ptrdiff_t>(position),
                     [this](const Slot& before) { return passes_on(before); });
}

bool SerialLine::reaches_host(std::size_t position) const {
  return std::all_of(slots_.begin() + static_cast<std::ptrdiff_t>(position) + 1, slots_.end(),
                     [this](const Slot& after) { return passes_on(after); });
}

void SerialLine::byte_arrives(std::uint8_t byte, Time at) {
  for (Slot& slot : slots_) slot.drive->advance(at);
  if (options_.wiring == Wiring::rs232 && !slots_.empty() &&
      std::all_of(slots_.begin(), slots_.end(), [this](const Slot& slot) { return passes_on(slot); })) {
    echo_.push_back(byte);
  }
  for (std::size_t position = 0; position < slots_.size(); ++position) {
    if (!hears(position)) {
      slots_[position].receiver.forget();
      continue;
    }
    const auto request = slots_[position].receiver.receive(byte, at);
    // A frame for another station, or one with a wrong sum, meets silence (JD 2.1, MD 2.2).
    if (!request || station_of(*request) != slots_[position].drive->station()) continue;
    flush_echo(at);
    request_arrives(position, *request, at);
  }
  if (incoming_.empty() || incoming_.front().at != at) flush_echo(at);
}

void SerialLine::flush_echo(Time at) {
  if (echo_.empty()) return;
  outgoing_.send(at, {0, ByteOrigin::echo, slots_.size(), std::exchange(echo_, {})});
}

void SerialLine::request_arrives(std::size_t position, const TenByteFrame& request, Time at) {
  Slot& slot = slots_[position];
  DriveFaults& with = faults(position);
  Exchange exchange{++tags_, at, slot.drive->station(), request, {}, {}};
  if (with.strikes(DriveFault::unresponsive, random_)) {
    journal_.record(std::move(exchange));
    return;
  }
  if (with.strikes(DriveFault::restart, random_)) {
    if (random_.chance(0.5)) (void)slot.drive->answer(request, exchange.tag, at);
    restart(position, at);
    journal_.record(std::move(exchange));
    return;
  }
  const bool write = command_of(request) != FrameCommand::read;
  const auto spoilt = with.spoilt({index_of(request), sub_of(request)}, write);
  auto reply = slot.drive->answer(request, exchange.tag, at);
  if (spoilt && spoilt->refused_with) {
    reply = seal(slot.drive->station(), FrameCommand::error, index_of(request), sub_of(request), *spoilt->refused_with);
  } else if (spoilt) {
    reply.reset();
  }
  const bool lost = with.strikes(DriveFault::lose, random_);
  if (reply && !lost) {
    const bool late = with.strikes(DriveFault::late, random_);
    slot.reply_ready = std::max(slot.reply_ready, at + options_.reply_delay + (late ? with.late_by : Time{}));
    exchange.reply_ready = slot.reply_ready;
    exchange.sent = distort(position, *reply);
    const bool twice = with.strikes(DriveFault::duplicate, random_);
    send_reply(position, exchange.tag, slot.reply_ready, exchange.sent);
    if (twice) send_reply(position, exchange.tag, slot.reply_ready, exchange.sent);
  }
  journal_.record(std::move(exchange));
}

std::vector<std::uint8_t> SerialLine::distort(std::size_t position, TenByteFrame reply) {
  if (faults(position).strikes(DriveFault::wrong_station, random_)) {
    const auto other = static_cast<std::uint8_t>(station_of(reply) % 127 + 1);
    reply = seal(other, command_of(reply), index_of(reply), sub_of(reply), data_of(reply));
  }
  std::vector<std::uint8_t> bytes(reply.begin(), reply.end());
  spoil(position, bytes);
  put_noise_around(position, bytes);
  return bytes;
}

void SerialLine::send_reply(std::size_t position, std::uint64_t tag, Time ready, std::vector<std::uint8_t> bytes) {
  Slot& slot = slots_[position];
  DriveFaults& with = faults(position);
  if (!reaches_host(position)) return;  // a drive further down the chain does not pass it on
  if (with.strikes(DriveFault::split, random_)) {
    const auto cut_at = static_cast<std::ptrdiff_t>(1 + random_.below(bytes.size() - 1));
    outgoing_.send(ready, {tag, ByteOrigin::reply, position, {bytes.begin(), bytes.begin() + cut_at}});
    slot.reply_ready = ready + with.split_gap;
    outgoing_.send(slot.reply_ready, {tag, ByteOrigin::reply, position, {bytes.begin() + cut_at, bytes.end()}});
    return;
  }
  Chunk chunk{tag, ByteOrigin::reply, position, std::move(bytes)};
  if (with.strikes(DriveFault::glitch, random_)) {
    slot.reply_ready = outgoing_.send_behind_glitch(ready, std::move(chunk), with);
  } else {
    outgoing_.send(ready, std::move(chunk));
  }
}

void SerialLine::restart(std::size_t position, Time now) {
  outgoing_.forget(position);
  slots_[position].receiver.forget();
  slots_[position].drive->restart(now);
}

}  // namespace axisgate::simulated
