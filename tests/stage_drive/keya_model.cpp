// SPDX-License-Identifier: Apache-2.0
// The model of the drive that keya_rig plays, made by hand from what its makers print.
#include "tests/stage_drive/keya_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using model::AxisModel;
using model::Binding;
using model::CommandDef;
using model::Condition;
using model::DriveModel;
using model::ObjectDef;
using model::ObjectId;
using model::PollClass;
using model::Step;
using model::Steps;

struct Maker {
  DriveModel model;
  const KeyaOptions& options;

  ObjectId add(const std::string& name, AxisSlot slot, ObjectAddress address, std::uint8_t size, bool is_signed) {
    ObjectDef def;
    def.name = name;
    def.slot = slot;
    def.address = address;
    def.size = size;
    def.is_signed = is_signed;
    model.objects.push_back(def);
    return static_cast<ObjectId>(model.objects.size() - 1);
  }
  ObjectDef& at(ObjectId id) { return model.objects[id]; }
  ObjectId command(const std::string& name, AxisSlot slot, std::uint16_t index, std::uint8_t motor) {
    const ObjectId id = add(name, slot, {index, motor}, 4, true);
    at(id).readable = false;
    at(id).writable = at(id).trigger = true;
    return id;
  }
  ObjectId emulated(const std::string& name, AxisSlot slot, std::uint8_t size) {
    const ObjectId id = add(name, slot, {}, size, size == 1);
    at(id).emulated = at(id).writable = true;
    return id;
  }
};

struct Motor {
  ObjectId fault, speed, position, temperature, enable, disable, velocity, torque, target;
};

Step write(ObjectId object, std::int64_t number) {
  Step step;
  step.object = object;
  step.literal = number;
  return step;
}

Step write(ObjectId object, Quantity quantity) {
  Step step = write(object, 0);
  step.source = Step::Source::quantity;
  step.quantity = quantity;
  return step;
}

Condition state(ObjectId fault, std::int64_t disabled) {
  Condition c;
  c.object = fault;
  c.mask = 1;
  c.values = {disabled};
  return c;
}

Step wait_for(const Condition& condition) {
  Step step;
  step.verb = Step::Verb::wait;
  step.object = condition.object;
  step.until = condition;
  step.limit = 300ms;
  step.otherwise = Errc::not_reached;
  return step;
}

Motor make_motor(Maker& make, AxisSlot slot, bool configured) {
  const std::string name = slot == 0 ? "A." : "B.";
  const auto number = static_cast<std::uint8_t>(slot + 1);
  const bool composed = make.options.speech == Speech::composed;
  const auto at = [&](std::uint8_t byte) { return static_cast<std::uint8_t>(slot * byte); };
  Motor out{};
  const AxisSlot owner = configured ? slot : kNoAxis;
  out.fault = make.add(name + "fault", owner, {kFaultQuery, 1, at(2)}, 2, false);
  out.speed = make.add(name + "speed", owner, {kSpeedQuery, 1, at(2)}, 2, true);
  out.position =
      composed ? make.add(name + "position", owner, {kPositionQuery, 0, at(4)}, 4, true)
               : make.add(name + "position", owner, {kPositionQuery, static_cast<std::uint8_t>(slot + 2)}, 4, true);
  out.temperature =
      make.add(name + "temperature", owner, {kTemperatureQuery, 1, static_cast<std::uint8_t>(slot + 2)}, 1, true);
  out.enable = make.command(name + (composed ? "on" : "enable"), owner, kEnable, number);
  out.velocity = make.command(name + "velocity", owner, kValue, number);
  if (!composed) {
    out.disable = make.command(name + "disable", owner, kDisable, number);
    out.torque = make.command(name + "torque", owner, kTorqueValue, number);
    out.target = make.command(name + "target", owner, kPositionValue, number);
    return out;
  }
  out.disable = out.enable;
  out.torque = make.command(name + "torque", owner, kValue, number);
  out.target = make.command(name + "target", owner, kValue, number);
  for (const ObjectId id : {out.enable, out.velocity, out.torque, out.target}) make.at(id).composed = true;
  make.at(out.enable).turns_on = true;
  make.at(out.velocity).aliases = {out.torque, out.target};
  make.at(out.torque).aliases = {out.velocity, out.target};
  make.at(out.target).aliases = {out.velocity, out.torque};
  make.model.composed.push_back(out.enable);
  make.model.composed.push_back(out.velocity);
  return out;
}

void bind(AxisModel& axis, Quantity quantity, ObjectId object, Rational scale, PollClass poll, bool writable) {
  Binding binding;
  binding.quantity = quantity;
  binding.object = object;
  binding.raw_per_unit = scale;
  binding.poll = poll;
  binding.writable = writable;
  binding.limits = range_of(row(quantity).type);
  axis.supported |= bit(quantity);
  if (writable) axis.writable |= bit(quantity);
  axis.bindings.push_back(binding);
}

void give(AxisModel& axis, Command command, CommandDef def) {
  axis.commands[static_cast<std::size_t>(command)] = std::move(def);
  axis.supported_commands |= 1U << static_cast<unsigned>(command);
}

bool has_mode(const AxisModel& axis, std::int16_t mode) {
  return std::any_of(axis.modes.begin(), axis.modes.end(), [&](const auto& m) { return m.first == mode; });
}

