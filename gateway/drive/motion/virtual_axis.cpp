// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/motion/virtual_axis.hpp"

#include <cstdlib>
#include <utility>

namespace axisgate::drive {

void VirtualAxis::control(std::uint16_t word, const model::VirtualProperties& facts) {
  switch (model::request_of(word)) {
    case model::Request402::disable_voltage:
      gate_ = Gate::disabled;
      break;
    case model::Request402::quick_stop:
      gate_ = facts.quick_stop_energised && (gate_ == Gate::open || gate_ == Gate::quick_stopped) ? Gate::quick_stopped
                                                                                                  : Gate::disabled;
      break;
    case model::Request402::shutdown:
      gate_ = Gate::ready;
      break;
    case model::Request402::switch_on:
      gate_ = Gate::switched_on;
      break;
    case model::Request402::enable_operation:
      if (gate_ != Gate::disabled && gate_ != Gate::unknown) gate_ = Gate::open;
      break;
    case model::Request402::other:
      break;
  }
}

void VirtualAxis::started(MotionKind kind, std::optional<std::int64_t> goal, Instant now, std::uint64_t exchange) {
  run_ = {.kind = kind, .goal = goal, .since = now, .exchange = exchange, .under_way = true};
  end_ = End::none;
}

// Where the bus cannot take the torque away, the gate is the gateway's, and the drive's word only closes it.
void VirtualAxis::keep_gate(const Seen& seen) {
  // Found moving at the first look: somebody has enabled and started it.
  if (gate_ == Gate::unknown) gate_ = seen.enabled && seen.moving && !seen.fault ? Gate::open : Gate::disabled;
  if (seen.fault || !seen.enabled) gate_ = Gate::disabled;
}

// Elsewhere the drive says whether it is enabled, whoever has enabled it; only what a disabled one was told so far is
// ours to remember.
void VirtualAxis::follow_drive(const Seen& seen) {
  const bool holds = gate_ == Gate::open || gate_ == Gate::quick_stopped;
  if (seen.fault || (!seen.enabled && (holds || gate_ == Gate::unknown))) gate_ = Gate::disabled;
  if (seen.enabled && !seen.fault && gate_ != Gate::quick_stopped) gate_ = Gate::open;
}

void VirtualAxis::observe(const Seen& seen, const model::VirtualProperties& facts) {
  const bool first_look = gate_ == Gate::unknown;
  if (facts.gate_only)
    keep_gate(seen);
  else
    follow_drive(seen);
  if (first_look && gate_ == Gate::open) found_enabled_ = true;
  shows_gate_ = !facts.gate_only;
  if (gate_ != Gate::open || seen.running == MotionKind::none) run_.under_way = false;
  if (run_.under_way && seen.exchange > run_.exchange) follow(seen, facts);
}

bool VirtualAxis::take_found_enabled() { return std::exchange(found_enabled_, false); }

// What the drive does not tell is worked out from what it does: a motion is over when the axis has moved and stands
// again (or has had its time to begin), and it has reached its target if the position read after that says so.
void VirtualAxis::follow(const Seen& seen, const model::VirtualProperties& facts) {
  run_.moved = run_.moved || seen.moving;
  if (seen.moving) run_.seen_moving = seen.invalidations;
  if (!seen.standing) {
    run_.stopped = 0;
    run_.rest.reset();
    return;
  }
  const bool sampled = seen.position && seen.position_exchange > run_.exchange;
  const bool at_goal = sampled && run_.goal && std::llabs(*seen.position - *run_.goal) <= facts.within;
  const bool began = run_.moved || seen.at - run_.since >= kStartShows;
  if (began && run_.stopped == 0) run_.stopped = seen.exchange;
  const bool settled = run_.stopped != 0 && sampled && seen.position_exchange > run_.stopped;
  // A move that turns round stands for an instant: it has ended short of its target only if it stays where it is.
  const bool rests =
      settled && run_.rest && *seen.position == *run_.rest && seen.position_exchange > run_.rest_exchange;
  if (settled && !rests && seen.position_exchange > run_.rest_exchange) {
    run_.rest = seen.position;
    run_.rest_exchange = seen.position_exchange;
  }
  switch (run_.kind) {
    case MotionKind::discrete:
      if (at_goal && (settled || !run_.moved)) {
        end_ = End::reached;
      } else if (rests || (settled && !run_.goal)) {
        end_ = run_.goal ? End::failed : End::reached;
      }
      break;
    case MotionKind::homing:
      // A drive that stands at the homing position and ignored the command has not homed.
      if (settled) end_ = seen.homed_at && run_.moved ? End::reached : End::failed;
      break;
    case MotionKind::velocity:
      // Where a command runs it, and not its set-point, the drive has ended the run: by an input of its own, or it has
      // restarted, and that at once, if it was out of sight. What turns round stands for an instant.
      if (facts.gate_only && seen.speed_asked && (rests || (run_.moved && run_.seen_moving != seen.invalidations)))
        end_ = End::failed;
      break;
    case MotionKind::none:
    case MotionKind::torque:
      break;
  }
  if (end_ != End::none) run_.under_way = false;
}

std::uint16_t VirtualAxis::statusword(const Seen& seen) const {
  // CiA 402-2 table 30.
  constexpr std::uint16_t kFault = 0x08, kDisabled = 0x40, kReady = 0x21, kSwitchedOn = 0x23, kEnabled = 0x27,
                          kQuickStop = 0x07;
  std::uint16_t word = kDisabled;
  if (seen.fault) {
    word = kFault;
  } else if (seen.enabled || shows_gate_) {
    switch (gate_) {
      case Gate::unknown:
      case Gate::disabled:
        break;
      case Gate::ready:
        word = kReady;
        break;
      case Gate::switched_on:
        word = kSwitchedOn;
        break;
      case Gate::open:
        word = kEnabled;
        break;
      case Gate::quick_stopped:
        word = kQuickStop;
        break;
    }
  }
  const auto set = [&](std::uint16_t mask, bool on) { word = on ? static_cast<std::uint16_t>(word | mask) : word; };
  set(model::statusword::kInternalLimit, seen.limit);
  if (word != kEnabled && word != (kEnabled | model::statusword::kInternalLimit)) return word;
  const bool started = (seen.controlword & model::controlword::kStart) != 0;
  switch (seen.mode) {
    case 1:
      set(model::statusword::kTargetReached, end_ == End::reached);
      set(model::statusword::kSetpointAcknowledge, started && run_.kind == MotionKind::discrete);
      break;
    case 3:
      set(model::statusword::kTargetReached, seen.at_velocity);
      set(1U << 12, !seen.moving);  // CiA 402-2 table 131: speed is 0
      break;
    case 6:
      set(model::statusword::kTargetReached, end_ != End::none || !run_.under_way);
      set(1U << 12, homing_attained());
      set(1U << 13, homing_failed());
      break;
    default:
      break;
  }
  return word;
}

}  // namespace axisgate::drive
