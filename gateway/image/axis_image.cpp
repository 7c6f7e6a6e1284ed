#include "gateway/image/axis_image.hpp"

#include <cassert>
#include <string_view>

#include "gateway/image/shown.hpp"

namespace axisgate {

std::string_view text(AxisAlarm alarm) {
  switch (alarm) {
    case AxisAlarm::no_comm_watchdog:
      return "no_comm_watchdog";
    case AxisAlarm::adopted_running:
      return "adopted_running";
    case AxisAlarm::identity_mismatch:
      return "identity_mismatch";
    case AxisAlarm::local_control:
      return "local_control";
    case AxisAlarm::limit_inputs_open:
      return "limit_inputs_open";
    case AxisAlarm::not_homed:
      return "not_homed";
    case AxisAlarm::cannot_deenergise:
      return "cannot_deenergise";
    case AxisAlarm::stop_latched:
      return "stop_latched";
    case AxisAlarm::duplicate_node:
      return "duplicate_node";
    case AxisAlarm::nvm_budget:
      return "nvm_budget";
    case AxisAlarm::clamped:
      return "clamped";
    case AxisAlarm::stop_options:
      return "stop_options";
  }
  return "?";
}

std::string_view text(LinkState state) {
  switch (state) {
    case LinkState::unknown:
      return "unknown";
    case LinkState::setup:
      return "setup";
    case LinkState::online:
      return "online";
    case LinkState::suspect:
      return "suspect";
    case LinkState::offline:
      return "offline";
    case LinkState::link_down:
      return "link_down";
  }
  return "?";
}

std::string_view text(AxisState state) {
  switch (state) {
    case AxisState::disabled:
      return "disabled";
    case AxisState::standstill:
      return "standstill";
    case AxisState::discrete_motion:
      return "discrete motion";
    case AxisState::continuous_motion:
      return "continuous motion";
    case AxisState::homing:
      return "homing";
    case AxisState::stopping:
      return "stopping";
    case AxisState::error_stop:
      return "error stop";
    case AxisState::unknown:
      return "unknown";
  }
  return "?";
}

std::uint32_t AxisImage::valid_bits() const {
  if (!reachable()) return 0;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (samples[i].valid && samples[i].received) bits |= 1U << i;
  return bits & supported;
}

bool shows_the_same(const AxisImage& a, const AxisImage& b) {
  if (a.link_state != b.link_state || a.axis_state != b.axis_state || a.motion_state != b.motion_state ||
      a.motion_id != b.motion_id || a.alarms != b.alarms || a.supported != b.supported ||
      a.valid_bits() != b.valid_bits() || shown_inputs(a) != shown_inputs(b) ||
      shown_level_coils(a) != shown_level_coils(b) || a.lease.owner != b.lease.owner) {
    return false;
  }
  for (const QuantityRow& each : quantity_table())
    if (shown_value(a, each.quantity) != shown_value(b, each.quantity)) return false;
  return true;
}

}  // namespace axisgate
