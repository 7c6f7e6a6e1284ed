// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/axis/axis_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <utility>

#include "gateway/drive/plan/admission.hpp"
#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
namespace {

constexpr double kPerRpm = 1000;

MotionWatch::Rules motion_rules(const model::AxisModel& model) {
  const model::Binding* position = model.binding(Quantity::position_actual);
  return {.travel = model.watch.travel.to_double(),
          .settle = model.watch.settle,
          .standstill = static_cast<double>(model.standstill_velocity),
          .lag = model.velocity_lag,
          .by_position = position != nullptr && position->object != model::kNoObject};
}

UnitsWatch::Rules units_rules(const model::AxisModel& model) {
  return {.standstill = static_cast<double>(model.standstill_velocity) / kPerRpm, .lag = model.velocity_lag};
}

/// What follows something may move at any time: pulses, a shaft, a torque, each target that is written.
bool follows_something(int mode) {
  constexpr int kPosition = 1, kVelocity = 3, kHoming = 6;
  return mode != kPosition && mode != kVelocity && mode != kHoming;
}

std::string by(const WriteBatch& batch) { return batch.life ? batch.life->name : "the gateway"; }

}  // namespace

AxisWatch::AxisWatch(AxisCore& core, AxisHost& host)
    : core_(core), host_(host), motion_(motion_rules(core.model)), units_(units_rules(core.model)) {}

// --- What was asked --------------------------------------------------------------------------------------------------

bool AxisWatch::explains(const WriteBatch& batch) {
  const bool commands = batch.command != Command::none && !is_stop(batch.command);
  const bool word = batch.controlword && !stops_by_word(batch);
  return commands || word || batch.mode || (batch.object && batch.object->write);
}

void AxisWatch::accepted(const WriteBatch& batch) {
  if (asks_to_enable(batch) || resets_fault(batch)) core_.alarms &= ~bit(AxisAlarm::unexpected_motion);
  if (resets_fault(batch) && core_.alarm(AxisAlarm::units_disagree)) {
    core_.alarms &= ~bit(AxisAlarm::units_disagree);
    units_.reset();
  }
  if (!explains(batch)) return;
  asked_ = core_.motion.record().accepted();
  stop_.reset();
  torque_ = {};
  since_ = "what " + by(batch) + " has asked for ended";
  if (batch.command == Command::enable) since_ = by(batch) + " has enabled it";
  // Whether such a word starts something no sheet says.
  if (batch.controlword && model::enables(*batch.controlword)) unknown_until_ = core_.turn.now + kLateStart;
}

void AxisWatch::finished(const WriteBatch& batch, Errc code, bool begun) {
  const bool writes_object = batch.object && batch.object->write;
  const bool unknown = command_result(code) == CommandResult::outcome_unknown && explains(batch);
  if (begun && (writes_object || unknown)) unknown_until_ = core_.turn.now + kLateStart;
}

void AxisWatch::stopped(const WriteBatch& batch, StopKind kind) {
  unknown_until_ = kLongAgo;
  // It goes back to where it was when the halt came: a motion of its own.
  if (kind == StopKind::halt && halts_by_position(core_)) asked_ = core_.motion.record().accepted();
  if (!batch.life && reacted_at_ == core_.turn.now) return;
  stop_ = kind;
  reactions_ = 0;
  torque_ = {.unwanted = kind == StopKind::disable, .seen_off = false, .back_at = kNever};
  since_ = fmt::format("the {} of {}", text(command_of(kind)), by(batch));
}

void AxisWatch::renumbered() {
  motion_.reset();
  units_.reset();
  target_ = {};
  move_ = 0;
  signs_reported_ = 0;
}

// --- What is seen ----------------------------------------------------------------------------------------------------

