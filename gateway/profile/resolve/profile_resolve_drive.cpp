// SPDX-License-Identifier: Apache-2.0
// What belongs to the whole drive: setup, checks, alarms, resynchronisation read, and facts of its protocol: on CANopen
// what it sends by itself, and how it and the gateway notice that the other is gone.
#include <fmt/format.h>

#include <algorithm>

#include "gateway/core/name_table.hpp"
#include "gateway/profile/resolve/profile_resolving.hpp"

namespace axisgate::profile {
namespace {

/// The gateway sends so many heartbeats in the time after which the drive takes it for dead.
constexpr int kHeartbeatsBeforeLoss = 3;

/// The alarms that a check may raise: the others have their own makers.
constexpr auto kCheckAlarms = names_of<AxisAlarm>({{AxisAlarm::identity_mismatch, "identity_mismatch"},
                                                   {AxisAlarm::local_control, "local_control"},
                                                   {AxisAlarm::limit_inputs_open, "limit_inputs_open"},
                                                   {AxisAlarm::stop_options, "stop_options"}});

void resolve_checks(Resolving& r) {
  for (const JsonNode& node : r.profile.section("checks").elements())
    r.each_object(node.text("object"), [&](model::ObjectId object, AxisSlot slot) {
      std::optional<model::Condition> bad = r.condition(node, slot);
      if (!bad) return;
      model::Check out{node.text("name"), std::move(*bad), {}, r.model.object(object).slot, node.text("text"), {}};
      out.alarm = kCheckAlarms.named(node.text("alarm")).value_or(out.alarm);
      const std::vector<JsonNode> remedy = node["remedy"].elements();
      for (const JsonNode& write : remedy)
        if (const std::optional<model::ObjectWrite> one = r.write(write, slot)) out.remedy.push_back(*one);
      if (out.remedy.size() != remedy.size()) out.remedy.clear();  // half a remedy is none
      r.model.checks.push_back(std::move(out));
    });
}

void resolve_setup(Resolving& r) {
  for (const JsonNode& node : r.profile.section("setup").elements())
    if (is_on(node, r.input.protocol))
      r.each_object(node.text("write"), [&](model::ObjectId, AxisSlot slot) {
        if (node.has("instead_of")) {
          if (const auto write = r.factory_write(node, slot)) r.model.factory_writes.push_back(*write);
        } else if (const auto write = r.write(node, slot)) {
          r.model.setup.push_back(*write);
        }
      });
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

/// Written at bring-up, and what no_comm_watchdog is judged by.
void hold(Resolving& r, const std::string& name, std::int64_t raw, const std::string& why) {
  r.each_object(name, [&](model::ObjectId id, AxisSlot) {
    r.model.setup.push_back({id, raw, why});
    r.model.loss_objects.push_back(id);
  });
}

/// A map holds positions in the profile so far.
void resolve_mapping(Resolving& r, const std::vector<model::TpdoProperties>& profiles) {
  model::CanopenProperties& facts = r.model.canopen;
  facts.tpdos.clear();
  for (const model::TpdoProperties& tpdo : profiles) {
    model::TpdoProperties& out = facts.tpdos.emplace_back(tpdo);
    out.map.clear();
    for (const model::ObjectId position : tpdo.map)
      if (const auto id = r.ids.find(r.profile.objects[position].name); id != r.ids.end())
        out.map.push_back(id->second);
    if (!out.map.empty()) continue;
    // Nothing of it is wanted: it carries the values of a motor that is no axis.
    facts.unused_tpdos.push_back(tpdo.number);
    facts.tpdos.pop_back();
  }
}

void resolve_loss(Resolving& r, const ProtocolSpec& protocol) {
  const LossSpec& loss = protocol.loss;
  model::CanopenProperties& facts = r.model.canopen;
  const JsonNode guard = r.profile.section("protocols")["canopen"]["guard"];
  if (loss.by == LossSpec::By::heartbeat_consumer) {
    facts.own_heartbeat = loss.after / kHeartbeatsBeforeLoss;
    hold(r, loss.object, loss.value, "the drive notices when the gateway's heartbeat stays away");
  } else if (loss.by == LossSpec::By::life_guarding) {
    hold(r, guard.text("time_object"), facts.guard_time / std::chrono::milliseconds(1),
         "the gateway guards the node so often");
    hold(r, guard.text("factor_object"), facts.life_factor, "so many guard times without a frame are a dead gateway");
    hold(r, loss.object, loss.value, "the drive's reaction to a dead gateway");
  }
}

/// After the setup list, which it adds to.
void resolve_canopen(Resolving& r, const ProtocolSpec& protocol) {
  r.model.canopen = protocol.canopen;
  r.model.canopen.identity = r.input.identity;
  if (r.profile.identity && !r.model.canopen.identity[0])
    r.model.canopen.identity[0] = r.profile.identity->numbers[0].front();
  resolve_mapping(r, protocol.canopen.tpdos);
  resolve_loss(r, protocol);
}

bool at_one_place(const model::ObjectDef& a, const model::ObjectDef& b) {
  const bool own = !a.emulated && !b.emulated && !a.is_directed() && !b.is_directed();
  return own && a.address == b.address && a.size == b.size && a.mask() == b.mask();
}

void name_aliases(model::DriveModel& model) {
  for (std::size_t i = 0; i < model.objects.size(); ++i)
    for (std::size_t j = 0; j < model.objects.size(); ++j)
      if (i != j && at_one_place(model.objects[i], model.objects[j]))
        model.objects[i].aliases.push_back(static_cast<model::ObjectId>(j));
}

/// Of several names for one field, the set-point that its motor's mode follows.
bool is_followed(const model::DriveModel& model, model::ObjectId id) {
  const AxisSlot slot = model.object(id).slot;
  if (slot == kNoAxis) return false;
  const auto& bindings = model.axes[slot].bindings;
  return std::ranges::any_of(bindings, [&](const model::Binding& b) { return b.object == id; });
}

/// Each field once: all enable bits in the order of the motors, and then all values.
void list_composed(model::DriveModel& model) {
  std::vector<model::ObjectId>& out = model.composed;
  for (std::size_t i = 0; i < model.objects.size(); ++i) {
    const auto id = static_cast<model::ObjectId>(i);
    if (!model.object(id).composed) continue;
    const auto same =
        std::ranges::find_if(out, [&](model::ObjectId o) { return at_one_place(model.object(o), model.object(id)); });
    if (same == out.end())
      out.push_back(id);
    else if (is_followed(model, id) && !is_followed(model, *same))
      *same = id;
  }
  std::ranges::sort(out, [&](model::ObjectId a, model::ObjectId b) {
    const model::ObjectDef& left = model.object(a);
    const model::ObjectDef& right = model.object(b);
    if (left.turns_on != right.turns_on) return left.turns_on;
    return left.address < right.address;
  });
}

void list_unsolicited(Resolving& r) {
  if (r.input.protocol == "keya-can")
    r.model.unsolicited.every = r.profile.section("protocols")["keya-can"].milliseconds("heartbeat_ms", {});
  for (const Object& object : r.profile.objects) {
    const Place* place = object.place(r.input.protocol);
    const auto id = r.ids.find(object.name);
    if (place != nullptr && place->unsolicited && id != r.ids.end()) r.model.unsolicited.objects.push_back(id->second);
  }
}

/// Objects that are not alone: several names for one place, fields of one frame, and what comes unasked.
void resolve_together(Resolving& r) {
  name_aliases(r.model);
  list_composed(r.model);
  list_unsolicited(r);
}

}  // namespace

void resolve_drive(Resolving& r) {
  resolve_together(r);
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
