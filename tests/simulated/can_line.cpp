#include "tests/simulated/can_line.hpp"

#include <stdexcept>

namespace axisgate::simulated {
namespace {

constexpr int highest_node = 127;
constexpr std::uint8_t abort_command = 0x80;

CanBytes recorded(const BusFrame& frame) {
  CanBytes bytes = little_endian(frame.id, 2);
  const CanView data = bytes_of(frame);
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

// Lower wins: identifier, then data before remote, then who was first.
bool wins(const BusFrame& one, const BusFrame& other) {
  if (one.id != other.id) return one.id < other.id;
  return !one.remote && other.remote;
}

bool is_sdo_request(const BusFrame& frame) {
  return !frame.remote && frame.id > cob::sdo_request && frame.id < cob::error_control && frame.size > 0 &&
         frame.data[0] != abort_command;
}

}  // namespace

std::uint8_t node_of(const CanDriveOptions& options) {
  const auto* kinco = std::get_if<KincoCanDrive>(&options);
  return kinco != nullptr ? kinco->drive.station : std::get<LeadshineOptions>(options).node;
}

std::string describe(const CanDriveOptions& options) {
  const auto* kinco = std::get_if<KincoCanDrive>(&options);
  const std::string type = kinco != nullptr ? std::string(model_of(kinco->drive.type).name) : "ld2";
  return type + '@' + std::to_string(node_of(options));
}

std::unique_ptr<CanopenNode> make_can_node(const CanDriveOptions& options) {
  std::unique_ptr<CanDevice> device;
  CommunicationFacts facts;
  if (const auto* kinco = std::get_if<KincoCanDrive>(&options)) {
    device = std::make_unique<KincoCan>(*kinco);
    facts = communication_of(*kinco);
  } else {
    device = std::make_unique<LeadshineDrive>(std::get<LeadshineOptions>(options));
    facts = communication_of(std::get<LeadshineOptions>(options));
  }
  return std::make_unique<CanopenNode>(std::move(facts), node_of(options), std::move(device));
}

CanLine::CanLine(const CanLineOptions& options, Random random, CanToHostSink sink)
    : options_(options), random_(random), sink_(std::move(sink)), journal_(options.journal_capacity) {}

CanopenNode& CanLine::add(const CanDriveOptions& options) {
  const int number = node_of(options);
  if (number < 1 || number > highest_node) {
    throw std::invalid_argument("node " + std::to_string(number) + " is outside 1 to 127");
  }
  Slot slot{options, make_can_node(options), {}, true, {}, {}};
  slot.node->advance(now_);
  slots_.push_back(std::move(slot));
  return *slots_.back().node;
}

KincoDrive* CanLine::kinco(std::size_t position) {
  auto* found = dynamic_cast<KincoCan*>(&node(position).device());
  return found == nullptr ? nullptr : &found->drive();
}

LeadshineDrive* CanLine::leadshine(std::size_t position) {
  return dynamic_cast<LeadshineDrive*>(&node(position).device());
}

bool CanLine::has(DriveFault fault) const {
  switch (fault) {
    case DriveFault::mute:
    case DriveFault::late:
    case DriveFault::lose:
    case DriveFault::duplicate:
    case DriveFault::wrong_station:
    case DriveFault::wrong_length:
    case DriveFault::restart:
    case DriveFault::babble:
    case DriveFault::exception:
    case DriveFault::emergencies:
      return true;
    default:
      return false;  // the CRC of the bus lets none of them through
  }
}

std::size_t CanLine::add_twin(std::size_t position) {
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

void CanLine::note_overlap(const BusFrame& frame, Time at) {
  if (!is_sdo_request(frame)) return;
  if (owed_until_ > at) ++overlapping_;
}

void CanLine::request_arrives(std::size_t position, const BusFrame& frame, std::uint64_t tag, Time at) {
  Slot& slot = slots_[position];
  take_output(position, at, nullptr);
  note_overlap(frame, at);
  CanExchange exchange{tag, at, slot.node->node(), recorded(frame), {}, {}};
  const bool answerable = frame.remote || is_sdo_request(frame);
  if (answerable && slot.faults.strikes(DriveFault::mute, random_)) {
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
  const bool talks = slot.node->state() != NmtState::stopped && slot.node->state() != NmtState::initialising;
  if (is_sdo_request(frame) && talks && slot.faults.strikes(DriveFault::exception, random_)) {
    const CanBytes refused = slot.node->server().refusal(bytes_of(frame), slot.faults.abort_code);
    slot.node->server().reset();
    answer(position, {tag, true, bus_frame(cob::sdo_reply + slot.node->node(), refused)}, at, &exchange);
  } else {
    slot.node->hear(frame, tag, at);
    take_output(position, at, &exchange);
  }
  journal_.record(std::move(exchange));
}

void CanLine::take_output(std::size_t position, Time at, CanExchange* exchange) {
  for (const CanopenNode::Output& output : slots_[position].node->take_output()) {
    if (!slots_[position].connected) continue;
    if (output.answer) {
      answer(position, output, at, exchange);
    } else {
      wait(at, position, output.tag, output.frame);
    }
  }
}

void CanLine::answer(std::size_t position, const CanopenNode::Output& output, Time at, CanExchange* exchange) {
  Slot& slot = slots_[position];
  BusFrame frame = output.frame;
  const Time ready = std::max(at + options_.reply_delay, slot.free_at);
  const bool lost = slot.faults.strikes(DriveFault::lose, random_);
  const Time late = slot.faults.strikes(DriveFault::late, random_) ? slot.faults.late_by : Time{};
  if (slot.faults.strikes(DriveFault::wrong_station, random_)) {
    const std::uint32_t own = slot.node->node();
    frame.id = frame.id - own + own % highest_node + 1;
  }
  if (slot.faults.strikes(DriveFault::wrong_length, random_) && frame.size > 0) {
    frame.size = static_cast<std::uint8_t>(random_.below(frame.size));
    std::fill(frame.data.begin() + frame.size, frame.data.end(), std::uint8_t{0});
  }
  slot.free_at = ready + late;
  if (lost) return;
  if (late == Time{}) owed_until_ = std::max(owed_until_, ready);
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
    slot.next_babble = now + std::max(slot.faults.babble_period, Time(std::chrono::microseconds(100)));
    if (!slot.connected) continue;
    if (storm && slot.faults.strikes(DriveFault::emergencies, random_)) {
      slot.node->announce_emergency(slot.faults.emergency_code, now);
      take_output(position, now, nullptr);
    }
    if (!slot.faults.strikes(DriveFault::babble, random_)) continue;
    const std::uint32_t id =
        slot.faults.babble_id != 0 ? slot.faults.babble_id : cob::error_control + slot.node->node();
    CanBytes bytes(1 + random_.below(longest_can_frame));
    for (std::uint8_t& byte : bytes) byte = random_.byte();
    wait(now, position, 0, bus_frame(id, bytes));
  }
}

}  // namespace axisgate::simulated
