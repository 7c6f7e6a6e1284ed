// What a plant can suffer, the same for every drive and protocol.
#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

simulated::DriveFault fault_of(Strike how) {
  switch (how) {
    case Strike::lose_request:
      return simulated::DriveFault::mute;
    case Strike::lose_reply:
      return simulated::DriveFault::lose;
    case Strike::late_reply:
      return simulated::DriveFault::late;
    case Strike::double_reply:
      break;
  }
  return simulated::DriveFault::duplicate;
}

}  // namespace

void Plant::unplug() {
  stage.at_link(0, [](auto& link) { link.unplug(); });
}

void Plant::plug() {
  stage.at_link(0, [](auto& link) { link.plug(); });
}

void Plant::cut_wire() {
  wire_cut_ = true;
  join_wire();
}

void Plant::mend_wire() {
  wire_cut_ = false;
  join_wire();
}

/// A drive without power hears and says nothing, as one behind a cut wire.
void Plant::join_wire() {
  stage.at_link(0, [whole = !wire_cut_ && !drive_off_](auto& link) {
    if (whole)
      link.mend_wire();
    else
      link.cut_wire();
  });
}

void Plant::strike(Strike how, std::uint64_t times, Duration late_by) {
  stage.at_link(0, [=](auto& link) {
    simulated::DriveFaults& faults = link.line().faults(0);
    if (how == Strike::late_reply) faults.late_by = late_by;
    faults.next(fault_of(how), times);
  });
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
