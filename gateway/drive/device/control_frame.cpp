// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/control_frame.hpp"

#include <algorithm>

#include "gateway/drive/plan/action.hpp"

namespace axisgate::drive {
namespace {

constexpr int kModePosition = 1, kModeTorque = 4;

}  // namespace

bool ControlFrame::carries(const bus::Exchange& write) const {
  return write.access == bus::Access::write &&
         std::ranges::any_of(model_.composed, [&](auto id) { return model_.object(id).address == write.object; });
}

ControlFrame::Motor ControlFrame::motor(AxisSlot slot) const {
  Motor out;
  for (const model::ObjectId id : model_.composed)
    if (model_.object(id).slot == slot) (model_.object(id).turns_on ? out.on : out.value) = id;
  return out;
}

// A motor that was never told anything and shows enabled was found so: it stays so.
bool ControlFrame::on(const ObjectState& commanded, const MotorShows& shows) const {
  if (shows.disabling) return false;
  const bool was_on = commanded.known && commanded.number != 0;
  return was_on ? shows.enabled || shows.enabling : shows.enabled && !commanded.known;
}

std::optional<std::int64_t> ControlFrame::value(const ObjectState& commanded, const MotorShows& shows, bool on,
                                                bool stop) const {
  if (shows.mode == kModePosition) {
    if (commanded.known) return commanded.number;
    // Never commanded: 0 would be a place to go to. It stays where it is, once that is known and stands still.
    const bool here = shows.position && (!shows.moving || stop);
    if (here || !on) return shows.position.value_or(0);
    return std::nullopt;
  }
  // Whether a code without this motor's bit disables it is not printed: it would stand then.
  if (!on) return 0;
  if (commanded.known) return commanded.number;
  // Found running, or holding by torque: nobody knows at what. Only a stop may make it 0.
  if (stop || (!shows.moving && shows.mode != kModeTorque)) return 0;
  return std::nullopt;
}

std::optional<ControlFrame::Desired> ControlFrame::desired(const bus::Exchange& write, const ObjectStore& store,
                                                           AxisSlot slot, const MotorShows& shows, bool stop) const {
  const Motor fields = motor(slot);
  if (fields.on == model::kNoObject || fields.value == model::kNoObject) return Desired{};
  const bool written_here = model_.object(fields.on).address == write.object;
  const bool is_on = written_here ? write.raw != 0 : on(store[fields.on], shows);
  if (model_.object(fields.value).address == write.object) return Desired{is_on, 0};
  if (const auto told = value(store[fields.value], shows, is_on, stop)) return Desired{is_on, *told};
  // A stop whose neighbour has no place to stand at turns it off: nothing else is known to be harmless.
  return stop ? std::optional(Desired{}) : std::nullopt;
}

std::optional<bus::Exchange> ControlFrame::complete(const bus::Exchange& write, const ObjectStore& store,
                                                    const std::vector<MotorShows>& motors, bool stop) const {
  bus::Exchange out = write;
  for (const model::ObjectId id : model_.composed) {
    const model::ObjectDef& field = model_.object(id);
    if (field.address == write.object) continue;
    Desired wanted{};  // of a motor that no axis is configured for: off
    if (field.slot < motors.size()) {
      const auto known = desired(write, store, field.slot, motors[field.slot], stop);
      if (!known) return std::nullopt;
      wanted = *known;
    }
    const std::int64_t number = field.turns_on ? (wanted.on ? 1 : 0) : wanted.value;
    out.more.push_back({field.address, field.size, wire_bits(number, field.size)});
  }
  return out;
}

}  // namespace axisgate::drive