void AxisWatch::observe(bool asked) {
  // What a suspect drive shows counts for nothing, and it is not lost.
  if (core_.turn.link == LinkState::suspect) return;
  const AxisFacts facts = core_.facts();
  watch_target(facts);
  watch_signs();
  if (core_.model.position_commanded) return;
  watch_motion(facts, asked);
  watch_torque();
  if (core_.model.watch.units) watch_units(facts, asked);
}

bool AxisWatch::explained(const AxisFacts& facts, bool asked) const {
  const Motion& motion = core_.motion;
  const bool runs = motion.running() != MotionKind::none || motion.runs_raw() || core_.turn.now < unknown_until_;
  const bool led_on =
      motion.goes_on(Quantity::target_velocity, facts) || motion.goes_on(Quantity::target_torque, facts);
  return asked || runs || led_on || follows_something(facts.mode) || core_.alarm(AxisAlarm::local_control);
}

void AxisWatch::watch_motion(const AxisFacts& facts, bool asked) {
  MotionWatch::Seen seen;
  seen.at = core_.turn.now;
  seen.there = core_.turn.link == LinkState::online;
  seen.torque = core_.shows_torque();
  seen.explained = explained(facts, asked);
  seen.asked = asked_;
  seen.stops = core_.motion.record().newest_stop();
  seen.window = window();
  seen.position = value(Quantity::position_actual, core_.model.units_per_rev.to_double());
  seen.velocity = value(Quantity::velocity_actual, 1);
  const auto found = motion_.observe(seen);
  if (!found) return;
  if (stop_holds()) unheeded_ = std::exchange(shown_, std::nullopt)->stop;
  tell_unexpected(found->from
                      ? fmt::format("{:.2f} turns from {:.2f}", std::abs(found->now - *found->from), *found->from)
                      : fmt::format("it turns at {:.1f} rpm", found->now / kPerRpm));
}

bool AxisWatch::stop_holds() const {
  const Motion& motion = core_.motion;
  return shown_ && motion.stopping() && motion.record().newest_stop() == shown_->stop.at && !motion.runs_raw() &&
         core_.shows_torque();
}

// What was told done is so until the motor stands, or something else is asked of it: a drive that shows a stop and
// turns on has not stopped. What noise may be counts where the position moves as well.
std::optional<AxisWatch::Stop> AxisWatch::take_unheeded() {
  if (unheeded_) return std::exchange(unheeded_, std::nullopt);
  if (!stop_holds()) shown_.reset();
  if (!shown_) return std::nullopt;
  const auto velocity = value(Quantity::velocity_actual, 1);
  if (!velocity || !core_.moving() || core_.turn.link != LinkState::online) return std::nullopt;
  const double speed = std::abs(velocity->value);
  const auto standstill = static_cast<double>(core_.model.standstill_velocity);
  const double noise = core_.model.position_commanded ? standstill : model::kTimesStandstill * standstill;
  shown_->slowing.take(speed, velocity->at);
  const bool turns_on = speed > noise && shown_->slowing.ended(velocity->at, std::max(window(), Slowing::kPatience));
  if (!turns_on) return std::nullopt;
  return std::exchange(shown_, std::nullopt)->stop;
}

// It was disabled, was seen to be so, and has torque again. Where the bus takes no torque away it is always there.
void AxisWatch::watch_torque() {
  const bool there = core_.turn.link == LinkState::online;
  if (!torque_.unwanted || !there || core_.cannot_deenergise() || core_.alarm(AxisAlarm::local_control)) {
    torque_.back_at = kNever;
    return;
  }
  if (!core_.shows_torque()) {
    torque_.seen_off = torque_.seen_off || core_.store[core_.model.statusword].known;
    torque_.back_at = kNever;
    return;
  }
  const Instant shown_at = core_.store[core_.model.statusword].sent_at;
  if (torque_.seen_off && torque_.back_at == kNever) torque_.back_at = shown_at;
  if (torque_.back_at == kNever || shown_at - torque_.back_at < core_.model.watch.settle) return;
  torque_.back_at = shown_at;
  tell_unexpected("it has torque");
}

