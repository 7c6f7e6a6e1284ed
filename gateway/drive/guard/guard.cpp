// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/guard/guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace axisgate::drive {
namespace {

/// It has no connection that could end.
bool is_dds(const ClientLife& client) { return client.strength.has_value(); }

/// Why this lease has run out, and what helps by the rules that it has: what stands in the configuration already is no
/// advice.
std::string silence(const ClientLife& owner, const LeaseRules& rules, Duration timeout) {
  if (!owner.connected && !is_dds(owner))
    return owner.is_address ? " (a host that writes so seldom needs a longer \"timeout_ms\" of the lease)"
                            : " (one-shot tools need \"lease\": null or \"client\": \"address\")";
  std::string_view missed = owner.is_address ? "has written nothing" : "has asked nothing";
  if (rules.renew == LeaseRenewal::write) missed = "has written nothing to the axis";
  if (rules.renew == LeaseRenewal::heartbeat) missed = "has shown no heartbeat";
  return fmt::format(" (it {} for {} ms)", missed, timeout / std::chrono::milliseconds(1));
}

std::string in_words(Command stop) { return stop == Command::quick_stop ? "quick stop" : std::string(text(stop)); }

bool stops(const OwnStop& stop) { return is_stop(stop.command); }
/// It stops the motor by its torque, which a disable takes away.
bool brakes(const OwnStop& stop) { return stops(stop) && stop.command != Command::disable; }

}  // namespace

Command command_of(StopKind stop) {
  switch (stop) {
    case StopKind::halt:
      return Command::halt;
    case StopKind::quick_stop:
      return Command::quick_stop;
    case StopKind::disable:
      break;
  }
  return Command::disable;
}

// --- What asks for a stop --------------------------------------------------------------------------------------------

void Guard::adopted(Instant now) {
  ownership_.open(now);
  const Command action = command_of(ownership_.rules().on_expiry);
  tell(EventKind::lease, 0,
       fmt::format("found enabled, and nobody owns it: {} unless a client writes to it within {} ms",
                   action == Command::none ? "nothing is done" : in_words(action),
                   ownership_.rules().timeout / std::chrono::milliseconds(1)));
}

void Guard::halt_jog(std::string what) {
  jog_.end();
  note({.command = Command::halt, .why = std::move(what)});
}

void Guard::homing_timed_out() {
  note({.command = Command::halt, .why = "homing took longer than its timeout: halted"});
}

// Leases are off: others go on with what they were told. But where neither the drive nor anybody else would ever stop
// the motor, it is not left running.
void Guard::client_gone(ClientId client, const Seen& seen) {
  if (seen.stops_without_us || motion_by_.client != client || !seen.runs) return;
  note({.command = Command::quick_stop,
        .kind = EventKind::command,
        .why = "the client that commanded the motion is gone: quick stop" +
               (motion_by_.life ? " (" + motion_by_.life->name + ")" : std::string())});
}

// By its state, its position and its velocity a motion is seen to end, to stand and to keep within its limits: one that
// is seen no more is stopped as one whose client is gone.
void Guard::blind(std::string_view object, const Seen& seen) {
  if (seen.stopping || !(seen.runs || seen.runs_raw || jog_.active())) return;
  Command stop = command_of(ownership_.rules().on_expiry);
  if (stop == Command::none) stop = Command::quick_stop;
  note({.command = stop,
        .latches = true,
        .kind = EventKind::command,
        .code = static_cast<std::uint32_t>(stop),
        .why = fmt::format("{} is told no more, and the motion needs it: {}", object, in_words(stop))});
}

void Guard::end_lease(const Ownership::Expired& expired, const Seen& seen) {
  const Command action = command_of(ownership_.rules().on_expiry);
  std::string what = "nobody has taken over the enabled axis";
  if (expired.owner) {
    what = "the lease of " + expired.owner->name + " has run out";
    if (!expired.owner->connected)
      what += is_dds(*expired.owner)      ? " after it had gone"
              : expired.owner->is_address ? " after its connections had ended"
                                          : " after its connection had ended";
  }
  const bool acts = seen.torque || seen.writes;
  if (!acts || action == Command::none) {
    end_jog("its owner's lease has run out");
    return tell(EventKind::lease, 0, what + (acts ? ": nothing is done (on_expiry none)" : ""));
  }
  what += fmt::format(": {}, axis in state \"{}\"", in_words(action), text(seen.state));
  if (expired.owner) what += silence(*expired.owner, ownership_.rules(), expired.timeout);
  note({.command = action,
        .latches = true,
        .kind = EventKind::lease,
        .code = static_cast<std::uint32_t>(action),
        .why = std::move(what)});
}

