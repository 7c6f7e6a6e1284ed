// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/rtu_line.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace axisgate::simulated {
namespace {

constexpr int gap_in_tenths = 35;  // of a character
constexpr int highest_unit = 127;
constexpr int highest_id286pro = 254;

std::unique_ptr<RtuSlave> make(const KincoRtuDrive& options) { return std::make_unique<KincoRtu>(options); }
std::unique_ptr<RtuSlave> make(const Id286proOptions& options) { return std::make_unique<Id286pro>(options); }
std::unique_ptr<RtuSlave> make(const Em2rsOptions& options) { return std::make_unique<Em2rs>(options); }
std::unique_ptr<RtuSlave> make(const ZlacOptions& options) { return std::make_unique<Zlac8015d>(options); }
std::unique_ptr<RtuSlave> make(const InverterOptions& options) { return std::make_unique<Inverter>(options); }
std::unique_ptr<RtuSlave> make(const DirectDataOptions& options) { return std::make_unique<DirectData>(options); }

std::unique_ptr<RtuSlave> make_slave(const RtuDriveOptions& options) {
  return std::visit([](const auto& one) { return make(one); }, options);
}

}  // namespace

std::string describe(const RtuDriveOptions& options) { return make_slave(options)->describe(); }

std::uint8_t unit_of(const RtuDriveOptions& options) {
  const auto unit = [](const auto& one) {
    if constexpr (requires { one.unit; })
      return one.unit;
    else
      return one.drive.station;
  };
  return std::visit(unit, options);
}

RtuLine::RtuLine(const RtuLineOptions& options, Random random, ToHostSink sink)
    : ByteLine(options.baud, random, std::move(sink)),
      options_(options),
      gap_(options.frame_gap > Time{} ? options.frame_gap : byte_time(options.baud, gap_in_tenths) / 10),
      journal_(options.journal_capacity) {}

RtuSlave& RtuLine::add(const RtuDriveOptions& options) {
  const int highest = std::holds_alternative<Id286proOptions>(options) ? highest_id286pro : highest_unit;
  if (unit_of(options) < 1 || unit_of(options) > highest) {
    throw std::invalid_argument("unit " + std::to_string(unit_of(options)) + " is outside 1 to " +
                                std::to_string(highest));
  }
  Slot slot;
  slot.slave = make_slave(options);
  slot.slave->advance(now_);
  slots_.push_back(std::move(slot));
  count_one_more();
  return *slots_.back().slave;
}

KincoDrive* RtuLine::kinco(std::size_t position) {
  auto* found = dynamic_cast<KincoRtu*>(&slave(position));
  return found == nullptr ? nullptr : &found->drive();
}

Id286pro* RtuLine::id286pro(std::size_t position) { return dynamic_cast<Id286pro*>(&slave(position)); }
Em2rs* RtuLine::em2rs(std::size_t position) { return dynamic_cast<Em2rs*>(&slave(position)); }
Zlac8015d* RtuLine::zlac8015d(std::size_t position) { return dynamic_cast<Zlac8015d*>(&slave(position)); }

void RtuLine::cut() {
  ByteLine::cut();
  frame_end_.reset();
  for (Slot& slot : slots_) slot.receiver.forget();
}

std::optional<Time> RtuLine::next_event() const {
  std::optional<Time> next = ByteLine::next_event();
  // A byte that has begun before the silence was long enough is no silence.
  const bool begun = frame_end_ && !incoming_.empty() && incoming_.front().at - on_wire(1) < *frame_end_;
  if (frame_end_ && !begun) next = next ? std::min(*next, *frame_end_) : *frame_end_;
  return next;
}

void RtuLine::own_accord(Time at) {
  if (frame_end_ != at) return ByteLine::own_accord(at);
  frame_end_.reset();
  frame_ends(at);
}

void RtuLine::byte_arrives(std::uint8_t byte, Time at) {
  const Time silence = at - on_wire(1) - last_byte_;
  for (Slot& slot : slots_) {
    slot.slave->advance(at);
    if (slot.slave->listens()) {
      slot.receiver.receive(byte, silence, gap_ * slot.slave->longest_pause() / gap_in_tenths);
    } else {
      slot.receiver.forget();
    }
  }
  last_byte_ = at;
  frame_end_ = at + gap_;
}

void RtuLine::frame_ends(Time at) {
  for (std::size_t position = 0; position < slots_.size(); ++position) {
    RtuSlave& slave = *slots_[position].slave;
    slave.advance(at);
    const auto frame = slots_[position].receiver.end();
    if (!frame || !slave.listens()) continue;
    if (frame->unit == slave.unit() || slave.obeys_broadcast(frame->unit)) request_arrives(position, *frame, at);
  }
}

namespace {

std::uint16_t word_at(const RtuBytes& pdu, std::size_t at) {
  return at + 1 < pdu.size() ? static_cast<std::uint16_t>(pdu[at] << 8 | pdu[at + 1]) : std::uint16_t{0};
}

std::optional<DriveFaults::Spoilt> spoilt_by(const DriveFaults& faults, const RtuBytes& pdu) {
  const bool read = pdu[0] == function::read;
  const bool many = read || pdu[0] == function::write_several;
  return faults.spoilt({word_at(pdu, 1), 0}, !read, many ? std::max<std::uint16_t>(word_at(pdu, 3), 1) : 1);
}

}  // namespace

