// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/axis/publisher.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {
namespace {

Instant confirmed_statusword(const AxisCore& core) {
  const ObjectState& status = core.store[core.model.statusword];
  return status.known ? status.sent_at : kLongAgo;
}

/// The words of the fault before are no value of this one, and words alone are none before its cause is known.
bool is_of_unknown_cause(const AxisCore& core, const AxisFacts& facts, const model::Binding& binding) {
  if (binding.quantity != Quantity::vendor_error || !facts.faulted()) return false;
  const auto old = [&](model::ObjectId id) {
    return id != model::kNoObject && !core.store[id].refused && !core.names_cause(id);
  };
  return !core.fault.cause_known() || old(binding.object) ||
         std::ranges::any_of(binding.bits, [&](const model::BitField& field) { return old(field.object); });
}

// When the quantity was last confirmed: the oldest of its objects. kLongAgo where one of them never was.
Instant confirmed_at(const AxisCore& core, const AxisFacts& facts, const model::Binding& binding) {
  Instant oldest = kNever;
  const auto look = [&](model::ObjectId id) {
    // The gateway's own words are as good as what they are made from.
    if (id != model::kNoObject && core.store[id].emulated) id = core.model.statusword;
    if (id == model::kNoObject || core.store[id].refused) return;
    oldest = std::min(oldest, core.store[id].known ? core.store[id].sent_at : kLongAgo);
  };
  const bool of_error = binding.quantity == Quantity::error_code;
  const Instant status = confirmed_statusword(core);
  // In a fault it is what this fault was named, or not yet, as long as the statusword shows the fault.
  if ((of_error && facts.faulted()) || is_of_unknown_cause(core, facts, binding)) return status;
  if (of_error)
    for (const model::ObjectId word : core.model.fault_words) look(word);
  look(binding.object);
  for (const model::BitField& field : binding.bits) look(field.object);
  // A drive that has no word of its faults shows by its statusword that it has none.
  if (of_error && oldest == kNever) return status;
  return oldest == kNever ? kLongAgo : oldest;
}

bool refused(const AxisCore& core, const model::Binding& binding) {
  // What a fault is named does not hang on one object.
  if (binding.quantity == Quantity::error_code) return false;
  return binding.object != model::kNoObject && core.store[binding.object].refused;
}

// The drive never says what it holds: what it was told is all that can be shown, and no younger than that.
bool is_told_alone(const AxisCore& core, const model::Binding& binding) {
  if (binding.object == model::kNoObject) return false;
  const model::ObjectDef& object = core.object(binding.object);
  return !object.readable && !object.emulated && core.store.period(binding.object) == Duration{};
}

Duration stale_after(const AxisCore& core, const model::Binding& binding) {
  if (binding.poll == model::PollClass::once || is_told_alone(core, binding)) return Duration::max();
  Duration period = core.drive.poll_period[static_cast<std::size_t>(binding.poll)];
  const auto mapped = [&](model::ObjectId id) {
    if (id != model::kNoObject) period = std::max(period, core.store.period(id));
  };
  mapped(binding.object);
  for (const model::BitField& field : binding.bits) mapped(field.object);
  if (binding.quantity == Quantity::error_code) {
    mapped(core.model.statusword);
    for (const model::ObjectId word : core.model.fault_words) mapped(word);
  }
  return std::max(kStaleAtLeast, 3 * period);
}

/// Of a fault: none until its cause is known (design 3.2 Causes of faults).
std::optional<std::int64_t> error_code(const AxisCore& core, const AxisFacts& facts) {
  if (!facts.faulted()) return named_code(core);
  if (!core.fault.cause_known()) return std::nullopt;
  constexpr std::int64_t kGenericError = 0x1000;  // CiA 402-2 error codes: generic error
  const std::uint16_t cause = core.fault.code();
  return cause != 0 ? cause : kGenericError;
}

// Where the set-points of several modes lie in one object (Keya: 6081h), it holds that of the mode in force alone.
bool is_of_another_mode(const AxisCore& core, const AxisFacts& facts, const model::Binding& binding) {
  if (binding.object == model::kNoObject || core.object(binding.object).aliases.empty()) return false;
  return is_target(binding.quantity) && setpoint_of_mode(facts.mode) != binding.quantity;
}

std::optional<std::int64_t> shown_value(const AxisCore& core, const AxisFacts& facts, const model::Binding& binding) {
  switch (binding.quantity) {
    case Quantity::error_code:
      return error_code(core, facts);
    case Quantity::mode_display:
      return facts.mode;
    case Quantity::mode: {
      const ObjectState& state = core.store[binding.object];
      if (!state.known) return std::nullopt;
      for (const auto& [unified, raw] : core.model.modes)
        if (raw == state.number) return unified;
      return state.number;
    }
    case Quantity::statusword: {
      const auto value = core.value(Quantity::statusword);
      if (!value || !core.motion.target_reached_masked()) return value;
      return *value & ~static_cast<std::int64_t>(model::statusword::kTargetReached);
    }
    default:
      if (is_of_another_mode(core, facts, binding) || is_of_unknown_cause(core, facts, binding)) return std::nullopt;
      return core.value(binding.quantity);
  }
}

/// Its sample hangs on more than on its own objects: on the state, the mode, or what names a fault.
bool hangs_on_state(const AxisCore& core, const model::Binding& binding) {
  switch (binding.quantity) {
    case Quantity::error_code:
    case Quantity::vendor_error:
    case Quantity::mode_display:
    case Quantity::statusword:
      return true;
    default:
      break;
  }
  return binding.object != model::kNoObject && !core.object(binding.object).aliases.empty();
}

std::uint64_t newest_change(const AxisCore& core, const model::Binding& binding) {
  std::uint64_t newest = 1;
  const auto look = [&](model::ObjectId id) {
    if (id == model::kNoObject) return;
    newest = std::max(newest, core.store.changed(id));
    if (core.object(id).emulated) newest = std::max(newest, core.store.changed(core.model.statusword));
  };
  look(binding.object);
  for (const model::BitField& field : binding.bits) look(field.object);
  return newest;
}

std::uint16_t inputs_of(const AxisCore& core, const AxisImage& image, const AxisFacts& facts) {
  const std::int64_t word = image[Quantity::statusword].value;
  const auto has = [&](std::uint16_t mask) { return (word & mask) != 0; };
  const std::int64_t digital = image[Quantity::digital_inputs].value;
  const bool limits_valid = image[Quantity::digital_inputs].valid;
  constexpr std::int64_t kLimitInputs = 0x3;
  const bool ready = !facts.faulted() && !core.alarm(AxisAlarm::local_control) &&
                     !core.alarm(AxisAlarm::identity_mismatch) && !core.alarm(AxisAlarm::profile_mismatch);
  std::uint16_t out = 0;
  const auto set = [&](AxisInput input, bool on) { out = on ? static_cast<std::uint16_t>(out | bit(input)) : out; };
  set(AxisInput::stop_latched, core.motion.latched());
  if (!image.reachable()) return out;
  set(AxisInput::online, true);
  set(AxisInput::ready, ready);
  set(AxisInput::enabled, facts.enabled());
  set(AxisInput::fault, facts.faulted());
  set(AxisInput::warning, has(model::statusword::kWarning) || image.alarms != 0);
  set(AxisInput::target_reached, facts.target_reached && !core.motion.target_reached_masked());
  set(AxisInput::homed, core.homed);
  set(AxisInput::moving, facts.moving);
  set(AxisInput::limit_active,
      has(model::statusword::kInternalLimit) || (limits_valid && (digital & kLimitInputs) != 0));
  set(AxisInput::quick_stop_active, facts.state == model::State402::quick_stop_active || core.motion.latched());
  // Bit 13 is the following error in position modes alone; in homing it means that homing failed.
  set(AxisInput::following_error, has(model::statusword::kFollowingError) && facts.mode == 1);
  return out;
}

std::uint32_t alarms_of(const AxisCore& core) {
  std::uint32_t alarms = core.alarms;
  const auto set = [&](AxisAlarm alarm, bool on) { alarms = on ? alarms | bit(alarm) : alarms; };
  set(AxisAlarm::no_comm_watchdog, core.loss_stop_ms == kGoesOn);
  set(AxisAlarm::stop_latched, core.motion.latched());
  set(AxisAlarm::not_homed, core.model.command(Command::home).has_value() && !core.homed);
  set(AxisAlarm::cannot_deenergise, core.cannot_deenergise());
  set(AxisAlarm::nvm_budget, core.nvm.alarm(core.turn.now));
  return alarms;
}

}  // namespace

