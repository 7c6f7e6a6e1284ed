// SPDX-License-Identifier: Apache-2.0
// How a drive speaks CANopen: what it sends by itself, and how it and the gateway notice that the other is gone.
#include <algorithm>

#include "gateway/profile/resolve/profile_resolving.hpp"

namespace axisgate::profile {
namespace {

using std::chrono::milliseconds;

/// The gateway sends so many heartbeats in the time after which the drive takes it for dead.
constexpr int kHeartbeatsBeforeLoss = 3;

/// For all axes, or the drive's own: what an object of this name is on this drive, each once.
std::vector<model::ObjectId> meanings(const Resolving& r, const std::string& name) {
  std::vector<model::ObjectId> out;
  for (std::size_t i = 0; i < r.model.axes.size(); ++i) {
    const model::ObjectId id = r.id(name, static_cast<AxisSlot>(i));
    if (id != model::kNoObject && std::ranges::find(out, id) == out.end()) out.push_back(id);
  }
  return out;
}

/// Written at bring-up, and what no_comm_watchdog is judged by.
void hold(Resolving& r, const std::string& name, std::int64_t raw, const std::string& why) {
  for (const model::ObjectId id : meanings(r, name)) {
    r.model.setup.push_back({id, raw, why});
    r.model.loss_objects.push_back(id);
  }
}

void resolve_mapping(Resolving& r, const CanopenSpec& spec) {
  r.model.canopen.unused_tpdos = spec.unused_tpdos;
  for (const CanopenSpec::Tpdo& tpdo : spec.tpdos) {
    model::TpdoProperties out;
    out.number = tpdo.number;
    out.type = tpdo.type;
    out.inhibit = tpdo.inhibit;
    out.inhibit_time = tpdo.inhibit_time;
    out.event_ms = tpdo.event_ms;
    for (const std::string& name : tpdo.map)
      if (const auto id = r.ids.find(name); id != r.ids.end()) out.map.push_back(id->second);
    // Nothing of it is wanted: it carries the values of a motor that is no axis.
    if (out.map.empty())
      r.model.canopen.unused_tpdos.push_back(out.number);
    else
      r.model.canopen.tpdos.push_back(std::move(out));
  }
}

void resolve_loss(Resolving& r, const LossSpec& loss, const CanopenSpec& spec) {
  model::CanopenProperties& facts = r.model.canopen;
  if (loss.by == LossSpec::By::heartbeat_consumer) {
    facts.own_heartbeat = loss.after / kHeartbeatsBeforeLoss;
    hold(r, loss.object, std::int64_t{model::kOwnNode} << 16 | loss.after / milliseconds(1),
         "the drive notices when the gateway's heartbeat stays away");
  } else if (loss.by == LossSpec::By::life_guarding) {
    hold(r, spec.guard_time_object, spec.guard_time / milliseconds(1), "the gateway guards the node so often");
    hold(r, spec.life_factor_object, spec.life_factor, "so many guard times without a frame are a dead gateway");
    hold(r, loss.object, loss.value, "the drive's reaction to a dead gateway");
  }
}

}  // namespace

void resolve_canopen(Resolving& r, const ProtocolSpec& protocol) {
  const CanopenSpec& spec = protocol.canopen;
  model::CanopenProperties& facts = r.model.canopen;
  facts.heartbeat = spec.heartbeat;
  facts.guard_time = spec.guard_time;
  facts.life_factor = spec.life_factor;
  facts.sync = spec.sync;
  facts.boot = spec.boot;
  facts.sdo_block = spec.sdo_block;
  facts.confirm = spec.confirm;
  facts.identity = r.input.identity;
  resolve_mapping(r, spec);
  resolve_loss(r, protocol.loss, spec);
}

}  // namespace axisgate::profile
