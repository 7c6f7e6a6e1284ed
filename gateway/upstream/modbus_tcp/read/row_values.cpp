// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/read/row_values.hpp"

#include <algorithm>
#include <cassert>

#include "gateway/image/shown.hpp"
#include "gateway/upstream/modbus_tcp/client/peer.hpp"

namespace axisgate::modbus_tcp {
namespace {

std::uint32_t client_value(const RegisterRow& row, const AxisImage& axis, const Onlooker& onlooker) {
  static const ClientAxis kNothingYet;
  const ClientAxis* found = onlooker.client.find(axis.number);
  const ClientAxis& own = found != nullptr ? *found : kNothingYet;
  const LatestResult& result = own.used ? own.result : axis.latest;
  switch (row.source) {
    case Source::command_result:
      // The drive had shown the stop, and its motor has turned on since.
      if (result.result == CommandResult::done && result.stop != 0 && result.stop == axis.unheeded_stop)
        return static_cast<std::uint32_t>(CommandResult::not_reached);
      return static_cast<std::uint32_t>(result.result);
    case Source::command_detail:
      return result.detail;
    // A program counts on from it. An id that was only remembered is not among those seen.
    case Source::command_id_seen:
      return onlooker.client.seen_id(axis.number).value_or(result.command_id);
    case Source::command:
      return own.edges.last_command();
    case Source::command_id:
      return own.command_id;
    case Source::heartbeat:
      return own.heartbeat.value_or(0);
    case Source::object_request:
      return own.mailbox.request;
    case Source::object_index:
      return own.mailbox.index;
    case Source::object_subindex:
      return own.mailbox.subindex;
    case Source::object_size:
      return own.mailbox.size;
    case Source::object_data:
      return own.mailbox.data;
    case Source::object_status:
      return static_cast<std::uint32_t>(own.mailbox.status);
    case Source::object_detail:
      return own.mailbox.detail;
    default:
      break;
  }
  assert(false);
  return 0;
}

std::uint32_t owner(const Lease& lease, ClientId onlooker) {
  enum : std::uint32_t { nobody = 0, this_client = 1, another = 2 };
  if (!lease.owner) return nobody;
  return lease.owned_by(onlooker) ? this_client : another;
}

std::uint32_t owner_address(const Lease& lease) {
  // A DDS writer's GUID is no address, whatever its bytes.
  if (!lease.owner || lease.owner->strength || !is_mapped(lease.owner->origin)) return 0;
  const Origin& origin = lease.owner->origin;
  return static_cast<std::uint32_t>(load_be16(origin, kMappedBytes) << 16) | load_be16(origin, kMappedBytes + 2);
}

std::uint32_t lease_remaining(const Lease& lease, Instant now) {
  const Instant until = lease.until();
  if (until == kNever) return 0;
  return static_cast<std::uint32_t>(std::min<std::int64_t>(elapsed_ms(now, until), UINT16_MAX));
}

std::uint32_t age(Instant oldest, Instant now) {
  return static_cast<std::uint32_t>(std::min<std::int64_t>(elapsed_ms(oldest, now), UINT16_MAX));
}

}  // namespace

std::uint32_t axis_value(const RegisterRow& row, const AxisImage& axis, const Onlooker& onlooker) {
  switch (row.source) {
    case Source::quantity:
      return static_cast<std::uint32_t>(shown_value(axis, row.quantity));
    case Source::link_state:
      return static_cast<std::uint32_t>(axis.link_state);
    case Source::age_ms:
      return age(axis.oldest_cyclic, onlooker.now);
    case Source::supported:
      return axis.supported;
    case Source::valid:
      return axis.valid_bits();
    case Source::sequence:
      return axis.sequence & 0xFFFFU;
    case Source::axis_state:
      return static_cast<std::uint32_t>(axis.axis_state);
    case Source::motion_state:
      return static_cast<std::uint32_t>(axis.motion_state);
    case Source::motion_id:
      return axis.motion_id;
    case Source::axis_alarms:
      return axis.alarms;
    case Source::supported_commands:
      return axis.supported_commands;
    case Source::supported_modes:
      return axis.supported_modes;
    case Source::owner:
      return owner(axis.lease, onlooker.client.id);
    case Source::lease_remaining_ms:
      return lease_remaining(axis.lease, onlooker.now);
    case Source::units_numerator:
      return static_cast<std::uint32_t>(axis.units_per_rev.numerator());
    case Source::units_denominator:
      return static_cast<std::uint32_t>(axis.units_per_rev.denominator());
    case Source::rated_speed:
      return axis.rated_speed.value_or(static_cast<std::uint32_t>(no_value(RegisterType::u32)));
    case Source::loss_stop_ms:
      return axis.loss_stop_ms;
    case Source::owner_address:
      return owner_address(axis.lease);
    case Source::jog_velocity:
      return axis.jog_velocity;
    case Source::set_position_value:
      return static_cast<std::uint32_t>(onlooker.commands.set_position_value(axis.number));
    default:
      return client_value(row, axis, onlooker);
  }
}

std::uint32_t gateway_value(const RegisterRow& row, const Onlooker& onlooker) {
  const GatewayImage& gateway = onlooker.image.gateway;
  switch (row.source) {
    case Source::map_version:
      return kMapVersion;
    case Source::axis_count:
      return static_cast<std::uint32_t>(onlooker.image.axes().size());
    case Source::gateway_state:
      return static_cast<std::uint32_t>(gateway.state);
    case Source::axes_online:
      return gateway.axes_online;
    case Source::uptime_s:
      return gateway.uptime_s;
    case Source::gateway_alarms:
      return gateway.alarms;
    case Source::role:
      return static_cast<std::uint32_t>(onlooker.role);
    case Source::gateway_heartbeat:
      return onlooker.client.heartbeat;
    case Source::word_order_test:
      return kWordOrderTest;
    default:
      break;
  }
  assert(false);
  return 0;
}

std::uint32_t bus_value(const RegisterRow& row, const BusImage& bus) {
  switch (row.source) {
    case Source::bus_link:
      return bus.link;
    case Source::bus_load:
      return bus.load_permille;
    case Source::bus_cycle_ms:
      return bus.cycle_ms;
    case Source::bus_queue_depth:
      return bus.queue_depth;
    case Source::bus_requests:
      return bus.requests;
    case Source::bus_replies:
      return bus.replies;
    case Source::bus_timeouts:
      return bus.timeouts;
    case Source::bus_bad_frames:
      return bus.bad_frames;
    case Source::bus_late_replies:
      return bus.late_replies;
    case Source::bus_dropped_bytes:
      return bus.dropped_bytes;
    case Source::bus_refused:
      return bus.refused;
    case Source::bus_coalesced:
      return bus.coalesced;
    case Source::bus_superseded:
      return bus.superseded;
    case Source::bus_reconnects:
      return bus.reconnects;
    case Source::bus_echoes:
      return bus.echoes;
    default:
      break;
  }
  assert(false);
  return 0;
}

std::int64_t number_of(std::uint32_t bits, RegisterType type) {
  switch (type) {
    case RegisterType::u16:
      return static_cast<std::uint16_t>(bits);
    case RegisterType::i16:
      return static_cast<std::int16_t>(bits);
    case RegisterType::u32:
      return bits;
    case RegisterType::i32:
      return static_cast<std::int32_t>(bits);
  }
  return 0;
}

}  // namespace axisgate::modbus_tcp
