// SPDX-License-Identifier: Apache-2.0
#include "gateway/compose/let_go.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace axisgate::app {
namespace {

using drive::Disarming;

/// Why this drive is not surely disabled, as far as is known without asking it; empty: it must be asked.
std::string not_to_be_asked(const AxisImage& axis) {
  if (axis.link_state != LinkState::online)
    return fmt::format("is {}: what its motor does is not known", text(axis.link_state));
  if ((axis.alarms & bit(AxisAlarm::identity_mismatch)) != 0) return "is another device than the configuration names";
  return {};
}

std::string why_not(Disarming::Outcome outcome) {
  switch (outcome) {
    case Disarming::Outcome::enabled:
      return "has torque";
    case Disarming::Outcome::unknown:
    case Disarming::Outcome::uncertain:
      return "did not tell its state";
    case Disarming::Outcome::nothing_to_do:
    case Disarming::Outcome::disarmed:
    case Disarming::Outcome::disabled:
      break;
  }
  return {};
}

}  // namespace

LetGo::LetGo(Runtime& runtime, const std::vector<BusLine*>& buses, std::function<Reasons()> last_word,
             std::function<void(Reasons)> done)
    : runtime_(runtime),
      last_word_(std::move(last_word)),
      done_(std::move(done)),
      timer_(runtime.make_timer([this] { step(); })) {
  for (BusLine* bus : buses)
    for (const auto& drive : bus->drives()) drives_.push_back(drive.get());
  timer_->expires_at(runtime_.now());
}

LetGo::~LetGo() { reopen(); }

void LetGo::close(Closing why) {
  step_ = why;
  closed_ = true;
  open_.assign(drives_.begin(), drives_.end());
  timer_->expires_at(runtime_.now() + (drives_.empty() ? Duration{} : kLettingGo));
  for (drive::Drive* drive : drives_) {
    drive->close(why, [this, drive, alive = std::weak_ptr(alive_)] {
      if (alive.expired()) return;
      std::erase(open_, drive);
      if (open_.empty()) timer_->expires_at(runtime_.now());
    });
  }
}

void LetGo::step() {
  Reasons problems = in_the_way();
  if (!problems.empty()) return end(std::move(problems));
  if (!closed_) return close(Closing::look);
  if (step_ == Closing::look) return close(Closing::taken_away);
  problems = last_word_();
  if (problems.empty()) closed_ = false;  // they are not ours any more
  end(std::move(problems));
}

void LetGo::reopen() {
  if (!std::exchange(closed_, false)) return;
  for (drive::Drive* drive : drives_) drive->reopen();
}

void LetGo::end(Reasons why_not) {
  reopen();
  std::exchange(done_, nullptr)(std::move(why_not));
}

LetGo::Reasons LetGo::in_the_way() const {
  Reasons out;
  for (const drive::Drive* drive : drives_) {
    for (std::size_t slot = 0; slot < drive->axis_count(); ++slot) {
      const AxisImage& shown = drive->axis(static_cast<bus::AxisSlot>(slot)).image();
      std::string why = not_to_be_asked(shown);
      const bool waits = std::ranges::find(open_, drive) != open_.end();
      if (why.empty() && closed_) why = waits ? "has not come to its end in time" : why_not(drive->closing_outcome());
      if (!why.empty()) out.push_back(fmt::format("axis {} ({}) {}", shown.number, shown.name, why));
    }
  }
  return out;
}

}  // namespace axisgate::app
