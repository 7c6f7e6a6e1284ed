// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web/axis_records.hpp"

#include <algorithm>

#include "gateway/image/shown.hpp"

namespace axisgate::web {
namespace {

static_assert(kMaxQuantities == kQuantityCount);

template <typename Unit>
std::uint32_t since(Instant then, Instant now) {
  if (then == kLongAgo) return UINT32_MAX;
  const auto units = std::chrono::duration_cast<Unit>(now - then).count();
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(units, 0, UINT32_MAX));
}

std::uint32_t lease_ms(const Lease& lease, Instant now) {
  const Instant until = lease.until();
  return until == kNever ? UINT32_MAX : since<std::chrono::milliseconds>(now, until);
}

}  // namespace

AxisInfoRecord axis_info(const AxisImage& axis, const AxisFacts& facts) {
  AxisInfoRecord out;
  out.axis = axis.number;
  out.name = axis.name;
  out.bus = axis.bus;
  out.drive = facts.drive;
  out.profile = facts.profile;
  out.node = facts.node;
  out.units_numerator = axis.units_per_rev.numerator();
  out.units_denominator = axis.units_per_rev.denominator();
  out.rated_speed = axis.rated_speed.value_or(0);
  out.supported_modes = axis.supported_modes;
  out.writable = axis.writable;
  out.supported_commands = axis.supported_commands;
  for (const QuantityRow& row : quantity_table()) {
    if (!axis.takes(row.quantity)) continue;
    const Range& limit = axis.limit(row.quantity);
    out.limits.push_back({static_cast<std::uint8_t>(row.quantity), limit.min, limit.max});
  }
  return out;
}

AxisSample axis_sample(const AxisImage& axis, SentValues& sent, Instant now) {
  using std::chrono::microseconds, std::chrono::milliseconds;
  AxisSample out;
  out.axis = axis.number;
  out.sequence = axis.sequence;
  out.link_state = static_cast<std::uint8_t>(axis.link_state);
  out.axis_state = static_cast<std::uint8_t>(axis.axis_state);
  out.motion_state = static_cast<std::uint8_t>(axis.motion_state);
  out.motion_id = axis.motion_id;
  out.alarms = axis.alarms;
  out.supported = axis.supported;
  out.valid = axis.valid_bits();
  out.inputs = shown_inputs(axis);
  out.level_coils = shown_level_coils(axis);
  out.loss_stop_ms = axis.loss_stop_ms;
  out.jog_velocity = axis.jog_velocity;
  out.age_ms = since<milliseconds>(axis.oldest_cyclic, now);
  if (axis.lease.owner) out.owner = axis.lease.owner->name;
  out.lease_ms = lease_ms(axis.lease, now);
  out.result = static_cast<std::uint8_t>(axis.latest.result);
  out.result_detail = axis.latest.detail;
  out.result_id = axis.latest.command_id;
  if (axis.latest.by) out.result_who = axis.latest.by->name;
  out.result_what = axis.latest.what;
  out.result_age_ms = since<milliseconds>(axis.latest.at, now);
  for (std::size_t i = 0; i < kQuantityCount; ++i) {
    const auto quantity = static_cast<Quantity>(i);
    const Sample& sample = axis[quantity];
    if (!axis.supports(quantity) || !sample.received) continue;
    const std::int64_t value = shown_value(axis, quantity);
    if (!sent.is_new(i, value, sample.at)) continue;
    out.values.push_back(
        {static_cast<std::uint8_t>(i), static_cast<std::int32_t>(value), since<microseconds>(sample.at, now)});
  }
  return out;
}

std::size_t size_bound(const AxisSample& sample) {
  constexpr std::size_t kFixed = 128, kEachValue = 9;
  return kFixed + std::min(sample.owner.size(), kMaxName) + std::min(sample.result_who.size(), kMaxName) +
         std::min(sample.result_what.size(), kMaxName) + kEachValue * sample.values.size();
}

}  // namespace axisgate::web
