#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>

#include "gateway/upstream/modbus_tcp/write_plan.hpp"

namespace axisgate::modbus_tcp {
namespace {

/// Coils that act in one request run in this order, whatever their numbers: stops first, starts last.
constexpr std::array kOrder{Command::quick_stop,    Command::disable,     Command::halt, Command::fault_reset,
                            Command::enable,        Command::end_halt,    Command::home, Command::move_absolute,
                            Command::move_relative, Command::run_velocity};

using Acting = boost::container::static_vector<Command, kCoils>;

bool starts_motion(Command command) {
  return command == Command::home || command == Command::move_absolute || command == Command::move_relative ||
         command == Command::run_velocity;
}

bool has(const Acting& acting, Command command) {
  return std::find(acting.begin(), acting.end(), command) != acting.end();
}

/// What a stop in the same request drops: every start, and the enable that a quick stop or a disable contradicts.
bool dropped_by_stop(Command command, const Acting& acting) {
  const bool off = has(acting, Command::quick_stop) || has(acting, Command::disable);
  if (command == Command::enable) return off;
  return starts_motion(command) && (off || has(acting, Command::halt));
}

bool can(const AxisImage& axis, Command command) {
  // Ending a halt is the other half of halt.
  const Command listed = command == Command::end_halt ? Command::halt : command;
  return (axis.supported_commands >> static_cast<unsigned>(listed) & 1U) != 0;
}

/// Reserved coils take a 0. Coils of another version, or that this drive cannot do, take a 0 in a longer write, which
/// asks for nothing: a scanner may write the whole row of coils.
bool takes(const AxisImage& axis, std::uint16_t offset, bool value, bool single) {
  if (offset >= kCoils) return offset < kReservedCoilsEnd && !value;
  const CoilRow& coil = coil_rows()[offset];
  return (coil.built && can(axis, coil.on)) || (!value && !single);
}

}  // namespace

Planned plan_coil_write(const Request& request, const UnitView& view, const Onlooker& onlooker, Client& client) {
  if (onlooker.role < Role::operator_) return Errc::role_forbidden;
  const auto first = view.place_bit(request.write_address, onlooker.image);
  const bool single = request.write_count == 1;
  if (!first || first->offset + request.write_count > kReservedCoilsEnd) return Errc::not_supported;
  const AxisImage& axis = *first->axis;
  for (std::uint16_t i = 0; i < request.write_count; ++i) {
    const auto offset = static_cast<std::uint16_t>(first->offset + i);
    if (!takes(axis, offset, request.written_coil(i), single)) return Errc::not_supported;
  }

  const ClientAxis* before = client.find(axis.number);
  EdgeMemory edges = before == nullptr ? EdgeMemory{} : before->edges;
  const Writing writing{single ? WriteForm::single : WriteForm::block, onlooker.now, onlooker.settings.rearm};
  Acting acting;
  for (std::uint16_t i = 0; i < request.write_count && first->offset + i < kCoils; ++i) {
    const CoilRow& coil = coil_rows()[first->offset + i];
    if (!coil.built || !can(axis, coil.on)) continue;
    const auto command = edges.coil(coil, request.written_coil(i), writing);
    if (command && !has(acting, *command)) acting.push_back(*command);
  }
  // Two starts at once: no one can say which motion was meant.
  if (std::count_if(acting.begin(), acting.end(), starts_motion) > 1) return Errc::bad_value;

  client.at(axis.number).edges = edges;
  WritePlan plan;
  plan.axis = axis.number;
  for (const Command command : kOrder) {
    if (!has(acting, command)) continue;
    if (dropped_by_stop(command, acting)) {
      plan.afterwards = Errc::dropped_by_stop;
      continue;
    }
    Group group;
    group.client = client.id;
    group.role = onlooker.role;
    group.command = command;
    plan.groups.push_back(group);
  }
  return plan;
}

}  // namespace axisgate::modbus_tcp
