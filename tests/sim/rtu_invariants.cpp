#include "tests/sim/rtu_invariants.hpp"

#include <algorithm>

namespace axisgate::test {
namespace {

constexpr std::uint16_t kSteppersControl = 323, kSteppersSpeed = 306;
constexpr std::uint16_t kServosControl = 0x3100, kServosSpeed = 0x4A00;

/// Absolute and relative move, speed, both jogs, homing (iD286pro 5).
bool begins_motion(std::uint16_t command) { return (command >= 1 && command <= 5) || command == 12; }

/// Commands of the axis that lead to this one of the drive.
bool leads_to(std::uint16_t asked, std::uint16_t command) {
  switch (command) {
    case 1:  // a relative move may be carried out as an absolute one
    case 2:
      return asked == 6 || asked == 7;
    case 3:
      return asked == 8 || asked == Asked::kVelocityWritten;
    case 12:
      return asked == 10;
    default:
      return false;
  }
}

}  // namespace

RtuCableWatch::RtuCableWatch(RtuLinkSim& link, Runtime& runtime, Duration timeout,
                             std::function<void(std::string)> violated)
    : link_(link), runtime_(runtime), timeout_(timeout), violated_(std::move(violated)) {
  link_.on_unplugged = [this] { sent_at_ = kLongAgo; };  // the loss ends what was outstanding
  link_.on_traffic = [this](bool towards_drive, Bytes bytes) {
    for (const Byte b : bytes) hash_ = mix(hash_, b);
    hash_ = mix(hash_, static_cast<std::uint64_t>(runtime_.now().time_since_epoch().count()));
    if (towards_drive)
      to_drive(bytes);
    else
      heard_.insert(heard_.end(), bytes.begin(), bytes.end());
  };
}

// Something of what was heard is an answer: the registers asked for, an acknowledgement, or an error reply.
bool RtuCableWatch::answered() const {
  if (reply_in(heard_, request_)) return true;
  constexpr std::size_t kErrorReply = 5;
  for (std::size_t at = 0; at + kErrorReply <= heard_.size(); ++at) {
    const Bytes window = Bytes(heard_).subspan(at, kErrorReply);
    if (window[0] == request_.unit && (window[1] & 0x80) != 0 && simulated::open_rtu(window)) return true;
  }
  return false;
}

void RtuCableWatch::to_drive(Bytes frame) {
  if (!simulated::open_rtu(frame)) violated_("I1: what was sent is not one whole frame");
  const bool over = sent_at_ == kLongAgo || runtime_.now() >= sent_at_ + timeout_ || answered();
  if (!over) violated_("I1: a request while another was outstanding");
  request_ = request_in(frame);
  heard_.clear();
  sent_at_ = runtime_.now();
  for (const OnRtuRequest& tell : tell_) tell(request_);
  if (!request_.write) return;
  const std::uint32_t value =
      request_.values.front() | (request_.count == 2 ? std::uint32_t{request_.values.back()} << 16 : 0U);
  const bool speed = request_.start == kSteppersSpeed || request_.start == kServosSpeed;
  if (speed && ++profile_velocities_[{request_.unit, value}] > 1) violated_("I5: a value was written twice");
  if (request_.start == kServosControl && (value == 0x3F || value == 0x5F)) ++starts_;
}

RtuDriveWatch::RtuDriveWatch(const app::Gateway& gateway, RtuLinkSim& link, std::size_t position, AxisNumber axis,
                             const Asked& asked, Runtime& runtime, std::function<void(std::string)> violated)
    : gateway_(gateway),
      link_(link),
      position_(position),
      axis_(axis),
      asked_(asked),
      runtime_(runtime),
      violated_(std::move(violated)),
      watch_(gateway, axis, asked, runtime, violated_),
      truth_(gateway, link, axis),
      began_(runtime.now()) {}

void RtuDriveWatch::check() {
  check_values();
  watch_.check_validity();
  if (const simulated::KincoDrive* kinco = link_.line().kinco(position_))
    watch_.check_enables(kinco->transitions(), [&](simulated::Time at) { return link_.time_of(runtime_.now()) - at; });
  if (const simulated::Id286pro* stepper = link_.line().id286pro(position_)) check_stepper(*stepper);
}

// A drive that owes a reply for longer than the timeout and the silence together may be taken at its late word.
bool RtuDriveWatch::keeps_its_word() const {
  const drive::DriveModel& model = gateway_.drive_of(axis_)->model();
  const auto& journal = link_.line().journal().entries();
  return std::none_of(journal.begin(), journal.end(), [&](const simulated::RtuExchange& exchange) {
    return exchange.station == model.node &&
           exchange.reply_ready - exchange.received > model.timeout + model.fence.worst_reply;
  });
}

void RtuDriveWatch::check_values() {
  const auto lie = truth_.lie();
  if (lie && keeps_its_word()) violated_("I2: " + *lie);
}

void RtuDriveWatch::on_request(const RtuRequest& request) {
  const simulated::Id286pro* stepper = link_.line().id286pro(position_);
  if (stepper == nullptr || request.unit != stepper->unit() || !request.write) return;
  const bool enabled = gateway_.drive_of(axis_)->axis(0).core().facts().enabled();
  if (request.start == kSteppersControl && begins_motion(request.values.front()) && !enabled)
    violated("a motion was started while it was not enabled");
}

void RtuDriveWatch::check_stepper(const simulated::Id286pro& stepper) {
  const AxisImage& image = *const_cast<app::Gateway&>(gateway_).image().find(axis_);
  check_gate(image);
  check_memory(stepper);
  const auto& starts = stepper.starts();
  for (; starts_seen_ < starts.size(); ++starts_seen_) check_start(starts[starts_seen_]);
}

// I10 of a drive whose state machine is the gateway's: shown enabled because somebody asked, or because it was found
// moving.
void RtuDriveWatch::check_gate(const AxisImage& image) {
  const bool enabled = image.has(AxisInput::enabled);
  const bool adopted = (image.alarms & bit(AxisAlarm::adopted_running)) != 0;
  if (enabled && !std::exchange(enabled_, enabled) && !adopted && !watch_.enable_was_asked(runtime_.now()))
    violated("I10: it was enabled although nobody asked");
  enabled_ = enabled;
}

void RtuDriveWatch::check_start(const simulated::Id286proStart& start) {
  if (start.command == 1 || start.command == 2) ++moves_;
  const Instant at = runtime_.now() - (link_.time_of(runtime_.now()) - start.at);
  const bool asked = std::any_of(asked_.motions.begin(), asked_.motions.end(), [&](const Asked::Motion& m) {
    return m.axis == axis_ && m.at <= at && at - m.at <= kLongestWay && leads_to(m.command, start.command);
  });
  if (!asked || start.tag == 0) violated("a motion (" + std::to_string(start.command) + ") that nobody asked for");
}

void RtuDriveWatch::check_memory(const simulated::Id286pro& stepper) {
  std::uint64_t writes = 0;
  for (const auto& [number, count] : stepper.registers().stored_writes()) writes += count;
  const auto minutes = static_cast<std::uint64_t>((runtime_.now() - began_) / std::chrono::minutes(1));
  if (writes > drive::NvmBudget::kAtOnce + minutes) violated("its memory was written more often than the budget has");
}

}  // namespace axisgate::test