void AxisWriter::show_model() {
  const model::AxisModel& model = core_.model;
  static_cast<Capabilities&>(image_) = model;
  if (model.lease.on)
    for (const Command command : {Command::release, Command::take_over})
      image_.supported_commands |= 1U << static_cast<unsigned>(command);
  image_.supported_modes = model.supported_modes;
  image_.units_per_rev = model.units_per_rev;
  image_.rated_speed = model.rated_speed;
  for (const QuantityRow& row : quantity_table())
    image_.limits[static_cast<std::size_t>(row.quantity)] = range_of(row.type);
  for (const model::Binding& binding : model.bindings)
    image_.limits[static_cast<std::size_t>(binding.quantity)] = binding.limits;
  made_.assign(model.bindings.size(), Made{});
}

void AxisWriter::make(const model::Binding& binding, const AxisFacts& facts, Made& made) {
  // What the drive refused is not supported; a drive changed for another may have it again.
  const std::uint32_t mask = bit(binding.quantity);
  const bool is_refused = refused(core_, binding);
  image_.supported = is_refused ? image_.supported & ~mask : image_.supported | (core_.model.supported & mask);
  const Instant at = confirmed_at(core_, facts, binding);
  const auto value = at == kLongAgo ? std::nullopt : shown_value(core_, facts, binding);
  Sample& sample = image_[binding.quantity];
  made.good = value && range_of(row(binding.quantity).type).holds(*value);
  if (made.good) {
    sample.value = *value;
    sample.received = true;
    sample.at = at;
  } else if (at != kLongAgo && !is_of_another_mode(core_, facts, binding)) {
    sample.received = false;  // there is a number, and no register for it: the last one that fitted is not it
  }
  const Duration limit = stale_after(core_, binding);
  made.at = at;
  made.stale_at = limit == Duration::max() || at == kLongAgo ? kNever : at + limit + Duration{1};
  const bool polled = binding.poll == model::PollClass::fast || binding.poll == model::PollClass::normal;
  made.cyclic = polled && !is_refused && !is_told_alone(core_, binding);
}

