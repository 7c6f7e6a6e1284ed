// SPDX-License-Identifier: Apache-2.0
// How a drive comes up: bring-up, the checks, and what an adopted one is owed (design 7, point 6).
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gateway/drive/device/drive.hpp"
#include "gateway/drive/device/requests.hpp"

namespace axisgate::drive {
namespace {

/// A position, a velocity or an acceleration of a motor.
bool moves_by(const DriveModel& model, ObjectId object) {
  const auto counts = [object](const Binding& binding) {
    const Kind kind = row(binding.quantity).kind;
    const bool of_motion = kind == Kind::position || kind == Kind::velocity || kind == Kind::acceleration;
    return binding.object == object && of_motion;
  };
  return std::any_of(model.axes.begin(), model.axes.end(), [&](const AxisModel& axis) {
    return std::any_of(axis.bindings.begin(), axis.bindings.end(), counts);
  });
}

}  // namespace

std::optional<bus::Exchange> Drive::next_of_bring_up() {
  const auto next = bring_up_.next(store_);
  if (!next) {
    // A drive that was found faulted comes online with the cause of it.
    if (causes_are_open()) {
      if (auto cause = next_cause()) return cause;
      bus_.wait(jobs_.setup, turn_.now + kCausePause);
      return std::nullopt;
    }
    end_bring_up();
    return std::nullopt;
  }
  if (next->exchange) {
    if (next->exchange->access == bus::Access::command) bring_up_.start().told(turn_.now);
    return next->exchange;
  }
  return next->write ? write(next->object, next->number) : read_of(model_, next->object);
}

void Drive::begin_bring_up(bool restarted) {
  if (end_.begun()) {  // nobody would see its end
    set_state(LinkState::unknown);
    presence_.look_at(kNever);
    return;
  }
  set_state(LinkState::setup);
  presence_.found();
  unmap_values();
  reads_.restart(turn_.now);
  control_.reset();
  bring_up_.begin();
  if (restarted)
    for (auto& axis : axes_) axis->on_bring_up();
  jobs_.setup = queue_own(bus::Priority::setup);
  // A full queue empties by its deadlines: try again after a probe's pause.
  if (jobs_.setup == 0) {
    set_state(LinkState::unknown);
    presence_.look_at(turn_.now + bus::Backoff::kFirst);
  }
}

void Drive::carry_on_bring_up(const bus::Exchange& exchange, const bus::ExchangeResult& result) {
  if (turn_.link != LinkState::setup) return;
  const auto next = bring_up_.next(store_);
  if (next && next->exchange) {
    // Lost: asked once more, when the resynchronisation read is answered.
    if (*next->exchange == exchange && (result.code == Errc::ok || result.code == Errc::refused_by_drive))
      bring_up_.answered(result);
    return;
  }
  const bool was_write = exchange.access == bus::Access::write;
  if (was_write) {
    if (result.code == Errc::refused_by_drive)
      bring_up_.write_refused();
    else
      bring_up_.written();
  } else if (result.code == Errc::ok) {
    bring_up_.read_back_answered();
  }
  const ObjectId asked = model_.find(exchange.object);
  const bool of_state = !was_write && asked != kNoObject && model_.needs_for_state(asked);
  const bool state_refused =
      of_state && (result.code == Errc::refused_by_drive || (result.code == Errc::ok && store_[asked].refused));
  if (state_refused && !result.for_now) tell_mismatch(lacking(asked));
  // A drive that refuses its statusword is none we can speak for: it stays in setup and is asked again, slowly; and so
  // is one that is busy.
  if (state_refused || (!was_write && result.for_now)) bus_.wait(jobs_.setup, turn_.now + std::chrono::seconds(1));
}

std::string Drive::lacking(ObjectId object) const {
  return fmt::format("{} (0x{:04X})", model_.object(object).name, model_.object(object).address.index);
}

// What its profile needs and it does not have, told once; empty: it has it all.
void Drive::tell_mismatch(const std::string& lacks) {
  const bool news = bring_up_.found_lacking(lacks);
  for (auto& axis : axes_) axis->set_alarm(AxisAlarm::profile_mismatch, !lacks.empty());
  if (!news) return;
  tell_all(
      EventKind::warning, static_cast<std::uint32_t>(AxisAlarm::profile_mismatch),
      fmt::format("profile_mismatch: the device refuses {}, which profile {} needs: nothing moves it. Put the drive "
                  "in that the configuration names, or correct its \"profile\" or \"node\"; reads by mailbox and "
                  "43/13 tell what it is",
                  lacks, model_.profile));
}

void Drive::judge_profile() {
  std::string lacks;
  for (std::size_t i = 0; i < model_.objects.size(); ++i) {
    const auto id = static_cast<ObjectId>(i);
    const bool another = store_[id].unlike && moves_by(model_, id);
    if (another || (store_[id].refused && model_.needs(id))) lacks += (lacks.empty() ? "" : ", ") + lacking(id);
  }
  tell_mismatch(lacks);
}

void Drive::end_bring_up() {
  bus_.finish(std::exchange(jobs_.setup, 0));
  const std::string& mismatch = bring_up_.mismatch();
  if (!mismatch.empty()) tell_all(EventKind::warning, 0, "not the configured drive: " + mismatch + ": read-only");
  for (const std::string& note : bring_up_.node().notes()) tell_all(EventKind::warning, 0, note);
  for (auto& axis : axes_) axis->set_alarm(AxisAlarm::identity_mismatch, !mismatch.empty());
  judge_profile();
  if (!bring_up_.adopted() && bring_up_.is_configured()) map_values();
  for (const ObjectId id : bring_up_.unheld())
    event(axes_.front()->core().model.number, EventKind::warning, 0,
          "setup: the drive does not hold what was written to " + model_.object(id).name);
  for (auto& axis : axes_) axis->set_alarm(AxisAlarm::adopted_running, bring_up_.adopted());
  judge_loss_reaction();
  set_state(LinkState::online);
  if (bring_up_.adopted())
    for (auto& axis : axes_) axis->on_adopted();
  for (const auto& axis : axes_)
    event(axis->core().model.number, EventKind::boot, 0,
          bring_up_.adopted() ? "online, found enabled: adopted" : "online");
}

void Drive::judge_checks() {
  for (const Check& check : model_.checks) {
    const ObjectState& s = store_[check.bad.object];
    if (!s.known) continue;
    for (auto& axis : axes_) {
      const bool mine = check.slot == bus::kNoAxis || &axis == &axes_[check.slot];
      if (!mine || !check.bad.holds(model_.object(check.bad.object), static_cast<std::uint32_t>(s.number))) continue;
      axis->set_alarm(check.alarm, true);
    }
  }
}

// Whether the drive notices a dead gateway: what makes it do so must be in it.
void Drive::judge_loss_reaction() {
  const bool armed = std::all_of(model_.setup.begin(), model_.setup.end(), [&](const ObjectWrite& setup) {
    const bool counts =
        std::find(model_.loss_objects.begin(), model_.loss_objects.end(), setup.object) != model_.loss_objects.end();
    return !counts || (store_[setup.object].known && store_[setup.object].number == setup.raw);
  });
  // An adopted drive may hold it from before: whether it watches was not this gateway's doing.
  const std::optional<bool> holds = armed && bring_up_.adopted() ? std::nullopt : std::optional(armed);
  for (auto& axis : axes_) axis->set_loss_reaction(holds);
}

// An enable that is under way, or waits for its turn, would meet the NMT commands of a bring-up.
bool Drive::may_be_set_up_anew() const {
  const bool wanted = !end_.begun() && (bring_up_.adopted() || bring_up_.start().is_due(turn_.now));
  return wanted && std::none_of(axes_.begin(), axes_.end(), [](const auto& axis) { return axis->enable_is_asked(); });
}

// Full bring-up at the first disabled state after an adoption, or after the node left operational.
void Drive::leave_adoption() {
  if (!may_be_set_up_anew()) return;
  // A drive that stands in quick stop active holds its motor: bring-up would find it enabled, and adopt it again.
  const bool enabled = std::any_of(axes_.begin(), axes_.end(), [this](const auto& a) {
    const AxisFacts facts = a->core().facts();
    return facts.enabled() || (bring_up_.has_setup() && holds_motor(facts.state));
  });
  if (enabled) return;
  bring_up_.leave();
  for (auto& axis : axes_) axis->set_alarm(AxisAlarm::adopted_running, false);
  if (bring_up_.has_setup()) begin_bring_up(false);
}

}  // namespace axisgate::drive
