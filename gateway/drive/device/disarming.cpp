// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/disarming.hpp"

#include <algorithm>
#include <array>

#include "gateway/model/cia402.hpp"

namespace axisgate::drive {

void Disarming::begin(const ObjectStore& store, bool broken_off) {
  entries_.clear();
  cleared_ = 0;
  tries_ = 0;
  for (auto last = model_.setup.rbegin(); last != model_.setup.rend(); ++last) {
    const bool watches = std::ranges::find(model_.loss_objects, last->object) != model_.loss_objects.end();
    const bool told = !broken_off || !model_.object(last->object).readable;
    if (watches && last->raw != 0 && (!told || is_armed(*last, store))) entries_.push_back(*last);
  }
  if (entries_.empty()) return end(Outcome::nothing_to_do);
  gather_states();
  if (!broken_off) return look(Phase::look, store);
  phase_ = Phase::look_at_entries;
  at_ = 0;
}

bool Disarming::is_armed(const model::ObjectWrite& entry, const ObjectStore& store) {
  const ObjectState& now = store[entry.object];
  return now.known && !now.refused && now.number == entry.raw;
}

void Disarming::begin_look(const ObjectStore& store) {
  entries_.clear();
  cleared_ = 0;
  gather_states();
  look(Phase::look, store);
}

void Disarming::gather_states() {
  outcome_ = Outcome::unknown;  // till it is known
  states_.clear();
  for (const model::AxisModel& axis : model_.axes)
    for (const model::ObjectId id : axis.state_sources)
      if (std::ranges::find(states_, id) == states_.end()) states_.push_back(id);
}

void Disarming::end(Outcome outcome) {
  phase_ = Phase::over;
  outcome_ = outcome;
}

void Disarming::put_back(Outcome outcome) {
  outcome_ = outcome;
  at_ = 0;
  tries_ = 0;
  phase_ = cleared_ == 0 ? Phase::over : Phase::put_back;
}

void Disarming::look(Phase phase, const ObjectStore& store) {
  phase_ = phase;
  at_ = 0;
  next_state(store);
}

bool Disarming::holds_any_motor(const ObjectStore& store) const {
  return std::ranges::any_of(model_.axes, [&](const model::AxisModel& axis) {
    const ObjectState& status = store[axis.statusword];
    if (!status.known) return true;
    const model::State402 state = model::state_of(static_cast<std::uint16_t>(status.number));
    return model::holds_motor(state) || state == model::State402::fault_reaction_active;
  });
}

// All of them were read: what do they show?
void Disarming::next_state(const ObjectStore& store) {
  if (at_ < states_.size()) return;
  if (holds_any_motor(store)) return put_back(Outcome::enabled);
  if (phase_ == Phase::look_again) return end(Outcome::disarmed);
  if (entries_.empty()) return end(Outcome::disabled);
  phase_ = Phase::clear;
  at_ = 0;
}

std::optional<Disarming::Next> Disarming::next() const {
  switch (phase_) {
    case Phase::look_at_entries:
      return Next{entries_[at_].object, false, 0};
    case Phase::look:
    case Phase::look_again:
      return Next{states_[at_], false, 0};
    case Phase::clear:
      return Next{entries_[at_].object, true, 0};
    case Phase::put_back: {
      // The first of the setup list first: the drive's reaction comes back last, when it knows what to watch for.
      const model::ObjectWrite& entry = entries_[cleared_ - 1 - at_];
      return Next{entry.object, true, entry.raw};
    }
    case Phase::over:
      break;
  }
  return std::nullopt;
}

void Disarming::on_result(const bus::ExchangeResult& result, bool trusted, const ObjectStore& store) {
  const bool answered = trusted && (result.code == Errc::ok || result.code == Errc::refused_by_drive);
  switch (phase_) {
    case Phase::look_at_entries:
      if (!answered) return put_back(Outcome::unknown);
      if (++at_ < entries_.size()) return;
      std::erase_if(entries_, [&](const model::ObjectWrite& entry) { return !is_armed(entry, store); });
      return entries_.empty() ? end(Outcome::nothing_to_do) : look(Phase::look, store);
    case Phase::look:
    case Phase::look_again:
      if (!trusted || result.code != Errc::ok) return put_back(Outcome::unknown);
      ++at_;
      return next_state(store);
    case Phase::clear:
      // A write without an answer may have been carried out.
      cleared_ = at_ + 1;
      if (!answered) return put_back(Outcome::unknown);
      if (++at_ == entries_.size()) look(Phase::look_again, store);
      return;
    case Phase::put_back:
      if (!answered && ++tries_ < kTries) return;
      if (!answered) return end(Outcome::uncertain);
      tries_ = 0;
      if (++at_ == cleared_) phase_ = Phase::over;
      return;
    case Phase::over:
      return;
  }
}

std::string_view text(Disarming::Outcome outcome) {
  constexpr std::array<std::string_view, 6> kTexts{"it does not watch the gateway",
                                                   "no motor has torque: it misses the gateway no more",
                                                   "no motor has torque",
                                                   "a motor has torque: it will stop as if the gateway had died",
                                                   "its state could not be read: it will miss the gateway",
                                                   "its state could not be read, nor whether it will miss the gateway"};
  return kTexts.at(static_cast<std::size_t>(outcome));
}

}  // namespace axisgate::drive