void AxisWriter::show_state() {
  const AxisFacts facts = core_.facts();
  const Instant now = core_.turn.now;
  Instant oldest = kNever;
  stale_at_ = kNever;
  for (std::size_t i = 0; i < made_.size(); ++i) {
    const model::Binding& binding = core_.model.bindings[i];
    Made& made = made_[i];
    const std::uint64_t newest = newest_change(core_, binding);
    if (made.of != newest || hangs_on_state(core_, binding)) make(binding, facts, made);
    made.of = newest;
    image_[binding.quantity].valid = made.good && image_.reachable() && now < made.stale_at;
    if (now < made.stale_at) stale_at_ = std::min(stale_at_, made.stale_at);
    if (made.cyclic) oldest = std::min(oldest, made.at);
  }
  image_.oldest_cyclic = oldest == kNever ? kLongAgo : oldest;
  image_.alarms = alarms_of(core_);
  image_.loss_stop_ms = core_.loss_stop_ms;
  image_.axis_state = core_.motion.axis_state(facts);
  image_.motion_state = core_.motion.state();
  image_.motion_id = core_.motion.id();
  image_.inputs = inputs_of(core_, image_, facts);
  const bool halted = (core_.controlword() & model::controlword::kHalt) != 0;
  image_.level_coils = static_cast<std::uint16_t>((facts.enabled() ? 1 : 0) | (halted ? 1 << 3 : 0) |
                                                  (core_.motion.running() == MotionKind::velocity ? 1 << 7 : 0));
}

namespace {

/// What should make the drive notice a dead gateway, and is not in it.
std::string unarmed(const AxisCore& core) {
  for (const model::ObjectWrite& setup : core.drive.setup) {
    const auto& loss = core.drive.loss_objects;
    const ObjectState& s = core.store[setup.object];
    if (std::ranges::find(loss, setup.object) == loss.end() || (s.known && s.number == setup.raw)) continue;
    return fmt::format(": {} (0x{:04X}) could not be set up", core.object(setup.object).name,
                       core.object(setup.object).address.index);
  }
  return {};
}

}  // namespace

std::string alarm_text(const AxisCore& core, AxisAlarm alarm) {
  if (alarm == AxisAlarm::no_comm_watchdog) return std::string(text(alarm)) + unarmed(core);
  for (const model::Check& check : core.drive.checks) {
    const ObjectState& s = core.store[check.bad.object];
    const bool found = s.known && check.bad.holds(core.object(check.bad.object), static_cast<std::uint32_t>(s.number));
    if (check.alarm == alarm && found && !check.text.empty()) return std::string(text(alarm)) + ": " + check.text;
  }
  return std::string(text(alarm));
}

}  // namespace axisgate::drive
