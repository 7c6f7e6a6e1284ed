// SPDX-License-Identifier: Apache-2.0
// Objects that are not alone: several names for one place, fields of one frame, and what comes unasked.
#include <algorithm>

#include "gateway/profile/resolve/profile_resolving.hpp"

namespace axisgate::profile {
namespace {

bool at_one_place(const model::ObjectDef& a, const model::ObjectDef& b) {
  return !a.emulated && !b.emulated && a.address == b.address && a.size == b.size && a.mask() == b.mask();
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
    r.model.unsolicited.every = r.profile.protocols.find(r.input.protocol)->second.heartbeat;
  for (const Object& object : r.profile.objects) {
    const Place* place = object.place(r.input.protocol);
    const auto id = r.ids.find(object.name);
    if (place != nullptr && place->unsolicited && id != r.ids.end()) r.model.unsolicited.objects.push_back(id->second);
  }
}

}  // namespace

void resolve_together(Resolving& r) {
  name_aliases(r.model);
  list_composed(r.model);
  list_unsolicited(r);
}

}  // namespace axisgate::profile
