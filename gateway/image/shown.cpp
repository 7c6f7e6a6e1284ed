// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/shown.hpp"

#include "gateway/image/command.hpp"

namespace axisgate {
namespace {

constexpr std::uint16_t kLevelCoils =
    (1U << 0) | (1U << 3) | (1U << 7) | (1U << jog_coil(Command::jog_forward)) | (1U << jog_coil(Command::jog_reverse));
// Inputs 0..10 tell of the drive; owned_by_me and stop_latched are the gateway's own knowledge and outlive the link.
constexpr std::uint16_t kInputsOfTheDrive = (1U << 11) - 1;

}  // namespace

std::int64_t shown_value(const AxisImage& axis, Quantity quantity) {
  const Sample& sample = axis[quantity];
  if (!axis.reachable()) {
    if (quantity == Quantity::statusword) return 0;
    if (quantity == Quantity::error_code) {
      return sample.received && sample.value != 0 ? sample.value : kErrorCodeNoContact;
    }
  }
  const RegisterType type = row(quantity).type;
  if (!axis.supports(quantity) || !sample.received || !range_of(type).holds(sample.value)) {
    return no_value(type);
  }
  return sample.value;
}

std::uint16_t shown_inputs(const AxisImage& axis) {
  const auto inputs = static_cast<std::uint16_t>(axis.inputs & ~bit(AxisInput::owned_by_me));
  return axis.reachable() ? inputs : static_cast<std::uint16_t>(inputs & ~kInputsOfTheDrive);
}

std::uint16_t shown_level_coils(const AxisImage& axis) {
  return axis.reachable() ? static_cast<std::uint16_t>(axis.level_coils & kLevelCoils) : std::uint16_t{0};
}

AxisView view_of(const AxisImage& axis) {
  AxisView out{.link_state = axis.link_state,
               .axis_state = axis.axis_state,
               .motion_state = axis.motion_state,
               .motion_id = axis.motion_id,
               .alarms = axis.alarms,
               .loss_stop_ms = axis.loss_stop_ms,
               .supported = axis.supported,
               .valid = axis.valid_bits(),
               .inputs = shown_inputs(axis),
               .level_coils = shown_level_coils(axis),
               .owner = axis.lease.owner};
  for (const QuantityRow& each : quantity_table())
    out.values[static_cast<std::size_t>(each.quantity)] = shown_value(axis, each.quantity);
  return out;
}

}  // namespace axisgate
