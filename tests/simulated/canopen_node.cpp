// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/canopen_node.hpp"

#include <utility>

namespace axisgate::simulated {
namespace {

constexpr ObjectKey guard_time{0x100C, 0};
constexpr ObjectKey life_factor{0x100D, 0};
constexpr ObjectKey sync_id{0x1005, 0};
constexpr ObjectKey emergency_id{0x1014, 0};
constexpr ObjectKey loss_reaction{0x6007, 0};
constexpr std::uint32_t identifier_bits = 0x7FF;

}  // namespace

std::string_view name_of(NmtState state) {
  switch (state) {
    case NmtState::initialising:
      return "initialising";
    case NmtState::stopped:
      return "stopped";
    case NmtState::operational:
      return "operational";
    case NmtState::pre_operational:
      return "pre_operational";
  }
  return "?";
}

CanopenNode::CanopenNode(CommunicationFacts facts, std::uint8_t node, std::unique_ptr<CanDevice> device)
    : facts_(std::move(facts)),
      node_(node),
      device_(std::move(device)),
      server_(facts_.sdo),
      pdos_(facts_.pdo, node),
      consumers_(static_cast<std::size_t>(facts_.consumers)) {
  make_cells();
  stored_ = cells_;
  stores_ = device_->stores();
  next_heartbeat_ = cell(heartbeat_time) * one_millisecond;
}

void CanopenNode::send(BusFrame frame, std::uint64_t tag, bool answer) { output_.push_back({tag, answer, frame}); }

void CanopenNode::send_pdos(const std::vector<BusFrame>& frames, std::uint64_t tag) {
  for (const BusFrame& frame : frames) send(frame, tag);
}

bool CanopenNode::is_request(const BusFrame& frame) const {
  return !frame.extended && ((!frame.remote && frame.id == cob::sdo_request + node_) ||
                             (frame.remote && frame.id == cob::error_control + node_));
}

bool CanopenNode::wants_answer(const BusFrame& request) const {
  constexpr std::uint8_t abort_command = 0x80;
  return request.remote || (request.size > 0 && request.data[0] != abort_command);
}

bool CanopenNode::may_refuse(const BusFrame& request) const {
  const bool talks = state_ != NmtState::stopped && state_ != NmtState::initialising;
  return talks && !request.remote && wants_answer(request);
}

BusFrame CanopenNode::refuse(const BusFrame& request, std::uint32_t code) {
  const CanBytes refused = server_.refusal(bytes_of(request), code);
  server_.reset();
  return bus_frame(cob::sdo_reply + node_, refused);
}

BusFrame CanopenNode::life_sign(CanView bytes) const { return bus_frame(cob::error_control + node_, bytes); }

void CanopenNode::hear(const BusFrame& frame, std::uint64_t tag, Time now) {
  advance(now);
  if (state_ == NmtState::initialising || frame.extended) return;
  if (frame.id == cob::nmt && !frame.remote) {
    // Exactly two bytes (LD2 C10, JD 2.3, MD 4.5).
    if (frame.size == 2 && (frame.data[1] == 0 || frame.data[1] == node_)) take_command(frame.data[0], now);
  } else if (frame.remote && frame.id == cob::error_control + node_) {
    answer_guarding(tag, now);
  } else if (frame.id > cob::error_control && !frame.remote) {
    take_heartbeat(frame, now);
  } else if (state_ == NmtState::stopped) {
    return;
  } else if (frame.id == cob::sdo_request + node_ && !frame.remote) {
    for (const CanBytes& reply : server_.answer(bytes_of(frame), *this, tag, now)) {
      send(bus_frame(cob::sdo_reply + node_, reply), tag, true);
    }
  } else if (frame.id == (cell(sync_id) & identifier_bits) && !frame.remote) {
    send_pdos(pdos_.sync(*device_, tag, now), tag);
  } else if (frame.remote) {
    if (const auto asked = pdos_.asked_for(frame.id, *device_, now)) send(*asked, tag);
  } else {
    (void)pdos_.take(frame, *device_, tag, now);
  }
  watch_device(now);
}

void CanopenNode::advance(Time now) {
  now_ = std::max(now_, now);
  device_->advance(now_);
  if (device_->booting()) {
    state_ = NmtState::initialising;
    pdos_.stop();
    return;
  }
  if (state_ == NmtState::initialising) begin_communication(now_);
  watch(now_);
  watch_device(now_);
}

// Heartbeats, lost masters.
void CanopenNode::watch(Time now) {
  if (const std::uint32_t period = cell(heartbeat_time); period != 0 && now >= next_heartbeat_) {
    send(bus_frame(cob::error_control + node_, {static_cast<std::uint8_t>(state_)}));
    next_heartbeat_ = now + period * one_millisecond;
  }
  if (guard_deadline_ && now >= *guard_deadline_) {
    guard_deadline_.reset();
    const bool reacts = facts_.drive_minds_guarding || cell(loss_reaction) == 1;  // 0: nothing (MD 4.5)
    if (reacts) lose_master(MasterLoss::guarding, now);
  }
  for (Consumer& consumer : consumers_) {
    if (!consumer.deadline || now < *consumer.deadline) continue;
    consumer.deadline.reset();
    lose_master(MasterLoss::heartbeat, now);
  }
}

void CanopenNode::lose_master(MasterLoss how, Time now) {
  device_->lose_master(how, now);
  if (facts_.leaves_operational_on_loss && state_ == NmtState::operational) enter(NmtState::pre_operational, now);
}

// What the drive has become: alarms, saves, changed values.
void CanopenNode::watch_device(Time now) {
  if (state_ == NmtState::initialising) return;
  if (const std::uint16_t code = device_->error_code(); code != error_) {
    error_ = code;
    if (code != 0) history_.insert(history_.begin(), code);
    if (history_.size() > longest_history) history_.pop_back();
    if (facts_.sends_emergencies) announce_emergency(code, now);
  }
  if (device_->stores() != stores_) {
    stores_ = device_->stores();
    stored_ = cells_;
    pdos_.store();
  }
  send_pdos(pdos_.due(*device_, now), 0);
}

void CanopenNode::announce_emergency(std::uint16_t code, Time) {
  if (state_ == NmtState::initialising || state_ == NmtState::stopped) return;
  const auto low = static_cast<std::uint8_t>(code);
  const auto high = static_cast<std::uint8_t>(code >> 8);
  const std::uint8_t error_register = code == 0 ? std::uint8_t{0} : device_->error_register();
  send(bus_frame(cell(emergency_id) & identifier_bits, {low, high, error_register, 0, 0, 0, 0, 0}));
}

void CanopenNode::begin_communication(Time now) {
  if (!facts_.keeps_settings) {
    cells_ = stored_;
    pdos_.power_up();
  }
  server_.reset();
  toggle_ = false;
  guard_deadline_.reset();
  for (Consumer& consumer : consumers_) consumer.deadline.reset();
  history_.clear();
  error_ = 0;
  device_->connect();
  send(bus_frame(cob::error_control + node_, {0}));
  next_heartbeat_ = now + cell(heartbeat_time) * one_millisecond;
  enter(NmtState::pre_operational, now);
}

void CanopenNode::enter(NmtState state, Time now) {
  const bool was_operational = state_ == NmtState::operational;
  state_ = state;
  if (state != NmtState::operational) pdos_.stop();
  if (state == NmtState::operational && !was_operational) pdos_.start(now);
  if (state == NmtState::stopped) server_.reset();
}

void CanopenNode::take_command(std::uint8_t command, Time now) {
  switch (command) {
    case 0x01:
      enter(NmtState::operational, now);
      break;
    case 0x02:
      enter(NmtState::stopped, now);
      break;
    case 0x80:
      enter(NmtState::pre_operational, now);
      break;
    case 0x81:
      restart(now);
      break;
    case 0x82:
      begin_communication(now);
      break;
    default:
      break;
  }
}

void CanopenNode::restart(Time now) {
  device_->restart(now);
  state_ = NmtState::initialising;
  pdos_.stop();
  output_.clear();
  advance(now);
}

void CanopenNode::take_heartbeat(const BusFrame& frame, Time now) {
  const std::uint32_t producer = frame.id - cob::error_control;
  for (std::size_t i = 0; i < consumers_.size(); ++i) {
    const std::uint32_t entry = cell({consumer_entries, static_cast<std::uint8_t>(i + 1)});
    if ((entry >> 16 & 0x7FU) == producer && (entry & 0xFFFFU) != 0) {
      consumers_[i].deadline = now + (entry & 0xFFFFU) * one_millisecond;
    }
  }
}

Time CanopenNode::guarded_for() const { return cell(guard_time) * cell(life_factor) * one_millisecond; }

void CanopenNode::answer_guarding(std::uint64_t tag, Time now) {
  // The life time begins with the first request (CiA 301 7.2.8.3.2.1).
  if (guarded_for() > Time{}) guard_deadline_ = now + guarded_for();
  if (!facts_.answers_guarding) return;
  if (cell(heartbeat_time) != 0 && !facts_.answers_guarding_with_heartbeat) return;
  const auto state = static_cast<std::uint8_t>(state_);
  send(bus_frame(cob::error_control + node_, {static_cast<std::uint8_t>(state | (toggle_ ? 0x80 : 0))}), tag, true);
  toggle_ = !toggle_;
}

std::optional<Time> CanopenNode::next_event() const {
  std::optional<Time> next;
  const auto consider = [&next](Time at) { next = next ? std::min(*next, at) : at; };
  if (state_ == NmtState::initialising) return now_ + one_millisecond;
  if (cell(heartbeat_time) != 0) consider(next_heartbeat_);
  if (guard_deadline_) consider(*guard_deadline_);
  for (const Consumer& consumer : consumers_) {
    if (consumer.deadline) consider(*consumer.deadline);
  }
  if (const auto look = pdos_.next_look(now_)) consider(*look);
  return next;
}

}  // namespace axisgate::simulated
