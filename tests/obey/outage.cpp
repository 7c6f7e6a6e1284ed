// SPDX-License-Identifier: Apache-2.0
// What a plant can suffer, the same for every drive and protocol.
#include <algorithm>
#include <type_traits>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using simulated::DriveFault;

DriveFault fault_of(Strike how) {
  constexpr std::array<DriveFault, kStrikes.size()> kFaults{
      DriveFault::unresponsive,  DriveFault::lose,        DriveFault::late,    DriveFault::duplicate,
      DriveFault::noise_before,  DriveFault::noise_after, DriveFault::corrupt, DriveFault::split,
      DriveFault::emergencies,   DriveFault::babble,      DriveFault::half,    DriveFault::wrong_length,
      DriveFault::wrong_station, DriveFault::glued};
  return kFaults.at(static_cast<std::size_t>(how));
}

}  // namespace

bool Plant::is_enabled_by_hand_once_disarmed() {
  auto& node = stage.can_node(0);
  const auto now = [this] { return stage.runtime().now().time_since_epoch(); };
  const simulated::ObjectKey entry = is_md(subject) ? simulated::ObjectKey{0x6007, 0} : simulated::ObjectKey{0x1016, 1};
  const auto armed_as = node.peek(entry, now());
  bool done = stage.run_until([&] { return node.peek(entry, now()) != armed_as; }, std::chrono::seconds(1));
  for (const std::int64_t word : {6, 7, 15}) done = done && node.poke({0x6040, 0}, word, now()) == 0U;
  return done;
}

void Plant::other_master_sends(std::uint32_t id, const std::vector<std::uint8_t>& bytes) {
  auto& link = stage.can_link(0);
  simulated::BusFrame frame;
  frame.id = id;
  frame.size = static_cast<std::uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), frame.data.begin());
  link.line().from_host(frame, link.time_of(stage.runtime().now()));
}

void Plant::unplug(bool bus_off) {
  stage.at_link(0, [bus_off](auto& link) {
    if constexpr (std::is_same_v<decltype(link), CanLinkSim&>)
      if (bus_off) return link.bus_off();
    link.unplug();
  });
}

void Plant::plug() {
  stage.at_link(0, [](auto& link) { link.plug(); });
}

void Plant::cut_wire(bool drive_alone) {
  (drive_alone ? drive_cut_ : wire_cut_) = true;
  join_wire();
}

void Plant::mend_wire() {
  wire_cut_ = drive_cut_ = false;
  join_wire();
}

/// A drive without power hears and says nothing, as one behind a cut wire; a neighbour goes on speaking.
void Plant::join_wire() {
  const bool deaf = drive_cut_ || drive_off_;
  stage.at_link(0, [this, deaf](auto& link) {
    if (wire_cut_ || (deaf && !neighbour_))
      link.cut_wire();
    else
      link.mend_wire();
    if (!neighbour_ || wire_cut_) return;
    if constexpr (std::is_same_v<decltype(link), CanLinkSim&>)
      link.line().connect(0, !deaf);
    else
      link.line().faults(0).set_rate(DriveFault::unresponsive, deaf ? 1 : 0);
  });
}

bool Plant::strike(Strike how, std::uint64_t times, Duration late_by) {
  return stage.at_link(0, [=](auto& link) {
    if (!link.line().has(fault_of(how))) return false;
    simulated::DriveFaults& faults = link.line().faults(0);
    if (how == Strike::late_reply) faults.late_by = late_by;
    faults.next(fault_of(how), times);
    return true;
  });
}

bool Plant::strike_often(Strike how, double probability, Duration late_by) {
  return stage.at_link(0, [=](auto& link) {
    if (!link.line().has(fault_of(how))) return false;
    simulated::DriveFaults& faults = link.line().faults(0);
    if (how == Strike::late_reply) faults.late_by = late_by;
    faults.set_rate(fault_of(how), probability);
    return true;
  });
}

std::uint64_t Plant::struck(Strike how) {
  return stage.at_link(0, [how](auto& link) { return link.line().faults(0).struck(fault_of(how)); });
}

void Plant::restart_drive(Duration off) {
  drive_off_ = off > Duration{};
  if (!drive_off_) join_wire();  // before it says that it is back
  stage.at_link(0, [](auto& link) { link.restart(0); });
  if (drive_off_) join_wire();
  power_back_->expires_at(drive_off_ ? stage.runtime().now() + off : kNever);
}

void Plant::trip_drive() { trip(stage, subject); }

void Plant::open_port() {
  registry_.emplace();
  port_.open({listener, stage.gateway().image(), stage.gateway(), *registry_, log_, &stage.runtime()});
}

void Plant::crash_gateway() {
  stage.crash([this] {
    port_.close();
    registry_.reset();
  });
}

void Plant::die_after(std::size_t units) {
  stage.at_link(0, [units](auto& link) { link.last_words.die_after(units); });
}

bool Plant::dead() {
  return stage.at_link(0, [](const auto& link) { return link.last_words.dead(); });
}

void Plant::start_gateway() {
  stage.start();
  open_port();
  fitter_.connect();
}

std::size_t Plant::frames_sent() {
  return stage.at_link(0, [](const auto& link) { return link.sent.size(); });
}

std::uint64_t Plant::requests_heard() {
  return stage.at_link(0, [](auto& link) {
    link.advance_drives();
    return link.line().requests_heard();
  });
}

bool Plant::still_strikes(Strike how) {
  return stage.at_link(0, [how](auto& link) { return link.line().faults(0).armed(fault_of(how)); });
}

}  // namespace axisgate::test::obey
