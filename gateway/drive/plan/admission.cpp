// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/plan/admission.hpp"

#include <algorithm>
#include <array>

#include "gateway/drive/plan/planner.hpp"
#include "gateway/image/register_map.hpp"

namespace axisgate::drive {
namespace {

Errc admit_command(const AxisCore& core, Command command) {
  if (command == Command::none || command == Command::end_halt) return Errc::ok;
  // Every drive can be halted: where it has no halt, quick_stop takes its place.
  return core.model.supports(command) ? Errc::ok : Errc::not_supported;
}

// The steps of a command that is nothing but this one write.
bool is_alone(const model::Steps& steps, model::ObjectId id, std::int64_t number) {
  const auto writes = [](const model::Step& step) { return step.verb == model::Step::Verb::write; };
  const auto first = std::ranges::find_if(steps, writes);
  return first != steps.end() && std::ranges::count_if(steps, writes) == 1 && first->object == id &&
         first->source == model::Step::Source::literal && first->literal == number;
}

bool belongs_to_a_command(const AxisCore& core, model::ObjectId id) {
  return std::ranges::any_of(core.model.commands, [&](const auto& def) {
    return def && std::ranges::any_of(def->steps, [&](const model::Step& step) {
             return step.verb == model::Step::Verb::write && step.object == id;
           });
  });
}

// Registers have no bounds between objects: a write of half a target, or of a target and its neighbour, would go past
// the limits, the latch and the gate.
bool cuts_a_quantity(const AxisCore& core, const ObjectRequest& request) {
  if (!core.drive.resync.by_length) return false;
  const auto last = [](int first, std::uint8_t size) { return first + (size > 2 ? 1 : 0); };
  const auto guarded = [&](model::ObjectId id) {
    return core.object(id).mailbox_reads_only || belongs_to_a_command(core, id) ||
           std::ranges::any_of(core.model.bindings, [id](const auto& b) { return b.object == id && b.writable; });
  };
  for (std::size_t i = 0; i < core.drive.objects.size(); ++i) {
    const model::ObjectDef& object = core.drive.objects[i];
    const bool own = !object.emulated && !object.is_directed();
    if (!own || !object.writable || !guarded(static_cast<model::ObjectId>(i))) continue;
    const int first = object.address.index;
    const bool overlaps = request.index <= last(first, object.size) && last(request.index, request.size) >= first;
    if (overlaps && object.address.sub == 0 && (request.index != first || request.size != object.size)) return true;
  }
  return false;
}

// The quantity that a write of this object is one of; where several are at its place, that of the mode in force.
const model::Binding* quantity_at(const AxisCore& core, model::ObjectId id) {
  const model::Binding* found = nullptr;
  const auto of_mode = setpoint_of_mode(core.mode_in_force());
  for (const model::Binding& binding : core.model.bindings) {
    if (binding.object == model::kNoObject || !binding.writable || !same_place(core, id, binding.object)) continue;
    if (found == nullptr || of_mode == binding.quantity) found = &binding;
  }
  return found;
}

// A virtual axis's drive takes its commands as numbers in an object: by the mailbox they are the same commands, with
// the gate and the latch. What the gateway has no command for, such as the drive's own jog, would know no limit and no
// end by the dead man's button; a set-point that moves the axis by being written needs one that may start. No value: it
// is none.
std::optional<Errc> as_command(const AxisCore& core, model::ObjectId id, std::int64_t number, WriteBatch& out) {
  if (!core.is_virtual() || !core.object(id).trigger || !belongs_to_a_command(core, id)) return std::nullopt;
  constexpr std::array kCommands{Command::quick_stop,    Command::halt,          Command::fault_reset,
                                 Command::move_absolute, Command::move_relative, Command::run_velocity,
                                 Command::home};
  for (const Command command : kCommands) {
    const auto& def = core.model.command(command);
    if (!def || !is_alone(def->steps, id, number)) continue;
    out.object.reset();
    out.command = command;
    return Errc::ok;
  }
  if (number == 0) return std::nullopt;
  if (quantity_at(core, id) == nullptr) return Errc::bad_value;
  return core.motion.may_start(core.facts()) ? std::nullopt : std::optional(Errc::state_unsuitable);
}

// A further name of what a register says, another motor's object, one that moves or enables without any rule of ours
// standing before it, or, where a write is always one of a whole control frame, one that is no field of it.
bool out_of_reach(const AxisCore& core, model::ObjectId id) {
  const bool frames = !core.drive.composed.empty();
  if (id == model::kNoObject) return frames;
  const model::ObjectDef& object = core.object(id);
  if (object.mailbox_reads_only) return true;
  if (object.slot != kNoAxis && object.slot < core.drive.axes.size() && &core.drive.axes[object.slot] != &core.model)
    return true;
  if (quantity_at(core, id) != nullptr || id == core.model.controlword || id == core.model.mode) return false;
  const bool enables = core.is_virtual() && !core.model.virtual_axis->gate_only;
  return frames || object.composed || (enables && object.trigger);
}

// A width that this protocol can carry; 0 stands for all there is, and in a write for `bytes`. A register has no
// sub-index: what the wire would leave out must not make an object of its own, past limits and latch. And the last
// register that a request takes must have an address.
bool can_be_asked_for(const AxisCore& core, const ObjectRequest& request) {
  constexpr unsigned kLastRegister = 0xFFFF;
  const auto fits_a_field = [](std::size_t size) { return size == 1 || size == 2 || size == 4; };
  const bool by_length = core.drive.resync.by_length;
  const std::size_t size = request.size == 0 && !request.write ? request.count : request.size;
  if (by_length && (request.subindex != 0 || (size > 2 && request.index == kLastRegister))) return false;
  if (request.size != 0) return fits_a_field(request.size);
  if (!request.write) return !by_length || request.count == 0 || fits_a_field(request.count);
  // Longer objects, and such of 3 bytes, are carried by a chain of exchanges: CANopen alone has them.
  return model::is_canopen(core.drive) && request.bytes && !request.bytes->empty() &&
         request.bytes->size() <= kMaxObjectBytes;
}

// Row 78, as each object counts that takes it. How a drive counts that it has not told yet is judged at its turn.
bool set_position_fits(const AxisCore& core, std::int32_t value) {
  const auto fits = [&](const model::Step& step) {
    const model::Binding* unit =
        step.source == model::Step::Source::set_position ? core.model.binding(step.quantity) : nullptr;
    if (unit == nullptr || !unit->scaled) return true;
    const model::ObjectDef& object = core.object(step.object);
    const auto raw = unit->to_raw(value, object);
    return raw && object.printed.holds(*raw);
  };
  const auto& def = core.model.command(Command::set_position);
  return !def || (std::ranges::all_of(def->steps, fits) &&
                  std::ranges::all_of(def->variants, [&](const model::CommandDef::Variant& variant) {
                    return std::ranges::all_of(variant.steps, fits);
                  }));
}

// What a row of the register map has given to the write batch, alone. No value: nothing.
std::optional<WriteBatch> part_of(const WriteBatch& batch, const RegisterRow& row) {
  WriteBatch part;
  if (row.source == Source::command && batch.command != Command::none) {
    part.command = batch.command;
  } else if (row.source == Source::jog_velocity && batch.jog_velocity) {
    part.jog_velocity = batch.jog_velocity;
  } else if (row.source == Source::set_position_value && batch.set_position_value) {
    part.set_position_value = batch.set_position_value;
  } else if (row.source == Source::object_request && batch.object) {
    part.object = batch.object;
  } else if (row.source == Source::quantity && row.quantity == Quantity::controlword && batch.controlword) {
    part.controlword = batch.controlword;
  } else if (row.source == Source::quantity && row.quantity == Quantity::mode && batch.mode) {
    part.mode = batch.mode;
  } else if (row.source == Source::quantity) {
    for (const Setpoint& sp : batch.setpoints)
      if (sp.quantity == row.quantity) part.setpoints.push_back(sp);
    if (part.setpoints.empty()) return std::nullopt;
  } else {
    return std::nullopt;
  }
  return part;
}

bool is_position_limit(const RegisterRow& row) {
  return row.source == Source::quantity &&
         (row.quantity == Quantity::position_limit_min || row.quantity == Quantity::position_limit_max);
}

// A distance is no position: where the move ends is judged when it starts.
bool is_distance(const WriteBatch& batch, Quantity quantity) {
  return quantity == Quantity::target_position && batch.command == Command::move_relative;
}

// Limits of the drive's own bound where it is sent: with command 6, or by a target that is all that is asked for. One
// that merely stands in a scanner's block is held against them when it is to be moved to.
Range range_of(const AxisCore& core, const WriteBatch& batch, const model::Binding& binding) {
  const bool alone = batch.setpoints.size() == 1 && batch.command == Command::none && !batch.controlword;
  const bool sent_there = alone || batch.command == Command::move_absolute;
  return binding.quantity == Quantity::target_position && sent_there ? position_range(core, batch) : binding.limits;
}

// A button that is pressed and moves nothing, since the drive counts too coarsely, would be answered as done.
bool jog_velocity_fits(const AxisCore& core, const model::Binding& velocity, std::int64_t value) {
  if (!velocity.limits.holds(value)) return false;
  return value == 0 || !velocity.scaled || velocity.to_raw(value, core.object(velocity.object)).value_or(0) != 0;
}

std::optional<std::int64_t> limit_beyond(const Range& range, std::int64_t value) {
  if (range.holds(value)) return std::nullopt;
  return value < range.min ? range.min : range.max;
}

// Of an axis's limits, or of what its drive can count.
std::optional<std::int64_t> limit_beyond(const AxisCore& core, const model::Binding& binding, const Range& range,
                                         std::int64_t value) {
  const model::ObjectDef& object = core.object(binding.object);
  if (const auto limit = limit_beyond(range, value)) return limit;
  if (!binding.scaled || binding.to_raw(value, object)) return std::nullopt;
  const auto one = binding.to_register(object.range().min), other = binding.to_register(object.range().max);
  if (!one || !other) return std::nullopt;
  return value < 0 ? std::min(*one, *other) : std::max(*one, *other);
}

// Where a move would end.
std::optional<std::int64_t> limit_of_move(const AxisCore& core, Command command) {
  const auto wanted = core.target_position();
  const bool relative = command == Command::move_relative;
  if (!wanted || (!relative && command != Command::move_absolute)) return std::nullopt;
  const auto known = core.setpoint_position();
  const auto base = known ? known : core.value(Quantity::position_actual);
  if (relative && !base) return std::nullopt;
  return limit_beyond(position_range(core), wanted->value + (relative ? *base : 0));
}

// What is refused at its turn although each part of it could be: first what acts, since the rest goes before it.
int weight(const RegisterRow& row) {
  if (row.source == Source::object_request) return 4;
  if (row.source == Source::command) return 3;
  if (row.source != Source::quantity) return 0;
  return row.quantity == Quantity::controlword ? 2 : row.quantity == Quantity::mode ? 1 : 0;
}

}  // namespace

std::optional<PassedLimit> passed_limit(const AxisCore& core, const WriteBatch& batch) {
  const model::Binding* velocity = core.model.binding(Quantity::target_velocity);
  if (batch.jog_velocity && velocity != nullptr)
    if (const auto limit = limit_beyond(core, *velocity, velocity->limits, *batch.jog_velocity))
      return PassedLimit{Kind::velocity, *limit};
  for (const Setpoint& sp : batch.setpoints) {
    const model::Binding* binding = core.model.binding(sp.quantity);
    if (binding == nullptr || binding->object == model::kNoObject || is_distance(batch, sp.quantity)) continue;
    if (const auto limit = limit_beyond(core, *binding, range_of(core, batch, *binding), sp.value))
      return PassedLimit{row(sp.quantity).kind, *limit};
  }
  if (const auto limit = limit_of_move(core, batch.command)) return PassedLimit{Kind::position, *limit};
  return std::nullopt;
}

std::optional<std::uint16_t> refused_row(const AxisCore& core, const WriteBatch& batch, Errc code) {
  if (code != Errc::not_supported && code != Errc::bad_value) return std::nullopt;
  const bool crossed = code == Errc::bad_value && !limits_in_order(core, batch);
  const RegisterRow* acts = nullptr;
  for (const RegisterRow& row : register_table(Block::axis).rows()) {
    if (!row.writable) continue;
    const std::optional<WriteBatch> part = part_of(batch, row);
    if (!part || (row.source == Source::quantity && is_distance(batch, row.quantity))) continue;
    if (admit(core, *part) == code || (crossed && is_position_limit(row))) return row.offset;
    if (acts == nullptr || weight(row) > weight(*acts)) acts = &row;
  }
  return acts == nullptr ? std::nullopt : std::optional(acts->offset);
}

Errc admit(const AxisCore& core, const WriteBatch& batch) {
  for (const Setpoint& sp : batch.setpoints)
    if (!core.model.takes(sp.quantity)) return Errc::not_supported;
  if (batch.mode && !core.model.takes(Quantity::mode)) return Errc::not_supported;
  if (batch.controlword && !core.model.takes(Quantity::controlword)) return Errc::not_supported;
  if (batch.set_position_value && !core.model.supports(Command::set_position)) return Errc::not_supported;
  if (batch.set_position_value && !set_position_fits(core, *batch.set_position_value)) return Errc::bad_value;
  const model::Binding* velocity = core.model.binding(Quantity::target_velocity);
  if (batch.jog_velocity && (velocity == nullptr || !core.model.command(Command::run_velocity)))
    return Errc::not_supported;
  if (const Errc code = admit_command(core, batch.command); code != Errc::ok) return code;
  if (batch.object && !can_be_asked_for(core, *batch.object)) return Errc::bad_value;
  if (batch.jog_velocity && !jog_velocity_fits(core, *velocity, *batch.jog_velocity)) return Errc::bad_value;
  for (const Setpoint& sp : batch.setpoints) {
    const model::Binding* binding = core.model.binding(sp.quantity);
    if (!is_distance(batch, sp.quantity) && !range_of(core, batch, *binding).holds(sp.value)) return Errc::bad_value;
    // The drive has not told yet how it counts: nobody knows whether it could take the value.
    if (!binding->scaled) return Errc::still_in_setup;
    if (!binding->to_raw(sp.value, core.object(binding->object))) return Errc::bad_value;
    // A target may act by being written, at whatever speed and ramp the drive has.
    const bool may_act = is_target(sp.quantity) && (sp.value != 0 || sp.quantity == Quantity::target_position);
    if (may_act && !core.model.counts_known()) return Errc::still_in_setup;
    const auto& methods = core.model.homing_methods;
    if (sp.quantity == Quantity::homing_method && std::ranges::find(methods, sp.value) == methods.end())
      return Errc::bad_value;
  }
  if (batch.mode) {
    const auto& modes = core.model.modes;
    if (std::ranges::none_of(modes, [&](const auto& m) { return m.first == *batch.mode; })) return Errc::bad_value;
  }
  return limits_in_order(core, batch) ? Errc::ok : Errc::bad_value;
}

bool reads_alone(const WriteBatch& batch) {
  return batch.object && !batch.object->write && batch.setpoints.empty() && !batch.mode && !batch.controlword &&
         batch.command == Command::none && !batch.set_position_value;
}

bool stops_by_word(const WriteBatch& batch) {
  return batch.controlword && is_stop(*batch.controlword, batch.single_controlword);
}

bool holds_stop(const WriteBatch& batch) { return is_stop(batch.command) || stops_by_word(batch); }

bool stops_alone(const WriteBatch& batch) {
  return holds_stop(batch) && batch.setpoints.empty() && !batch.mode && !batch.object && !batch.set_position_value &&
         !batch.jog_velocity && (batch.command == Command::none || is_stop(batch.command)) &&
         (!batch.controlword || stops_by_word(batch));
}

bool stops_at_most(const WriteBatch& batch) { return stops_alone(batch) || batch.command == Command::jog_end; }

bool asks_to_enable(const WriteBatch& batch) {
  return batch.command == Command::enable || (batch.controlword && model::enables(*batch.controlword));
}

bool resets_fault(const WriteBatch& batch) {
  return batch.command == Command::fault_reset ||
         (batch.controlword && (*batch.controlword & model::controlword::kFaultReset) != 0);
}

bool asks_to_begin(const WriteBatch& batch) { return asks_to_enable(batch) || needs_ready(batch.command); }
WriteBatch stop_alone(const WriteBatch& batch) {
  WriteBatch out = batch;
  out.setpoints.clear();
  out.mode.reset();
  out.set_position_value.reset();
  out.jog_velocity.reset();
  out.object.reset();
  if (!is_stop(out.command)) out.command = Command::none;
  if (!stops_by_word(out)) out.controlword.reset();
  return out;
}

bool stop_latches(const AxisCore& core, const WriteBatch& batch) {
  if (batch.latches || batch.command == Command::quick_stop) return true;
  if (batch.command == Command::halt) return halt_is_quick_stop(core);
  return batch.controlword && model::request_of(*batch.controlword) == model::Request402::quick_stop;
}

bool starts_motion(const AxisCore& core, const WriteBatch& batch) {
  if (starts_motion(batch.command)) return true;
  if (!batch.controlword) return false;
  // What waits before it may enable the axis.
  const bool enabled = core.state().enabled();
  return word_starts(core, *batch.controlword, true) || (!enabled && word_starts(core, *batch.controlword, false));
}

Translated as_quantities(const AxisCore& core, const WriteBatch& batch) {
  if (!batch.object || !batch.object->write) return {batch, Errc::ok};
  const ObjectRequest& request = *batch.object;
  if (cuts_a_quantity(core, request)) return {batch, Errc::bad_value};
  const model::ObjectId id = core.drive.find({request.index, request.subindex});
  if (out_of_reach(core, id)) return {batch, Errc::bad_value};
  if (id == model::kNoObject) return {batch, Errc::ok};
  const model::ObjectDef& object = core.object(id);
  WriteBatch out = batch;
  if (const auto trigger = as_command(core, id, object.number(request.data), out)) {
    if (request.size != object.size) return {batch, Errc::bad_value};
    return {out, *trigger};
  }
  const model::Binding* binding = quantity_at(core, id);
  out.object.reset();
  const bool of_a_quantity = id == core.model.controlword || id == core.model.mode || binding != nullptr;
  if (!of_a_quantity) return {batch, Errc::ok};
  // A width of its own would cut the value, behind the limits' back.
  if (request.size != object.size) return {batch, Errc::bad_value};
  const std::int64_t number = object.number(request.data);
  if (id == core.model.controlword) {
    out.controlword = static_cast<std::uint16_t>(request.data);
    out.single_controlword = true;
  } else if (id == core.model.mode) {
    const auto& modes = core.model.modes;
    const auto known = std::ranges::find_if(modes, [&](const auto& m) { return m.second == number; });
    if (known == modes.end()) return {batch, Errc::bad_value};
    out.mode = known->first;
  } else {
    if (!binding->scaled) return {batch, Errc::still_in_setup};
    const auto value = binding->to_register(number);
    if (!value) return {batch, Errc::bad_value};  // not representable in register units: outside every limit
    out.setpoints.push_back({binding->quantity, *value, number});
  }
  return {out, Errc::ok};
}

bus::BusJob job_for(const AxisCore& core, const WriteBatch& batch, bool stop) {
  bus::BusJob job;
  if (stop) {
    job.priority = bus::Priority::stop;  // without a start deadline: a stop is never given up for being late
    return job;
  }
  job.start_by = batch.start_by;
  const bool setpoints = !batch.setpoints.empty() || batch.set_position_value;
  const bool plain = !batch.mode && !batch.controlword && batch.command == Command::none;
  if (batch.object && plain && !setpoints) {
    job.priority = bus::Priority::interactive;
    job.survives_stop = true;
    // Reads of one object may be one, where both want it in the same width.
    if (!batch.object->write && batch.object->size != 0)
      job.read = bus::PlainRead{{batch.object->index, batch.object->subindex}, batch.object->size};
    return job;
  }
  job.setpoints_only = plain && !batch.object && !batch.set_position_value;
  job.survives_stop = plain;
  for (const Setpoint& sp : batch.setpoints) {
    if (is_target(sp.quantity)) job.survives_stop = false;
    job.writes.push_back(core.object(core.model.binding(sp.quantity)->object).place());
  }
  std::ranges::sort(job.writes);
  return job;
}

}  // namespace axisgate::drive
