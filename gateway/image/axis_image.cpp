// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/axis_image.hpp"

#include <cassert>
#include <string_view>

#include "gateway/core/words.hpp"
#include "gateway/image/shown.hpp"

namespace axisgate {

std::string_view text(AxisAlarm alarm) { return name_of(WordKind::axis_alarm, static_cast<std::uint32_t>(alarm)); }
std::string_view text(LinkState state) { return name_of(WordKind::link_state, static_cast<std::uint32_t>(state)); }
std::string_view text(AxisState state) { return name_of(WordKind::axis_state, static_cast<std::uint32_t>(state)); }

std::uint32_t AxisImage::valid_bits() const {
  if (!reachable()) return 0;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (samples[i].valid && samples[i].received) bits |= 1U << i;
  return bits & supported;
}

LogSource log_source(AxisNumber number, const std::string& name, const std::string& bus) {
  const std::string plain = "axis " + std::to_string(number);
  return {.words = name.empty() || name == plain ? plain : plain + " " + name, .axis = number, .bus = bus};
}

bool shows_the_same(const AxisImage& a, const AxisImage& b) {
  if (a.link_state != b.link_state || a.axis_state != b.axis_state || a.motion_state != b.motion_state ||
      a.motion_id != b.motion_id || a.alarms != b.alarms || a.loss_stop_ms != b.loss_stop_ms ||
      a.supported != b.supported || a.valid_bits() != b.valid_bits() || shown_inputs(a) != shown_inputs(b) ||
      shown_level_coils(a) != shown_level_coils(b) || a.lease.owner != b.lease.owner) {
    return false;
  }
  for (const QuantityRow& each : quantity_table())
    if (shown_value(a, each.quantity) != shown_value(b, each.quantity)) return false;
  return true;
}

}  // namespace axisgate
