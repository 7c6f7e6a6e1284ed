// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>

#include "gateway/image/shown.hpp"
#include "gateway/upstream/modbus_tcp/write/claims.hpp"
#include "gateway/upstream/modbus_tcp/write/write_plan.hpp"

namespace axisgate::modbus_tcp {
namespace {

/// Coils that act in one request run in this order, whatever their numbers: stops first, starts last.
constexpr std::array kOrder{Command::quick_stop,  Command::disable,       Command::halt,          Command::end_run,
                            Command::jog_end,     Command::fault_reset,   Command::enable,        Command::end_halt,
                            Command::home,        Command::move_absolute, Command::move_relative, Command::run_velocity,
                            Command::jog_forward, Command::jog_reverse};

/// The two jog coils ask for two things together, and each of the others for one at most.
using Acting = boost::container::static_vector<Command, kCoils + 1>;

bool has(const Acting& acting, Command command) { return std::ranges::find(acting, command) != acting.end(); }

/// The lowest of the coils that ask for a start.
std::uint16_t first_start(const Acting& acting) {
  std::uint16_t first = kCoils;
  for (const Command command : acting)
    if (asks_to_move(command)) first = std::min(first, coil_of(command));
  return first;
}

bool any_of(const Acting& acting, bool (*is)(Command)) { return std::ranges::any_of(acting, is); }

/// What a stop in the same request drops: every start, and the enable that a quick stop or a disable contradicts.
bool dropped_by_stop(Command command, const Acting& acting) {
  const bool off = has(acting, Command::quick_stop) || has(acting, Command::disable);
  if (command == Command::enable) return off;
  return asks_to_move(command) && any_of(acting, asks_to_stop);
}

/// Reserved coils take a 0. Coils that this drive cannot do take a 0 in a longer write, which asks for nothing: a
/// scanner may write the whole row of coils.
bool takes(const AxisImage& axis, std::uint16_t offset, bool value, bool single) {
  if (offset >= kCoils) return offset < kReservedCoilsEnd && !value;
  return supports(axis, coil_rows()[offset]) || (!value && !single);
}

struct Asked {
  Acting acting;
  std::optional<Command> jog_again{};
  bool not_new = false;
};

/// A single 0 to the button by which the axis jogs is a stop of anybody's; elsewhere a 0 ends its client's own jog
/// alone.
bool ends_anybodys_jog(const Request& request, std::uint16_t first, const AxisImage& axis) {
  return request.write_count == 1 && !request.written_coil(0) &&
         (static_cast<unsigned>(shown_level_coils(axis)) >> first & 1U) != 0;
}

/// What the coils of the request ask for, by the edge rules.
Asked ask(const Request& request, std::uint16_t first, const AxisImage& axis, Writing writing, const RowMemory& rows,
          EdgeMemory& edges, LastWords& words) {
  Asked asked;
  JogWrite jog;
  for (std::uint16_t i = 0; i < request.write_count && first + i < kCoils; ++i) {
    const CoilRow& coil = coil_rows()[first + i];
    if (!supports(axis, coil)) continue;
    const bool value = request.written_coil(i);
    words.coils[coil.offset] = value;
    if (coil.offset == kJogForward || coil.offset == kJogReverse) {
      (coil.offset == kJogForward ? jog.forward : jog.reverse) = value;
      continue;
    }
    writing.targets = rows.targets_of(coil.on);
    const CoilAsks coil_asks = edges.coil(coil, value, writing);
    asked.not_new = asked.not_new || coil_asks.verdict == Verdict::not_new;
    if (coil_asks.command != Command::none && !has(asked.acting, coil_asks.command))
      asked.acting.push_back(coil_asks.command);
  }
  const JogAsks jogs = edges.jog(jog, writing);
  if (jogs.ends_run) asked.acting.push_back(Command::end_run);
  if (jogs.ends) asked.acting.push_back(ends_anybodys_jog(request, first, axis) ? Command::halt : Command::jog_end);
  if (jogs.start) asked.acting.push_back(*jogs.start);
  asked.not_new = asked.not_new || jogs.not_new;
  if (!any_of(asked.acting, asks_to_stop) && !any_of(asked.acting, asks_to_move)) asked.jog_again = jogs.again;
  return asked;
}

/// What the coils of one axis ask to stop. `i`: the first of them.
void add_stops(const Request& request, std::uint16_t i, const UnitView::BitPlace& place, const Onlooker& onlooker,
               std::vector<AxisStop>& stops) {
  const AxisImage& axis = *place.axis;
  const Writing writing = writing_to(axis, onlooker, WriteForm::block);
  WriteMemory memory = memory_of(onlooker, axis.number);
  EdgeMemory& edges = memory.edges;
  Acting acting;
  JogWrite jog;
  for (std::uint16_t at = place.offset; i < request.write_count && at < kCoils; ++i, ++at) {
    const CoilRow& coil = coil_rows()[at];
    const bool value = request.written_coil(i);
    if (at == kJogForward) jog.forward = value;
    if (at == kJogReverse) jog.reverse = value;
    if (at == kJogForward || at == kJogReverse || !supports(axis, coil)) continue;
    EdgeMemory after = edges;
    const Command asked = after.coil(coil, value, writing).command;
    if (!asks_to_stop(asked)) continue;
    edges = after;
    memory.words.coils[at] = value;
    acting.push_back(asked);
  }
  EdgeMemory after = edges;
  if (const JogAsks jogs = after.jog(jog, writing); jogs.ends) {
    edges = after;
    if (jog.forward) memory.words.coils[kJogForward] = *jog.forward;
    if (jog.reverse) memory.words.coils[kJogReverse] = *jog.reverse;
    if (jogs.ends_run) acting.push_back(Command::end_run);
    acting.push_back(Command::jog_end);
  }
  for (const Command command : kOrder) {
    if (!has(acting, command)) continue;
    WriteBatch& batch = stops.emplace_back(axis.number, onlooker.client.new_batch(onlooker.role), memory).batch;
    batch.reclaims = true;
    batch.command = command;
  }
}

/// One write batch for each command that acts. A request in which nothing does is one all the same: by it its client
/// owns the axis, is told that another does, or renews its lease.
void add_batches(const Asked& asked, const WriteBatch& empty, WritePlan& plan) {
  for (const Command command : kOrder) {
    if (!has(asked.acting, command)) continue;
    if (dropped_by_stop(command, asked.acting)) {
      plan.afterwards = Errc::dropped_by_stop;
      continue;
    }
    plan.batches.push_back(empty);
    plan.batches.back().command = command;
    plan.batches.back().claims = coil_claims(command);
  }
  if (plan.batches.empty()) plan.batches.push_back(empty);
  // With the first: what the others wait for must not let the jog run out of time.
  plan.batches.front().jog_again = asked.jog_again;
}

bool is_all_zero(const Request& request) {
  for (std::uint16_t i = 0; i < request.write_count; ++i)
    if (request.written_coil(i)) return false;
  return true;
}

}  // namespace

std::vector<AxisStop> stops_in_coils(const Request& request, const UnitView& view, const Onlooker& onlooker) {
  std::vector<AxisStop> stops;
  if (request.write_count == 1 || onlooker.role < Role::operator_) return stops;
  for (std::uint16_t i = 0; i < request.write_count; ++i) {
    const auto place = view.place_bit(static_cast<std::uint32_t>(request.write_address) + i, onlooker.image);
    if (!place) continue;
    add_stops(request, i, *place, onlooker, stops);
    i = static_cast<std::uint16_t>(i + kAxisBlock - 1U - place->offset);
  }
  return stops;
}

Planned plan_coil_write(const Request& request, const UnitView& view, const Onlooker& onlooker, Client& client) {
  const auto first = view.place_bit(request.write_address, onlooker.image);
  const bool single = request.write_count == 1;
  const auto refuse = [&](Errc code, std::size_t coil) {
    return Refused{code, single ? std::nullopt : std::optional(static_cast<std::uint16_t>(coil)),
                   stops_in_coils(request, view, onlooker)};
  };
  if (onlooker.role < Role::operator_) return refuse(Errc::role_forbidden, first ? first->offset : 0U);
  if (!first) return Refused{Errc::not_supported, std::nullopt, stops_in_coils(request, view, onlooker)};
  const AxisImage& axis = *first->axis;
  for (std::uint16_t i = 0; i < request.write_count; ++i) {
    const auto offset = static_cast<std::uint16_t>(first->offset + i);
    if (!takes(axis, offset, request.written_coil(i), single)) return refuse(Errc::not_supported, offset);
  }

  const ClientAxis* before = client.find(axis.number);
  EdgeMemory edges = before == nullptr ? EdgeMemory{} : before->edges;
  const RowMemory rows = before == nullptr ? RowMemory{} : before->rows;
  const Writing writing = writing_to(axis, onlooker, single ? WriteForm::single : WriteForm::block);
  LastWords words = writing.own;
  const Asked asked = ask(request, first->offset, axis, writing, rows, edges, words);
  // Two starts at once: no one can say which motion was meant.
  if (std::ranges::count_if(asked.acting, asks_to_move) > 1) return refuse(Errc::bad_value, first_start(asked.acting));

  WritePlan plan;
  plan.axis = axis.number;
  plan.single = single;
  plan.block = block_write(request, axis.number);
  plan.not_new = asked.not_new;
  plan.before = memory_of(onlooker, axis.number);
  client.at(axis.number).edges = edges;
  onlooker.words->axes[axis.number] = words;
  WriteBatch empty = client.new_batch(onlooker.role);
  empty.reclaims = true;
  empty.all_zero = !single && is_all_zero(request);
  add_batches(asked, empty, plan);
  return plan;
}

}  // namespace axisgate::modbus_tcp
