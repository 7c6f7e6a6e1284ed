// SPDX-License-Identifier: Apache-2.0
// What belongs to the whole drive: setup, checks, alarms, resynchronisation read, and facts of its protocol.
#include <fmt/format.h>

#include <algorithm>

#include "gateway/core/name_table.hpp"
#include "gateway/profile/resolve/profile_resolving.hpp"

namespace axisgate::profile {
namespace {

/// The alarms that a check may raise: the others have their own makers.
constexpr auto kCheckAlarms = names_of<AxisAlarm>({{AxisAlarm::identity_mismatch, "identity_mismatch"},
                                                   {AxisAlarm::local_control, "local_control"},
                                                   {AxisAlarm::limit_inputs_open, "limit_inputs_open"},
                                                   {AxisAlarm::stop_options, "stop_options"}});

void resolve_checks(Resolving& r) {
  for (const JsonNode& node : r.profile.section("checks").elements()) {
    std::vector<model::ObjectId> seen;
    for (std::size_t i = 0; i < r.model.axes.size(); ++i) {
      const auto slot = static_cast<AxisSlot>(i);
      std::optional<model::Condition> bad = r.condition(node, slot);
      if (!bad || std::ranges::find(seen, bad->object) != seen.end()) continue;
      seen.push_back(bad->object);
      model::Check out{node.text("name"), std::move(*bad), {}, r.model.object(seen.back()).slot, node.text("text"), {}};
      out.alarm = kCheckAlarms.named(node.text("alarm")).value_or(out.alarm);
      const std::vector<JsonNode> remedy = node["remedy"].elements();
      for (const JsonNode& write : remedy)
        if (const std::optional<model::ObjectWrite> one = r.write(write, slot)) out.remedy.push_back(*one);
      if (out.remedy.size() != remedy.size()) out.remedy.clear();  // half a remedy is none
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
  for (const JsonNode& node : r.profile.section("setup").elements()) {
    if (!is_on(node, r.input.protocol)) continue;
    if (!node.has("instead_of"))
      add_for_each_axis(
          r, [&](AxisSlot slot) { return r.write(node, slot); }, r.model.setup);
    else
      add_for_each_axis(
          r, [&](AxisSlot slot) { return r.factory_write(node, slot); }, r.model.factory_writes);
  }
}

void resolve_resync(Resolving& r, const ProtocolSpec& protocol) {
  r.model.resync.worst_reply = protocol.worst_reply;
  r.model.resync.by_length = r.input.protocol == "modbus-rtu";
  const JsonNode list = r.profile.section("protocols")[r.input.protocol]["resynchronisation"];
  for (const JsonNode& read : list.elements()) {
    const model::ObjectId id = r.model.whole(r.id(read.is_string() ? read.text() : read.text("object"), 0));
    if (id == model::kNoObject) continue;
    if (read.is_string()) r.model.resync.candidates.push_back({id, 0});
    for (const std::int64_t count : read.wholes("counts"))
      r.model.resync.candidates.push_back({id, static_cast<std::uint8_t>(count)});
  }
}

/// From the gateway's last sign of life on; a node that is guarded counts guard times.
Duration loss_after(const ProtocolSpec& protocol) {
  if (!protocol.loss.stops) return {};
  const bool guarded = protocol.loss.by == LossSpec::By::life_guarding;
  return guarded ? protocol.canopen.guard_time * protocol.canopen.life_factor : protocol.loss.after;
}

/// Motors that are enabled as one: without its axis one of them would have torque that nobody answers for.
void resolve_shared(Resolving& r) {
  std::vector<AxisSlot> group;
  std::string missing;
  for (const AxisSlot motor : r.profile.shared()) {
    if (const AxisSlot slot = r.axis_of(motor); slot != kNoAxis)
      group.push_back(slot);
    else
      missing = r.profile.axes[motor];
  }
  if (!group.empty() && !missing.empty())
    r.fault("/axes", fmt::format("motor {} is enabled and stopped with the others: it needs an axis of its own, or it "
                                 "has torque that nobody answers for",
                                 missing));
  for (const AxisSlot slot : group) {
    for (const AxisSlot other : group)
      if (other != slot) r.model.axes[slot].shares.push_back(other);
    if (r.input.axes[slot].lease != r.input.axes[group.front()].lease)
      r.fault(fmt::format("/axes/{}/lease", slot),
              "its motor is enabled and stopped with the others, and has one owner with them: give their axes the same "
              "lease");
  }
}

}  // namespace

void resolve_drive(Resolving& r) {
  const ProtocolSpec& protocol = r.profile.protocols.find(r.input.protocol)->second;
  r.model.profile = r.profile.name;
  r.model.title = r.profile.title;
  r.model.only_simulated = r.profile.only_simulated;
  r.model.protocol = r.input.protocol;
  r.model.node = r.input.node;
  r.model.poll_period = r.input.poll;
  r.model.stops_by_itself = protocol.stops_by_itself();
  r.model.loss_after = loss_after(protocol);
  r.model.loss_text = protocol.loss.text;
  if (const JsonNode keepalive = r.profile.section("keepalive"); is_on(keepalive, r.input.protocol))
    r.model.keep_alive = keepalive.milliseconds("every_ms", {});
  r.model.timeout = protocol.timeout;
  r.model.rtu = protocol.rtu;
  r.model.nvm = r.profile.nvm;
  resolve_resync(r, protocol);
  const bool hears = r.profile.has_emergency_word(r.input.protocol);
  const std::vector<std::string> words = r.profile.fault_words();
  for (const model::AlarmRow& row : r.profile.alarms)
    if (const std::string& word = words[row.word];
        r.id(word, 0) != model::kNoObject || (hears && word == kEmergencyWord))
      r.model.alarms.push_back(row);
  resolve_setup(r);
  if (model::is_canopen(r.model)) resolve_canopen(r, protocol);
  resolve_checks(r);
  resolve_shared(r);
}

}  // namespace axisgate::profile
