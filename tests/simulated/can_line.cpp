// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/can_line.hpp"

#include <stdexcept>

namespace axisgate::simulated {
namespace {

// The bits of arbitration as a number: 11 of the identifier, then that it is extended, then the other 18.
std::uint64_t rank(const BusFrame& frame) {
  constexpr unsigned rest = 18;
  if (!frame.extended) return std::uint64_t{frame.id} << (rest + 1);
  return std::uint64_t{frame.id >> rest} << (rest + 1) | 1U << rest | (frame.id & ((1U << rest) - 1));
}

// Lower wins: identifier, then data before remote, then who was first.
bool wins(const BusFrame& one, const BusFrame& other) {
  if (rank(one) != rank(other)) return rank(one) < rank(other);
  return !one.remote && other.remote;
}

}  // namespace

std::uint8_t node_of(const CanDriveOptions& options) {
  if (const auto* kinco = std::get_if<KincoCanDrive>(&options)) return kinco->drive.station;
  if (const auto* keya = std::get_if<KeyaCanDrive>(&options)) return keya->drive.node;
  if (const auto* keya = std::get_if<KeyaCanopenDrive>(&options)) return keya->drive.node;
  if (const auto* eds = std::get_if<EdsDriveOptions>(&options)) return eds->node;
  return std::get<LeadshineOptions>(options).node;
}

std::string describe(const CanDriveOptions& options) {
  std::string type = "ld2";
  if (const auto* kinco = std::get_if<KincoCanDrive>(&options)) type = model_of(kinco->drive.type).name;
  if (std::holds_alternative<KeyaCanDrive>(options)) type = "keya-can";
  if (std::holds_alternative<KeyaCanopenDrive>(options)) type = "keya-kydas4860-2e";
  if (const auto* eds = std::get_if<EdsDriveOptions>(&options)) type = eds->type->name;
  return type + '@' + std::to_string(node_of(options));
}

std::unique_ptr<CanopenNode> make_can_node(const CanDriveOptions& options) {
  std::unique_ptr<CanDevice> device;
  CommunicationFacts facts;
  if (const auto* kinco = std::get_if<KincoCanDrive>(&options)) {
    device = std::make_unique<KincoCan>(*kinco);
    facts = communication_of(*kinco);
  } else if (const auto* keya = std::get_if<KeyaCanopenDrive>(&options)) {
    device = std::make_unique<KeyaCanopen>(keya->drive);
    facts = communication_of(*keya);
  } else if (const auto* eds = std::get_if<EdsDriveOptions>(&options)) {
    device = std::make_unique<EdsDrive>(*eds);
    facts = communication_of(*eds);
  } else if (std::holds_alternative<KeyaCanDrive>(options)) {
    throw std::invalid_argument(describe(options) + " speaks no CANopen");
  } else {
    device = std::make_unique<LeadshineDrive>(std::get<LeadshineOptions>(options));
    facts = communication_of(std::get<LeadshineOptions>(options));
  }
  return std::make_unique<CanopenNode>(std::move(facts), node_of(options), std::move(device));
}

CanLine::CanLine(const CanLineOptions& options, Random random, CanToHostSink sink)
    : options_(options), random_(random), sink_(std::move(sink)), journal_(options.journal_capacity) {}

CanNode& CanLine::add(const CanDriveOptions& options) {
  const int number = node_of(options);
  if (number < 1 || number > highest_can_node) {
    throw std::invalid_argument("node " + std::to_string(number) + " is outside 1 to 127");
  }
  std::unique_ptr<CanNode> node;
  if (const auto* keya = std::get_if<KeyaCanDrive>(&options)) {
    node = std::make_unique<KeyaCan>(keya->drive);
  } else {
    node = make_can_node(options);
  }
  Slot slot{options, std::move(node), {}, true, {}, {}};
  slot.node->advance(now_);
  slots_.push_back(std::move(slot));
  return *slots_.back().node;
}

CanopenNode* CanLine::canopen(std::size_t position) { return dynamic_cast<CanopenNode*>(&any_node(position)); }

CanopenNode& CanLine::node(std::size_t position) {
  CanopenNode* found = canopen(position);
  if (found == nullptr) throw std::invalid_argument("the drive there speaks no CANopen");
  return *found;
}

KincoDrive* CanLine::kinco(std::size_t position) {
  CanopenNode* node = canopen(position);
  auto* found = node == nullptr ? nullptr : dynamic_cast<KincoCan*>(&node->device());
  return found == nullptr ? nullptr : &found->drive();
}

LeadshineDrive* CanLine::leadshine(std::size_t position) {
  CanopenNode* node = canopen(position);
  return node == nullptr ? nullptr : dynamic_cast<LeadshineDrive*>(&node->device());
}

EdsDrive* CanLine::eds_drive(std::size_t position) {
  CanopenNode* node = canopen(position);
  return node == nullptr ? nullptr : dynamic_cast<EdsDrive*>(&node->device());
}

KeyaDrive* CanLine::keya(std::size_t position) {
  if (auto* found = dynamic_cast<KeyaCan*>(&any_node(position))) return &found->drive();
  CanopenNode* node = canopen(position);
  auto* found = node == nullptr ? nullptr : dynamic_cast<KeyaCanopen*>(&node->device());
  return found == nullptr ? nullptr : &found->drive();
}

bool CanLine::has(DriveFault fault) const {
  switch (fault) {
    case DriveFault::unresponsive:
    case DriveFault::late:
    case DriveFault::lose:
    case DriveFault::duplicate:
    case DriveFault::wrong_station:
    case DriveFault::wrong_length:
    case DriveFault::restart:
    case DriveFault::babble:
    case DriveFault::exception:
    case DriveFault::emergencies:
    case DriveFault::heartbeat_twice:
      return true;
    default:
      return false;  // the CRC of the bus lets none of them through
  }
}

std::size_t CanLine::add_duplicate(std::size_t position) {
  (void)add(CanDriveOptions(slots_.at(position).options));
  return slots_.size() - 1;
}

void CanLine::connect(std::size_t position, bool connected) {
  slots_.at(position).connected = connected;
  if (!connected) std::erase_if(waiting_, [position](const Waiting& it) { return it.from == position; });
}

void CanLine::set_bus_off(bool off) {
  bus_off_ = off;
  if (off) std::erase_if(waiting_, [](const Waiting& it) { return it.from == host; });
}

void CanLine::cut() {
  waiting_.clear();
  on_wire_.reset();
}

void CanLine::restart(std::size_t position, Time now) {
  std::erase_if(waiting_, [position](const Waiting& it) { return it.from == position; });
  slots_.at(position).free_at = Time{};
  slots_[position].node->restart(now);
  take_output(position, now, nullptr);
}

void CanLine::wait(Time ready, std::size_t from, std::uint64_t tag, const BusFrame& frame) {
  waiting_.push_back({ready, ++order_, from, tag, frame});
}

void CanLine::from_host(const BusFrame& frame, Time now) {
  advance(now);
  if (bus_off_) return;
  wait(now, host, ++tags_, frame);
  advance(now);
}

void CanLine::send_emergency(std::size_t position, std::uint16_t code, Time now) {
  slots_.at(position).node->announce_emergency(code, now);
  take_output(position, now, nullptr);
}

std::optional<Time> CanLine::next_start() const {
  std::optional<Time> next;
  for (const Waiting& it : waiting_) {
    const Time at = std::max(it.ready, wire_free_);
    next = next ? std::min(*next, at) : at;
  }
  return next;
}

std::optional<Time> CanLine::next_event() const {
  std::optional<Time> next = on_wire_ ? std::optional(on_wire_->end) : next_start();
  const auto consider = [&next](Time at) { next = next ? std::min(*next, at) : at; };
  for (const Slot& slot : slots_) {
    if (const auto event = slot.node->next_event()) consider(std::max(*event, now_));
    const bool talks = slot.faults.armed(DriveFault::babble) || slot.faults.armed(DriveFault::emergencies);
    if (talks) consider(std::max(slot.next_babble, now_));
  }
  return next;
}

void CanLine::advance(Time now) {
  // Of one time: a frame that arrives first, then what the drives do by themselves, then the next one on the wire.
  for (;;) {
    const auto next = next_event();
    if (!next || *next > now) break;
    now_ = std::max(now_, *next);
    if (on_wire_ && on_wire_->end <= now_) {
      const OnWire arrived = *std::exchange(on_wire_, std::nullopt);
      arrive(arrived.what, arrived.end);
      continue;
    }
    for (std::size_t position = 0; position < slots_.size(); ++position) {
      slots_[position].node->advance(now_);
      take_output(position, now_, nullptr);
    }
    babble(now_);
    if (!on_wire_ && winner(now_)) start(now_);
  }
  now_ = std::max(now_, now);
  for (std::size_t position = 0; position < slots_.size(); ++position) {
    Slot& slot = slots_[position];
    slot.node->advance(now_);
    take_output(position, now_, nullptr);
    const bool talks = slot.faults.armed(DriveFault::babble) || slot.faults.armed(DriveFault::emergencies);
    if (!talks) slot.next_babble = now_ + slot.faults.babble_period;
  }
  if (!on_wire_ && winner(now_)) advance(now);  // what was sent just now
}

std::optional<std::size_t> CanLine::winner(Time at) const {
  std::optional<std::size_t> best;
  if (wire_free_ > at) return best;
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    if (waiting_[i].ready > at) continue;
    const bool same_sender = best && waiting_[i].from == waiting_[*best].from && waiting_[i].from == host;
    // A controller sends its own frames in the order it was given them.
    if (!best || (!same_sender && wins(waiting_[i].frame, waiting_[*best].frame))) best = i;
  }
  return best;
}

void CanLine::start(Time at) {
  const auto best = static_cast<std::ptrdiff_t>(*winner(at));
  const Waiting what = waiting_[static_cast<std::size_t>(best)];
  waiting_.erase(waiting_.begin() + best);
  wire_free_ = at + frame_time(what.frame, options_.bit_rate);
  on_wire_ = OnWire{wire_free_, what};
}

void CanLine::arrive(const Waiting& what, Time at) {
  for (std::size_t position = 0; position < slots_.size(); ++position) {
    if (position != what.from) hear(position, what.frame, what.tag, at);
  }
  if (what.from == host || bus_off_) return;
  CanToHost told;
  told.at = at;
  told.frame = what.frame;
  told.tag = what.tag;
  told.position = what.from;
  sink_(told);
}

void CanLine::hear(std::size_t position, const BusFrame& frame, std::uint64_t tag, Time at) {
  Slot& slot = slots_[position];
  slot.node->advance(at);
  if (!slot.connected) return;
  if (slot.node->is_request(frame)) {
    request_arrives(position, frame, tag, at);
    return;
  }
  slot.node->hear(frame, tag, at);
  take_output(position, at, nullptr);
}

}  // namespace axisgate::simulated
