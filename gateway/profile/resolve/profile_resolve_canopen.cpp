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
    hold(r, guard.text("time_object"), facts.guard_time / milliseconds(1), "the gateway guards the node so often");
    hold(r, guard.text("factor_object"), facts.life_factor, "so many guard times without a frame are a dead gateway");
    hold(r, loss.object, loss.value, "the drive's reaction to a dead gateway");
  }
}

}  // namespace

void resolve_canopen(Resolving& r, const ProtocolSpec& protocol) {
  r.model.canopen = protocol.canopen;
  r.model.canopen.identity = r.input.identity;
  if (r.profile.identity && !r.model.canopen.identity[0])
    r.model.canopen.identity[0] = r.profile.identity->numbers[0].front();
  resolve_mapping(r, protocol.canopen.tpdos);
  resolve_loss(r, protocol);
}

}  // namespace axisgate::profile
