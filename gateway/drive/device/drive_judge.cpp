// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/drive_tasks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gateway/drive/device/answer_width.hpp"
#include "gateway/drive/device/word_order.hpp"
#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {

void judge_checks(DriveCore& core) {
  for (const model::Check& check : core.model.checks) core.set_alarm(check.alarm, false);
  for (const model::Check& check : core.model.checks) {
    const ObjectState& s = core.store[check.bad.object];
    if (!s.known) continue;
    for (auto& axis : core.axes) {
      const bool mine = check.slot == kNoAxis || &axis == &core.axes[check.slot];
      if (mine && check.bad.holds(core.model.object(check.bad.object), static_cast<std::uint32_t>(s.number)))
        axis->set_alarm(check.alarm, true);
    }
  }
}

void judge_loss_reaction(DriveCore& core) {
  const bool armed = std::ranges::all_of(core.model.setup, [&](const model::ObjectWrite& setup) {
    const bool counts = std::ranges::find(core.model.loss_objects, setup.object) != core.model.loss_objects.end();
    return !counts || (core.store[setup.object].known && core.store[setup.object].number == setup.raw);
  });
  // An adopted drive may hold it from before: whether it watches was not this gateway's doing.
  const std::optional<bool> holds = armed && core.bring_up.adopted() ? std::nullopt : std::optional(armed);
  for (auto& axis : core.axes) axis->set_loss_reaction(holds);
}

void judge_profile(DriveCore& core) {
  std::string lacks;
  for (std::size_t i = 0; i < core.model.objects.size(); ++i) {
    const auto id = static_cast<model::ObjectId>(i);
    const bool another = core.store[id].unlike && moves_by(core.model, id);
    if (another || ((core.store[id].refused || core.reads.tries().given_up(id)) && core.model.needs(id)))
      lacks += (lacks.empty() ? "" : ", ") + lacking(core, id);
  }
  if (!lacks.empty()) return tell_mismatch(core, lacks);
  const std::string order = against_word_order(core.model, core.store);
  tell_unfit(core, order.empty() ? order
                                 : fmt::format("{}: nothing moves it. Turn \"word_order\" of modbus-rtu round in "
                                               "profile {}",
                                               order, core.model.profile));
}

void judge_given_up(DriveCore& core) {
  if (core.brought_up()) judge_loss_reaction(core);
  if (core.brought_up() || core.turn.link == LinkState::setup) judge_profile(core);
}

namespace {

// What a limit is held against, and cannot be read.
std::string limited_by(const model::DriveModel& model, model::ObjectId id) {
  for (const model::AxisModel& axis : model.axes)
    for (const model::Binding& binding : axis.bindings)
      if (binding.object == id && binding.limited && is_speed_of_motion(binding.quantity))
        return fmt::format("; {} has a limit: no motion by it starts", row(binding.quantity).name);
  return {};
}

}  // namespace

void tell_given_up(DriveCore& core, model::ObjectId id) {
  const model::DriveModel& model = core.model;
  const model::ObjectDef& object = model.object(id);
  const auto& refusal = core.reads.tries().refusal(id);
  core.event(
      model.axes[object.slot == kNoAxis ? 0 : object.slot].number, EventKind::warning, 0,
      fmt::format("{} ({}) of node {} {} three times in a row, though the drive answers others: it is for {}; {}",
                  object.name, place_of(model, id), model.node,
                  refusal ? fmt::format("was refused (0x{:08X})", *refusal) : "was not answered", uses_of(model, id),
                  model.needs_for_state(id) ? "nothing is known of the axis without it, and it is asked each 2 s"
                  : model.needs(id)         ? "nothing moves without it, and it is asked ever more seldom"
                                            : "the axis goes on without it, and it is asked ever more seldom") +
          limited_by(model, id));
}

std::string lacking(const DriveCore& core, model::ObjectId object) {
  const bool silent = core.reads.tries().given_up(object) && !core.reads.tries().refusal(object);
  return fmt::format("{}{} (0x{:04X})", silent ? "to answer " : "", core.model.object(object).name,
                     core.model.object(object).address.index);
}

void tell_mismatch(DriveCore& core, const std::string& lacks) {
  tell_unfit(core, fmt::format("the device refuses {}, which profile {} needs: nothing moves it. Put the drive in that "
                               "the configuration names, or correct its \"profile\" or \"node\"; reads by mailbox and "
                               "43/13 tell what it is",
                               lacks, core.model.profile));
}

void tell_unfit(DriveCore& core, const std::string& why) {
  const bool news = core.bring_up.found_lacking(why);
  core.set_alarm(AxisAlarm::profile_mismatch, !why.empty());
  if (news)
    core.tell_all(EventKind::warning, static_cast<std::uint32_t>(AxisAlarm::profile_mismatch),
                  "profile_mismatch: " + why);
}

void tell_refused(DriveCore& core, std::string& reported) {
  std::string refused;
  for (std::size_t i = 0; i < core.model.objects.size(); ++i) {
    const auto id = static_cast<model::ObjectId>(i);
    if (!core.store[id].refused || core.store[id].unlike || core.model.needs(id)) continue;
    refused += fmt::format("{}{} ({}; for {})", refused.empty() ? "" : ", ", core.model.object(id).name,
                           place_of(core.model, id), uses_of(core.model, id));
  }
  if (!refused.empty() && refused != reported)
    core.tell_all(EventKind::warning, 0,
                  fmt::format("node {} does not have what profile {} names, and goes on without: {}", core.model.node,
                              core.model.profile, refused));
  reported = std::move(refused);
}

}  // namespace axisgate::drive