// One that goes on is not told again, unless something is done about it.
void AxisWatch::tell_unexpected(const std::string& what) {
  if (!stop_ && core_.model.watch.reaction == model::WatchReaction::off) return;
  due_ = reaction();
  if (core_.alarm(AxisAlarm::unexpected_motion) && !due_) return;
  const bool disabled = stop_ == StopKind::disable;
  warn(AxisAlarm::unexpected_motion,
       fmt::format("{}, expected {} since {}{}", what, disabled ? "no torque" : "standstill", since_,
                   due_ ? fmt::format(": {}", text(*due_)) : std::string()));
}

// Against a stop that stop once more, then the quick stop, and to take the torque away only where the configuration
// does so as well. A quick stop asks for less than a disable, which is owed until it shows.
std::optional<Command> AxisWatch::reaction() {
  if (!stop_) {
    if (core_.model.watch.reaction != model::WatchReaction::stop || core_.alarm(AxisAlarm::unexpected_motion))
      return std::nullopt;
    return Command::quick_stop;
  }
  boost::container::static_vector<StopKind, 3> ladder{*stop_};
  if (stop_ == StopKind::halt) ladder.push_back(StopKind::quick_stop);
  const LeaseRules& lease = core_.model.lease;
  if (stop_ != StopKind::disable && lease.on && lease.on_expiry == LeaseAction::disable)
    ladder.push_back(StopKind::disable);
  if (reactions_ >= static_cast<int>(ladder.size())) return std::nullopt;
  reacted_at_ = core_.turn.now;
  return command_of(ladder[static_cast<std::size_t>(reactions_++)]);
}

// --- What does not fit -----------------------------------------------------------------------------------------------

// Of a motion of the gateway's own alone: what follows something may step from poll to poll.
void AxisWatch::watch_units(const AxisFacts& facts, bool asked) {
  const MotionKind runs = core_.motion.running();
  const bool counts = core_.turn.link == LinkState::online && facts.enabled() && !asked &&
                      (runs == MotionKind::discrete || runs == MotionKind::velocity);
  const Duration polls = 4 * std::max(period(Quantity::position_actual), period(Quantity::velocity_actual));
  const auto found =
      units_.observe({.counts = counts,
                      .motion = asked_,
                      .window = std::max<Duration>(std::chrono::seconds(1), polls),
                      .position = value(Quantity::position_actual, core_.model.units_per_rev.to_double()),
                      .velocity = value(Quantity::velocity_actual, kPerRpm)});
  if (!found) return;
  warn(AxisAlarm::units_disagree,
       fmt::format(
           "velocity_actual shows {:.1f} rpm, and position_actual changes by {:.1f} turns a minute: no motion is "
           "started until a fault_reset or a reload",
           found->velocity, found->position));
}

std::optional<TargetWatch::Seen> AxisWatch::standing_move(const AxisFacts& facts) const {
  const Motion& motion = core_.motion;
  const bool known = core_.sent_to && core_.turn.link == LinkState::online && facts.enabled();
  if (!known || facts.moving || asked_ != move_) return std::nullopt;
  using End = TargetWatch::End;
  const bool runs = motion.running() == MotionKind::discrete;
  const bool shown = runs ? facts.target_reached : motion.arrived() || facts.motion_failed;
  if (runs == shown) return std::nullopt;
  const auto position = value(Quantity::position_actual, core_.model.units_per_rev.to_double());
  if (!position) return std::nullopt;
  return TargetWatch::Seen{
      .at = core_.turn.now,
      .move = move_,
      .end = runs                  ? End::none
             : facts.motion_failed ? End::failed
                                   : End::reached,
      .position = position->value,
      .target = static_cast<double>(core_.sent_to->position) / core_.model.units_per_rev.to_double()};
}