// --- What is owed ----------------------------------------------------------------------------------------------------

void Guard::lost(Instant heard, std::uint64_t exchange) {
  late_enable_.lost();
  owed_.link_lost(heard, exchange);
  if (owed_.take_gate_report())
    tell(EventKind::command, 0, "the drive is out of reach: a stop is owed until it is back");
}

// An enable whose client was answered that it has failed, or that nobody knows: torque that comes after that, and that
// nobody has asked for since, is taken away again.
void Guard::shows(model::State402 state, std::uint64_t exchange, bool turns, const Seen& seen) {
  owed_.link_back(seen.now);
  const bool late = state == model::State402::operation_enabled && late_enable_.expected(seen.now);
  if (late && !seen.enables && !seen.stop_waits && !owed_.owed()) {
    if (late_enable_.of_unknown(seen.now))
      tell(EventKind::command, static_cast<std::uint32_t>(Command::enable),
           "the enable whose outcome was unknown has happened, and is taken back");
    late_enable_.taken_back();
    owed_.accepted(StopKind::disable, seen.exchange);
  }
  if (owed_.owed() && !seen.owed_waits) discharged(owed_.state_read(state, exchange, turns));
}

void Guard::discharged(OwedStop::End end) {
  if (end == OwedStop::End::none || !owed_.take_end_report()) return;
  std::string_view how = "the drive has shown it";
  if (end == OwedStop::End::disabled) how = "the axis is read disabled";
  if (end == OwedStop::End::enabled) how = "an enable came later";
  tell(EventKind::command, 0, fmt::format("the stop is owed no more: {}", how));
}

// --- What is due -----------------------------------------------------------------------------------------------------

// A stop is due already where all that waits are stops: one more changes nothing.
void Guard::note(OwnStop stop) {
  if (due_.size() == due_.capacity()) {
    const auto said = std::ranges::find_if_not(due_, stops);
    if (said == due_.end() || !stops(stop)) return;
    due_.erase(said);
  }
  due_.push_back(std::move(stop));
}

std::optional<OwnStop> Guard::due(const Seen& seen) {
  if (const auto expired = ownership_.take_expired(seen.now)) end_lease(*expired, seen);
  if (jog_.expired(seen.now)) end_jog("its coil was not written 1 again in time");
  if (jog_.active() && seen.now >= seen.jog_limit) halt_jog("jog: halted at the position limit");
  if (auto next = strongest(seen)) return next;
  if (seen.owed_waits || std::ranges::any_of(due_, stops)) return std::nullopt;
  const auto owed = owed_.due(seen.now);
  if (!owed) return std::nullopt;
  const bool uncertain = *owed == StopKind::halt && !seen.halt_is_certain;
  const Command stop = uncertain ? Command::quick_stop : command_of(*owed);
  return OwnStop{.command = stop,
                 .again = true,
                 .shown = false,
                 .kind = EventKind::command,
                 .code = static_cast<std::uint32_t>(stop),
                 .why = fmt::format("found enabled, and a stop is owed: {}", text(stop))};
}

// What is only said comes first, in its order; then the stronger of quick_stop and halt, which is the other one as
// well; then a disable.
std::optional<OwnStop> Guard::strongest(const Seen& seen) {
  auto next = std::ranges::find_if_not(due_, stops);
  if (next == due_.end())
    next = std::ranges::find_if(due_, [](const OwnStop& s) { return s.command == Command::quick_stop; });
  if (next == due_.end()) next = std::ranges::find_if(due_, brakes);
  if (next == due_.end()) {
    const bool waits = owed_.owed() && seen.now - stopped_at_ < kStopFirst;
    if (due_.empty() || waits) return std::nullopt;
    next = due_.begin();
  }
  OwnStop stop = std::move(*next);
  due_.erase(next);
  if (brakes(stop)) {
    stopped_at_ = seen.now;
    for (OwnStop& other : due_)
      if (brakes(other)) {
        stop.latches = stop.latches || other.latches;
        other.command = Command::none;
      }
  }
  return stop;
}

Instant Guard::next_deadline(Instant now) const {
  const Instant disable = due_.empty() ? kNever : stopped_at_ + kStopFirst;
  return std::min({ownership_.until(), jog_.until(), owed_.next_deadline(now), disable});
}

}  // namespace axisgate::drive
