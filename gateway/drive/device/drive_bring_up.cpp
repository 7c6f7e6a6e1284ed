// SPDX-License-Identifier: Apache-2.0
// How a drive comes up: bring-up, the checks, and what an adopted one is owed (design 7, point 6).
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gateway/drive/device/answer_width.hpp"
#include "gateway/drive/device/drive.hpp"
#include "gateway/drive/device/requests.hpp"
#include "gateway/drive/plan/planner.hpp"

namespace axisgate::drive {

std::optional<bus::Exchange> Drive::next_of_bring_up() {
  const bool amends = bring_up_.amending();
  const auto next = amends && enable_is_asked() ? std::nullopt : bring_up_.next(store_);
  if (!next && amends) {
    end_amending();
    return std::nullopt;
  }
  if (!next) {
    end_bring_up();
    return std::nullopt;
  }
  if (next->exchange) {
    if (next->exchange->access == bus::Access::command) bring_up_.start().commanded(turn_.now);
    return next->exchange;
  }
  const Instant read_again = bring_up_.reads_back() ? kLongAgo : reads_.tries().again(next->object);
  if (const Instant again = next->write ? bring_up_.write_again() : read_again; turn_.now < again) {
    bus_.wait(jobs_.setup, again);
    return std::nullopt;
  }
  return next->write ? write(next->object, next->number) : read_of(model_, next->object);
}

void Drive::begin_bring_up(bool restarted) {
  if (end_.begun()) {  // nobody would see its end
    turn_.link = LinkState::unknown;
    presence_.look_at(kNever);
    return;
  }
  turn_.link = LinkState::setup;
  presence_.found();
  if (jobs_.setup != 0) bus_.finish(std::exchange(jobs_.setup, 0));  // what was left of its setup is done anew
  unmap_values();
  reads_.restart(turn_.now);
  control_.reset();
  bring_up_.begin();
  if (restarted)
    for (auto& axis : axes_) axis->on_bring_up();
  jobs_.setup = queue_own(bus::Priority::setup);
  // A full queue empties by its deadlines: try again after a probe's pause.
  if (jobs_.setup == 0) {
    turn_.link = LinkState::unknown;
    presence_.look_at(turn_.now + bus::Backoff::kFirst);
  }
}

void Drive::carry_on_bring_up(const bus::Exchange& exchange, const bus::ExchangeResult& result) {
  if (turn_.link != LinkState::setup && !bring_up_.amending()) return;
  const auto next = bring_up_.next(store_);
  if (next && next->exchange) {
    // Lost: asked once more, when the resynchronisation read is answered; but not for ever.
    const bool told = result.code == Errc::ok || result.code == Errc::refused_by_drive;
    const bool lost = result.code == Errc::timed_out || result.code == Errc::bad_reply;
    if (*next->exchange == exchange && (told || (lost && bring_up_.unanswered()))) bring_up_.answered(result);
    return;
  }
  const bool was_write = exchange.access == bus::Access::write;
  if (was_write) {
    if (result.code == Errc::refused_by_drive)
      bring_up_.write_refused(result.for_now, turn_.now);
    else
      bring_up_.written();
    // Whether it can be read is another question now.
    if (const model::ObjectId id = model_.find(exchange.object); result.code == Errc::ok && store_[id].refused)
      store_.forget(id);
  } else if (result.code == Errc::ok) {
    bring_up_.read_back_answered();
  }
  const model::ObjectId asked = model_.find(exchange.object);
  const bool of_state = !was_write && asked != model::kNoObject && model_.needs_for_state(asked);
  // A drive whose statusword has another width is none we can speak for: it stays in setup and is asked again, slowly.
  if (!of_state || result.code != Errc::ok || !store_[asked].refused) return;
  tell_mismatch(lacking(asked));
  bus_.wait(jobs_.setup, turn_.now + std::chrono::seconds(1));
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

// One line for each object, until it answers again.
void Drive::tell_given_up(model::ObjectId id) {
  const model::ObjectDef& object = model_.object(id);
  const auto& refusal = reads_.tries().refusal(id);
  const Axis& axis = *axes_[object.slot == kNoAxis ? 0 : object.slot];
  event(axis.core().model.number, EventKind::warning, 0,
        fmt::format("{} ({}) of node {} {} three times in a row, though the drive answers others: it is for {}; {}",
                    object.name, place_of(model_, id), model_.node,
                    refusal ? fmt::format("was refused (0x{:08X})", *refusal) : "was not answered", uses_of(model_, id),
                    model_.needs_for_state(id) ? "nothing is known of the axis without it, and it is asked each 2 s"
                    : model_.needs(id)         ? "nothing moves without it, and it is asked ever more seldom"
                                               : "the axis goes on without it, and it is asked ever more seldom") +
            limited_by(model_, id));
}

// Without its state there is no axis: a drive that was brought up waits for it again. What moves by it is stopped.
void Drive::on_given_up() {
  const auto given_up = reads_.take_given_up();
  if (given_up.empty()) return;
  for (const auto& [object, first_report] : given_up) {
    if (first_report) tell_given_up(object);
    if (brought_up())
      for (auto& axis : axes_) axis->on_blind(object);
  }
  const auto tells_state = [this](const ObjectTries::GivenUp& g) { return model_.needs_for_state(g.object); };
  if (brought_up() && std::any_of(given_up.begin(), given_up.end(), tells_state)) {
    begin_bring_up(false);
    for (const ObjectTries::GivenUp& g : given_up)
      if (tells_state(g)) reads_.keep_given_up(g.object, turn_.now);
  }
  judge_given_up();
}

void Drive::judge_given_up() {
  if (brought_up()) judge_loss_reaction();
  if (brought_up() || turn_.link == LinkState::setup) judge_profile();
}

std::string Drive::lacking(model::ObjectId object) const {
  const bool silent = reads_.tries().given_up(object) && !reads_.tries().refusal(object);
  return fmt::format("{}{} (0x{:04X})", silent ? "to answer " : "", model_.object(object).name,
                     model_.object(object).address.index);
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
    const auto id = static_cast<model::ObjectId>(i);
    const bool another = store_[id].unlike && moves_by(model_, id);
    if (another || ((store_[id].refused || reads_.tries().given_up(id)) && model_.needs(id)))
      lacks += (lacks.empty() ? "" : ", ") + lacking(id);
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
  for (const model::ObjectId id : bring_up_.unheld())
    event(axes_.front()->core().model.number, EventKind::warning, 0,
          "setup: the drive does not hold what was written to " + model_.object(id).name);
  for (auto& axis : axes_) axis->set_alarm(AxisAlarm::adopted_running, bring_up_.adopted());
  judge_loss_reaction();
  turn_.link = LinkState::online;
  if (bring_up_.adopted())
    for (auto& axis : axes_) axis->on_adopted();
  for (const auto& axis : axes_)
    event(axis->core().model.number, EventKind::boot, 0,
          bring_up_.adopted() ? "online, found enabled: adopted" : "online");
}

void Drive::judge_checks() {
  for (const model::Check& check : model_.checks) {
    const ObjectState& s = store_[check.bad.object];
    if (!s.known) continue;
    for (auto& axis : axes_) {
      const bool mine = check.slot == kNoAxis || &axis == &axes_[check.slot];
      if (!mine || !check.bad.holds(model_.object(check.bad.object), static_cast<std::uint32_t>(s.number))) continue;
      axis->set_alarm(check.alarm, true);
    }
  }
}

// Whether the drive notices a dead gateway: what makes it do so must be in it.
void Drive::judge_loss_reaction() {
  const bool armed = std::all_of(model_.setup.begin(), model_.setup.end(), [&](const model::ObjectWrite& setup) {
    const bool counts =
        std::find(model_.loss_objects.begin(), model_.loss_objects.end(), setup.object) != model_.loss_objects.end();
    return !counts || (store_[setup.object].known && store_[setup.object].number == setup.raw);
  });
  // An adopted drive may hold it from before: whether it watches was not this gateway's doing.
  const std::optional<bool> holds = armed && bring_up_.adopted() ? std::nullopt : std::optional(armed);
  for (auto& axis : axes_) axis->set_loss_reaction(holds);
}

// An enable that is under way, or waits for its turn, would meet the NMT commands of a bring-up.
bool Drive::may_be_set_up_again() const {
  const bool due = bring_up_.adopted() || bring_up_.completed() || bring_up_.start().is_due(turn_.now);
  return due && !end_.begun() && !enable_is_asked();
}

bool Drive::enable_is_asked() const {
  return std::any_of(axes_.begin(), axes_.end(), [](const auto& axis) { return axis->pending().enables(); });
}

// What the drive refused of its setup for now: a heartbeat it must send, or what makes it notice a dead gateway. Tried
// again beside what clients do, as long as no motor of it is enabled; the axis stays online.
void Drive::amend_setup() {
  if (bring_up_.amending() && jobs_.setup == 0) bring_up_.end_amending(turn_.now);  // it was given up with the queue
  const bool may = turn_.link == LinkState::online && jobs_.setup == 0 && !end_.begun() && !enable_is_asked();
  if (!may || turn_.now < bring_up_.amend_due()) return;
  bring_up_.begin_amending(store_, turn_.now);
  jobs_.setup = queue_own(bus::Priority::setup);
}

void Drive::end_amending() {
  bus_.finish(std::exchange(jobs_.setup, 0));
  bring_up_.end_amending(turn_.now);
  judge_loss_reaction();
}

// Full bring-up at the first disabled state after an adoption, or after the node left operational.
void Drive::leave_adoption() {
  if (!may_be_set_up_again()) return;
  // A drive that stands in quick stop active holds its motor: bring-up would find it enabled, and adopt it again.
  const bool enabled = std::any_of(axes_.begin(), axes_.end(), [this](const auto& a) {
    const AxisFacts facts = a->core().facts();
    return facts.enabled() || (bring_up_.has_setup() && model::holds_motor(facts.state));
  });
  if (enabled) return;
  bring_up_.leave();
  for (auto& axis : axes_) axis->set_alarm(AxisAlarm::adopted_running, false);
  if (bring_up_.has_setup()) begin_bring_up(false);
}

}  // namespace axisgate::drive
