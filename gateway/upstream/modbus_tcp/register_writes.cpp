#include "gateway/upstream/modbus_tcp/claims.hpp"
#include "gateway/upstream/modbus_tcp/row_writes.hpp"
#include "gateway/upstream/modbus_tcp/write_plan.hpp"

namespace axisgate::modbus_tcp {
namespace {

bool is_quantity(const RegisterRow& row, Quantity quantity) {
  return row.source == Source::quantity && row.quantity == quantity;
}

/// Registers 80..85 as they will be; whether the request in them can be made.
struct MailboxWrite {
  Mailbox mailbox;
  bool requested = false;
  Errc refused = Errc::ok;
};

MailboxWrite write_mailbox(const RowWrites& found, const Mailbox& before) {
  MailboxWrite write{before, false, Errc::ok};
  Mailbox& box = write.mailbox;
  for (const RowWrite& each : found.rows) {
    const auto word = static_cast<std::uint16_t>(each.value);
    switch (each.row->source) {
      case Source::object_request:
        box.request = word;
        break;
      case Source::object_index:
        box.index = word;
        break;
      case Source::object_subindex:
        box.subindex = word;
        break;
      case Source::object_size:
        box.size = word;
        break;
      case Source::object_data:
        box.data = static_cast<std::uint32_t>(each.value);
        break;
      default:
        break;
    }
  }
  write.requested = found.of(Source::object_request) != nullptr && box.request != 0;
  if (!write.requested) return write;
  const bool possible = (box.size == 1 || box.size == 2 || box.size == 4) && box.subindex <= UINT8_MAX;
  if (!possible)
    write.refused = Errc::bad_value;
  else if (before.status == ObjectStatus::busy)
    write.refused = Errc::busy;
  return write;
}

void put_command(const RowWrite& command, const RowWrite* id, Host& host, AxisNumber axis, ClientAxis& own,
                 const Writing& writing, Group& group) {
  const auto asked = Command{static_cast<std::uint8_t>(command.value)};
  const bool has_id = id != nullptr && id->value != 0;
  const bool acts =
      has_id ? own.edges.command_with_id(asked, static_cast<std::uint16_t>(id->value), host.ids[axis], writing.now)
             : own.edges.command(asked, writing);
  if (acts) group.command = asked;
}

/// Everything was checked: remembers what is the client's own and makes the group of what is the axis's.
Group make_group(const RowWrites& found, const Onlooker& onlooker, Client& client) {
  const AxisNumber axis = found.axis->number;
  ClientAxis& own = client.at(axis);
  const bool single = found.rows.size() == 1;
  const Writing writing{single ? WriteForm::single : WriteForm::block, onlooker.now, onlooker.settings.rearm};
  const RowWrite* id = found.of(Source::command_id);
  Group group = client.new_group(onlooker.role);
  for (const RowWrite& each : found.rows) {
    if (each.skipped) continue;
    const auto word = static_cast<std::uint16_t>(each.value);
    switch (each.row->source) {
      case Source::quantity:
        if (is_quantity(*each.row, Quantity::mode)) {
          group.mode = static_cast<std::int16_t>(each.value);
        } else if (!is_quantity(*each.row, Quantity::controlword)) {
          group.setpoints.push_back({each.row->quantity, each.value});
        } else if (own.edges.controlword(word, writing)) {
          group.controlword = word;
          group.single_controlword = single;
        }
        break;
      case Source::set_position_value:
        group.set_position_value = static_cast<std::int32_t>(each.value);
        break;
      case Source::command:
        put_command(each, id, *client.host, axis, own, writing, group);
        break;
      case Source::command_id:
        own.command_id = word;
        group.command_id = word;
        if (word == 0) client.host->ids[axis].zero_written = true;
        break;
      case Source::jog_velocity:
        group.jog_velocity = static_cast<std::uint32_t>(each.value);
        break;
      case Source::heartbeat:
        group.beats = own.heartbeat != word;
        own.heartbeat = word;
        break;
      default:
        break;  // the mailbox is written as a whole
    }
  }
  group.claims = claims(found, group, onlooker.role);
  return group;
}

Group object_group(const Mailbox& box, const Client& client, Role role) {
  Group group = client.new_group(role);
  group.claims = box.request == 2;
  group.object = ObjectRequest{box.request == 2, box.index, static_cast<std::uint8_t>(box.subindex),
                               static_cast<std::uint8_t>(box.size), box.data};
  return group;
}

void beat(Client& client, std::uint16_t value, Instant now) {
  if (client.heartbeat != value) client.life->heartbeat = now;
  client.heartbeat = value;
}

}  // namespace

Planned plan_register_write(const Request& request, const UnitView& view, const Onlooker& onlooker, Client& client) {
  const RowWrites found = resolve_rows(request, view, onlooker);
  if (const Errc wrong = check_rows(found, onlooker.role); wrong != Errc::ok) return wrong;

  WritePlan plan;
  if (found.axis == nullptr) {
    beat(client, static_cast<std::uint16_t>(found.rows.front().value), onlooker.now);
    return plan;
  }
  plan.axis = found.axis->number;
  const ClientAxis* before = client.find(plan.axis);
  const MailboxWrite box = write_mailbox(found, before == nullptr ? Mailbox{} : before->mailbox);
  if (box.refused != Errc::ok) return box.refused;

  Group group = make_group(found, onlooker, client);
  ClientAxis& own = client.at(plan.axis);
  own.mailbox = box.mailbox;
  if (box.requested) {
    own.used = true;
    own.mailbox.status = ObjectStatus::busy;
    own.mailbox.detail = 0;
    plan.object = object_group(box.mailbox, client, onlooker.role);
  }
  // A group that asks for nothing is submitted for its client's ownership: but where the mailbox's request stands for
  // it, that is told by one of them.
  if (!asks_nothing(group) || group.claims || !box.requested) plan.groups.push_back(group);
  return plan;
}

}  // namespace axisgate::modbus_tcp
