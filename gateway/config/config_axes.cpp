// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "gateway/config/config_sections.hpp"

namespace axisgate::config {
namespace {

Rational read_units(const JsonNode& node, ConfigFaults& faults) {
  const Rational otherwise = AxisConfig{}.units_per_rev;
  const JsonNode units = node["units_per_rev"];
  if (faults.within(units.pointer())) return otherwise;
  if (const auto whole = units.integer()) return Rational(*whole);
  const auto numerator = units.integer("numerator");
  const auto denominator = units.integer("denominator");
  return numerator && denominator ? Rational(*numerator, *denominator) : otherwise;
}

profile::AxisLimits read_limits(const JsonNode& node, ConfigFaults& faults) {
  profile::AxisLimits limits;
  const JsonNode object = node["limits"];
  limits.velocity = object.integer("velocity");
  limits.acceleration = object.integer("acceleration");
  limits.torque = object.integer("torque");
  limits.quick_stop_deceleration_min = object.integer("quick_stop_deceleration_min");
  const auto ends = object["position"].items();
  if (ends.size() != 2 || !ends[0].integer() || !ends[1].integer()) return limits;
  limits.position = Range{*ends[0].integer(), *ends[1].integer()};
  if (limits.position->min >= limits.position->max) {
    faults.add(object.pointer("position"),
               fmt::format("the smallest position {} is not below the largest {}: write [smallest, largest]",
                           limits.position->min, limits.position->max));
  }
  return limits;
}

void read_lease(const JsonNode& node, AxisConfig& axis, ConfigFaults& faults) {
  const JsonNode lease = node["lease"];
  if (!lease) return;
  axis.lease.on = !lease.is_null();
  axis.lease.timeout = lease.milliseconds("timeout_ms", axis.lease.timeout);
  const std::string renew = lease.text("renew");
  if (renew == "write") axis.lease.renew = LeaseRenewal::write;
  if (renew == "heartbeat") axis.lease.renew = LeaseRenewal::heartbeat;
  const std::string on_expiry = lease.string("on_expiry").value_or("quick_stop");
  axis.lease.on_expiry = LeaseAction::none;
  for (const LeaseAction action : {LeaseAction::quick_stop, LeaseAction::halt, LeaseAction::disable}) {
    if (on_expiry == axisgate::text(command_of(action))) axis.lease.on_expiry = action;
  }
  if (axis.vertical && axis.lease.on && axis.lease.on_expiry == LeaseAction::disable) {
    faults.add(lease.pointer("on_expiry"),
               "disable takes the torque away at once, and a vertical axis falls until its brake holds: write "
               "quick_stop or halt");
  }
}

model::WatchRules read_watch(const JsonNode& node) {
  model::WatchRules watch;
  const JsonNode object = node["watch"];
  watch.travel = object["travel_rev"].rational().value_or(watch.travel);
  watch.settle = object.milliseconds("settle_ms", watch.settle);
  const std::string reaction = object.text("reaction");
  if (reaction == "stop") watch.reaction = model::WatchReaction::stop;
  if (reaction == "off") watch.reaction = model::WatchReaction::off;
  watch.units = object.string("units") != "off";
  return watch;
}

}  // namespace

AxisConfig read_axis(const JsonNode& node, ConfigFaults& faults) {
  AxisConfig axis;
  axis.pointer = node.pointer();
  if (!faults.within(node.pointer("axis"))) axis.number = static_cast<AxisNumber>(node.integer("axis").value_or(0));
  axis.name = node.string("name").value_or(fmt::format("axis {}", axis.number));
  axis.units_per_rev = read_units(node, faults);
  axis.inverted = node.text("direction") == "inverted";
  axis.limits = read_limits(node, faults);
  axis.standstill_velocity = node.integer("standstill_velocity").value_or(axis.standstill_velocity);
  axis.homing_timeout = node.milliseconds("homing_timeout_ms", axis.homing_timeout);
  if (const auto method = node.integer("homing_method"); method && !faults.within(node.pointer("homing_method"))) {
    axis.homing_method = static_cast<std::int16_t>(*method);
  }
  axis.jog_timeout = node.milliseconds("jog_timeout_ms", axis.jog_timeout);
  axis.motor = node.text("motor");
  axis.vertical = node.flag("vertical", false);
  axis.metres_per_rev = read_metres_per_rev(node, faults);
  read_lease(node, axis, faults);
  axis.watch = read_watch(node);
  return axis;
}

}  // namespace axisgate::config
