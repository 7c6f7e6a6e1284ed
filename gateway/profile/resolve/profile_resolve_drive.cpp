// SPDX-License-Identifier: Apache-2.0
// What belongs to the whole drive: setup, checks, alarms, resynchronisation read, and facts of its protocol.
#include <algorithm>

#include "gateway/profile/resolve/profile_resolving.hpp"

namespace axisgate::profile {
namespace {

void resolve_checks(Resolving& r) {
  for (const CheckSpec& spec : r.profile.checks) {
    std::vector<model::ObjectId> seen;
    for (std::size_t i = 0; i < r.model.axes.size(); ++i) {
      const auto slot = static_cast<AxisSlot>(i);
      std::optional<model::Condition> bad = r.condition(spec.bad, slot);
      if (!bad || std::ranges::find(seen, bad->object) != seen.end()) continue;
      seen.push_back(bad->object);
      model::Check out{spec.name, std::move(*bad), spec.alarm, r.model.object(seen.back()).slot, spec.text, {}};
      for (const WriteSpec& write : spec.remedy)
        if (const std::optional<model::ObjectWrite> one = r.write(write, slot)) out.remedy.push_back(*one);
      if (out.remedy.size() != spec.remedy.size()) out.remedy.clear();  // half a remedy is none
      r.model.checks.push_back(std::move(out));
    }
  }
}

template <class Make, class Write>
void add_for_each_axis(const Resolving& r, Make make, std::vector<Write>& out) {
  std::vector<model::ObjectId> seen;
  for (std::size_t i = 0; i < r.model.axes.size(); ++i) {
    const std::optional<Write> write = make(static_cast<AxisSlot>(i));
    if (!write || std::ranges::find(seen, write->object) != seen.end()) continue;
    seen.push_back(write->object);
    out.push_back(*write);
  }
}

void resolve_setup(Resolving& r) {
  for (const WriteSpec& spec : r.profile.setup) {
    if (!spec.is_on(r.input.protocol)) continue;
    if (spec.instead_of.empty())
      add_for_each_axis(
          r, [&](AxisSlot slot) { return r.write(spec, slot); }, r.model.setup);
    else
      add_for_each_axis(
          r, [&](AxisSlot slot) { return r.factory_write(spec, slot); }, r.model.factory_writes);
  }
}

void resolve_resync(Resolving& r, const ProtocolSpec& protocol) {
  r.model.resync.worst_reply = protocol.worst_reply;
  r.model.resync.by_length = r.input.protocol == "modbus-rtu";
  for (const ResyncSpec& read : protocol.resync) {
    const model::ObjectId id = r.id(read.name, 0);
    if (id == model::kNoObject) continue;
    if (read.counts.empty()) r.model.resync.candidates.push_back({id, 0});
    for (const std::uint8_t count : read.counts) r.model.resync.candidates.push_back({id, count});
  }
}

/// From the gateway's last sign of life on; a node that is guarded counts guard times.
Duration loss_after(const ProtocolSpec& protocol) {
  if (!protocol.loss.stops) return {};
  const bool guarded = protocol.loss.by == LossSpec::By::life_guarding;
  return guarded ? protocol.canopen.guard_time * protocol.canopen.life_factor : protocol.loss.after;
}

}  // namespace

void resolve_drive(Resolving& r) {
  const ProtocolSpec& protocol = r.profile.protocols.find(r.input.protocol)->second;
  r.model.profile = r.profile.name;
  r.model.title = r.profile.title;
  r.model.protocol = r.input.protocol;
  r.model.node = r.input.node;
  r.model.poll_period = r.input.poll;
  r.model.stops_by_itself = protocol.stops_by_itself();
  r.model.loss_after = loss_after(protocol);
  r.model.loss_text = protocol.loss.text;
  if (r.profile.keepalive && r.profile.keepalive->is_on(r.input.protocol))
    r.model.keep_alive = r.profile.keepalive->every;
  r.model.timeout = protocol.timeout;
  r.model.rtu = protocol.rtu;
  r.model.nvm = r.profile.nvm;
  resolve_resync(r, protocol);
  for (const AlarmSpec& row : r.profile.alarms)
    if (r.id(r.profile.fault_words[row.word], 0) != model::kNoObject)
      r.model.alarms.push_back({row.word, row.bit.value_or(0), row.value, row.code, row.text, row.remedy});
  resolve_setup(r);
  if (model::is_canopen(r.model)) resolve_canopen(r, protocol);
  resolve_checks(r);
}

}  // namespace axisgate::profile