void AxisWatch::watch_target(const AxisFacts& facts) {
  if (core_.motion.running() == MotionKind::discrete) move_ = asked_;
  const auto seen = standing_move(facts);
  const auto finding = target_.observe(seen, core_.model.watch.travel.to_double());
  // A drive that has a limit of its own may end a move there.
  const bool limited = (core_.value(Quantity::statusword).value_or(0) & model::statusword::kInternalLimit) != 0;
  if (!finding || (limited && *finding == TargetWatch::Finding::elsewhere)) return;
  std::string why;
  switch (*finding) {
    case TargetWatch::Finding::not_reached:
      why = "and the drive does not say that it is there: see " + reached_by();
      break;
    case TargetWatch::Finding::held:
      why = "and has not ended: something holds the motor, or position_actual does not count as target_position does";
      break;
    case TargetWatch::Finding::elsewhere:
      why =
          "and the drive says that it is there: position_actual or target_position is another object of the drive, "
          "or they do not count alike";
      break;
    case TargetWatch::Finding::short_of_it:
      why = "and has failed: something has ended it, or position_actual does not count as target_position does";
      break;
  }
  host_.event(core_.model.number, EventKind::warning, 0,
              fmt::format("the move stands at {:.4f} turns, {:.4f} from its target, {}", seen->position,
                          std::abs(seen->position - seen->target), why));
}

std::string AxisWatch::reached_by() const {
  if (!core_.is_virtual()) return "its position window (6067h, 6068h)";
  const auto& reached = core_.model.virtual_axis->reached;
  if (!reached) return "\"moving\" under \"state\" in its profile";
  return fmt::format("\"reached\" under \"state\" in its profile, for which {} reads {}",
                     core_.object(reached->object).name, core_.store[reached->object].number);
}

// Below 0 such an object holds what is near its upper end.
void AxisWatch::watch_signs() {
  for (const Quantity quantity : {Quantity::position_actual, Quantity::velocity_actual}) {
    const model::ObjectId id = core_.object_of(quantity);
    if (id == model::kNoObject || !core_.store[id].known || (signs_reported_ & bit(quantity)) != 0) continue;
    const model::ObjectDef& object = core_.object(id);
    const std::int64_t number = core_.store[id].number;
    const model::Binding& binding = *core_.model.binding(quantity);
    if (object.is_signed || number <= object.range().max / 2 || !binding.scaled || binding.to_register(number))
      continue;
    signs_reported_ |= bit(quantity);
    host_.event(core_.model.number, EventKind::warning, 0,
                fmt::format("{} reads {}, more than its row can show; as a signed number it is {}: give object {} of "
                            "the profile the type i{}",
                            row(quantity).name, number, number - object.range().max - 1, object.name, 8 * object.size));
  }
}

void AxisWatch::warn(AxisAlarm alarm, std::string text) {
  core_.alarms |= bit(alarm);
  host_.event(core_.model.number, EventKind::warning, static_cast<std::uint32_t>(alarm),
              fmt::format("{}: {}", axisgate::text(alarm), text));
}

std::optional<TimedValue> AxisWatch::value(Quantity quantity, double units) const {
  const model::ObjectId id = core_.object_of(quantity);
  const auto number = core_.value(quantity);
  if (id == model::kNoObject || !number) return std::nullopt;
  return TimedValue{static_cast<double>(*number) / units, core_.store[id].sent_at};
}

Duration AxisWatch::window() const {
  return std::max<Duration>(std::chrono::milliseconds(250),
                            core_.model.velocity_lag + period(Quantity::velocity_actual));
}

Duration AxisWatch::period(Quantity quantity) const {
  const model::Binding* binding = core_.model.binding(quantity);
  if (binding == nullptr || binding->object == model::kNoObject || binding->poll == model::PollClass::once)
    return Duration{};
  return std::max(core_.drive.poll_period[static_cast<std::size_t>(binding->poll)],
                  core_.store.period(binding->object));
}

}  // namespace axisgate::drive