void make_commands(AxisModel& axis, const Motor& motor, bool composed) {
  const Condition on = state(motor.fault, 0), off = state(motor.fault, 1);
  give(axis, Command::enable, {{}, {write(motor.enable, composed ? 1 : 0), wait_for(on)}});
  const Steps turn_off{write(motor.disable, 0), wait_for(off)};
  give(axis, Command::disable, {{}, turn_off});
  CommandDef quick, halt;
  const auto stand = [&](std::int16_t mode, const Step& stop) {
    Steps steps{stop};
    halt.variants.push_back({{mode}, steps});
    steps.insert(steps.end(), turn_off.begin(), turn_off.end());
    quick.variants.push_back({{mode}, steps});
  };
  stand(1, write(motor.target, Quantity::position_actual));
  stand(3, write(motor.velocity, 0));
  stand(4, write(motor.torque, 0));
  quick.steps = turn_off;
  give(axis, Command::quick_stop, quick);
  give(axis, Command::halt, halt);
  if (has_mode(axis, 1)) give(axis, Command::move_absolute, {{}, {write(motor.target, Quantity::target_position)}});
  if (has_mode(axis, 3)) give(axis, Command::run_velocity, {{}, {write(motor.velocity, Quantity::target_velocity)}});
}

AxisModel make_axis(Maker& make, AxisSlot slot, const Motor& motor) {
  AxisModel axis;
  axis.number = static_cast<AxisNumber>(slot + 1);
  axis.name = slot == 0 ? "left" : "right";
  axis.lease = make.options.lease;
  const std::string name = slot == 0 ? "A." : "B.";
  axis.statusword = make.emulated(name + "statusword", slot, 2);
  axis.controlword = make.emulated(name + "controlword", slot, 2);
  axis.mode = axis.mode_display = make.emulated(name + "mode", slot, 1);
  axis.cia402.mode_display = false;
  axis.fault_words[0] = motor.fault;
  for (const std::int16_t mode : make.options.modes) axis.modes.emplace_back(mode, mode);
  axis.mode_needs_disabled = true;
  bind(axis, Quantity::statusword, axis.statusword, Rational(1), PollClass::fast, false);
  bind(axis, Quantity::mode_display, axis.mode, Rational(1), PollClass::normal, false);
  bind(axis, Quantity::position_actual, motor.position, Rational(1), PollClass::fast, false);
  bind(axis, Quantity::velocity_actual, motor.speed, Rational(1, 1000), PollClass::fast, false);
  bind(axis, Quantity::motor_temperature, motor.temperature, Rational(1, 10), PollClass::slow, false);
  bind(axis, Quantity::controlword, axis.controlword, Rational(1), PollClass::normal, true);
  bind(axis, Quantity::mode, axis.mode, Rational(1), PollClass::normal, true);
  if (has_mode(axis, 1)) bind(axis, Quantity::target_position, motor.target, Rational(1), PollClass::normal, true);
  if (has_mode(axis, 3))
    bind(axis, Quantity::target_velocity, motor.velocity, Rational(1, 150), PollClass::normal, true);
  if (has_mode(axis, 4)) bind(axis, Quantity::target_torque, motor.torque, Rational(10), PollClass::normal, true);
  axis.binding_of.fill(-1);
  for (std::size_t i = 0; i < axis.bindings.size(); ++i)
    axis.binding_of[static_cast<std::size_t>(axis.bindings[i].quantity)] = static_cast<std::int16_t>(i);
  model::VirtualProperties facts;
  facts.enabled = state(motor.fault, 0);
  facts.fault = facts.enabled;
  facts.fault.mask = 0x3FFE;
  facts.fault.test = Condition::Test::not_equals;
  facts.within = 10;
  facts.quick_stop_energised = false;
  axis.virtual_axis = facts;
  axis.state_sources = {motor.fault};
  if (make.options.keep_alive > Duration{}) axis.keep_alive = {{1, motor.target}, {3, motor.velocity}};
  make_commands(axis, motor, make.options.speech == Speech::composed);
  return axis;
}

}  // namespace

model::DriveModel keya_model(const KeyaOptions& options) {
  Maker make{{}, options};
  DriveModel& model = make.model;
  model.protocol = options.speech == Speech::composed ? "keya-rs232" : "keya-can";
  std::vector<Motor> motors;
  for (AxisSlot slot = 0; slot < 2; ++slot) motors.push_back(make_motor(make, slot, slot < options.axes));
  const ObjectId temperature = make.add("temperature", kNoAxis, {kTemperatureQuery, 1}, 2, true);
  const ObjectId angle = make.add("A.angle", 0, {0x0700, 0}, 2, false);
  make.at(angle).readable = false;
  for (int i = 0; i < options.axes; ++i) {
    const auto slot = static_cast<AxisSlot>(i);
    AxisModel axis = make_axis(make, slot, motors[slot]);
    bind(axis, Quantity::drive_temperature, temperature, Rational(1, 10), PollClass::slow, false);
    axis.binding_of[static_cast<std::size_t>(Quantity::drive_temperature)] =
        static_cast<std::int16_t>(axis.bindings.size() - 1);
    model.axes.push_back(std::move(axis));
  }
  model.keep_alive = options.keep_alive;
  model.resync.candidates = {{motors[0].fault, 0}, {motors[0].speed, 0}, {motors[0].position, 0}};
  model.resync.worst_reply = 200ms;
  if (options.unsolicited) {
    model.unsolicited.every = options.unsolicited_every;
    // One motor's temperature comes by itself and by nothing else, the other's in both ways.
    make.at(motors[0].temperature).address = {0x0700, 1};
    make.at(motors[0].temperature).readable = false;
    model.unsolicited.objects = {angle, motors[0].fault, motors[0].temperature, motors[1].temperature};
  }
  return std::move(make.model);
}

}  // namespace axisgate::test