void RtuLine::request_arrives(std::size_t position, const RtuFrame& request, Time at) {
  Slot& slot = slots_[position];
  DriveFaults& with = faults(position);
  RtuExchange exchange{++tags_, at, slot.slave->unit(), seal_rtu(request.unit, request.pdu), {}, {}};
  const bool broadcast = request.unit != slot.slave->unit();
  if (with.strikes(DriveFault::unresponsive, random_)) {
    journal_.record(std::move(exchange));
    return;
  }
  if (with.strikes(DriveFault::restart, random_)) {
    const bool acts = with.restart_acts ? *with.restart_acts : random_.chance(0.5);
    if (acts) (void)slot.slave->answer(request.pdu, exchange.tag, at);
    restart(position, at);
    journal_.record(std::move(exchange));
    return;
  }
  std::optional<std::uint32_t> refusal;
  if (with.strikes(DriveFault::exception, random_)) refusal = with.exception_code;
  const auto spoilt = spoilt_by(with, request.pdu);
  if (spoilt && spoilt->refused_with) refusal = spoilt->refused_with;
  RtuBytes pdu = refusal ? slot.slave->refusal(request.pdu, static_cast<RtuException>(*refusal))
                         : slot.slave->answer(request.pdu, exchange.tag, at);
  const bool mute = spoilt && !spoilt->refused_with;
  if (!broadcast && !mute && !with.strikes(DriveFault::lose, random_)) reply(position, std::move(pdu), at, exchange);
  journal_.record(std::move(exchange));
}

void RtuLine::reply(std::size_t position, RtuBytes pdu, Time at, RtuExchange& exchange) {
  Slot& slot = slots_[position];
  DriveFaults& with = faults(position);
  const Time delay = options_.reply_delay.value_or(slot.slave->answer_delay());
  const Time late = with.strikes(DriveFault::late, random_) ? with.late_by : Time{};
  exchange.reply_ready = std::max({slot.free_at, at, last_byte_ + delay}) + late;
  const RtuBytes whole = seal_rtu(exchange.station, pdu);
  exchange.sent = distort_bytes(position, distort_frame(position, exchange.station, std::move(pdu)));
  slot.last_reply = whole;
  send(position, exchange.tag, exchange.reply_ready, exchange.sent);
  if (with.strikes(DriveFault::duplicate, random_)) send(position, exchange.tag, slot.free_at, exchange.sent);
}

RtuBytes RtuLine::distort_frame(std::size_t position, std::uint8_t unit, RtuBytes pdu) {
  DriveFaults& with = faults(position);
  if (with.strikes(DriveFault::wrong_station, random_)) unit = static_cast<std::uint8_t>(unit % 247 + 1);
  if (with.strikes(DriveFault::wrong_length, random_)) {
    const bool read = pdu[0] == function::read;
    if (read && pdu[1] > 2) {
      pdu.resize(pdu.size() - 2);
    } else {
      append_word(pdu, 0);
    }
    if (read) pdu[1] = static_cast<std::uint8_t>(pdu.size() - 2);
  }
  return seal_rtu(unit, pdu);
}

RtuBytes RtuLine::distort_bytes(std::size_t position, RtuBytes bytes) {
  spoil(position, bytes);
  if (faults(position).strikes(DriveFault::glued, random_)) {
    const RtuBytes& last = slots_[position].last_reply;
    const RtuBytes before = last.empty() ? bytes : last;
    bytes.insert(bytes.end(), before.begin(), before.end());
  }
  put_noise_around(position, bytes);
  return bytes;
}

void RtuLine::send(std::size_t position, std::uint64_t tag, Time ready, const RtuBytes& bytes) {
  Slot& slot = slots_[position];
  DriveFaults& with = faults(position);
  slot.free_at = ready + on_wire(bytes.size()) + gap_;
  if (bytes.size() < 2 || !with.strikes(DriveFault::split, random_)) {
    Chunk chunk{tag, ByteOrigin::reply, position, bytes};
    if (with.strikes(DriveFault::glitch, random_)) {
      const Time begins = outgoing_.send_behind_glitch(ready, std::move(chunk), with);
      slot.free_at += begins - ready + on_wire(with.glitch_bytes);
    } else {
      outgoing_.send(ready, std::move(chunk));
    }
    return;
  }
  const auto cut_at = static_cast<std::ptrdiff_t>(1 + random_.below(bytes.size() - 1));
  const Time second = ready + on_wire(static_cast<std::size_t>(cut_at)) + with.split_gap;
  outgoing_.send(ready, {tag, ByteOrigin::reply, position, {bytes.begin(), bytes.begin() + cut_at}});
  outgoing_.send(second, {tag, ByteOrigin::reply, position, {bytes.begin() + cut_at, bytes.end()}});
  slot.free_at += with.split_gap;
}

// Noise, or a whole frame: the acknowledgement of a write that nobody sent.
std::vector<std::uint8_t> RtuLine::babbled(std::size_t position) {
  RtuBytes bytes = ByteLine::babbled(position);
  if (!random_.chance(0.5)) return bytes;
  const auto at = static_cast<std::uint16_t>(random_.below(0x10000));
  return seal_rtu(slots_[position].slave->unit(), write_pdu(at, static_cast<std::uint16_t>(random_.below(0x10000))));
}

void RtuLine::restart(std::size_t position, Time now) {
  outgoing_.forget(position);
  slots_[position].receiver.forget();
  slots_[position].free_at = Time{};
  slots_[position].slave->restart(now);
}

}  // namespace axisgate::simulated
