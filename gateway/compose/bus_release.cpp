// SPDX-License-Identifier: Apache-2.0
#include "gateway/compose/bus_release.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gateway/model/cia402.hpp"

namespace axisgate::compose {
namespace {

using drive::Disarming;

/// Commands that are under way are looked at again after so long.
constexpr Duration kCommandsFirst = std::chrono::milliseconds(10);

/// Why this drive is not surely disabled, as far as is known without asking it; empty: it must be asked.
std::string not_to_be_asked(const AxisImage& axis) {
  if (axis.link_state != LinkState::online)
    return fmt::format("is {}: what its motor does is not known", text(axis.link_state));
  if ((axis.alarms & bit(AxisAlarm::identity_mismatch)) != 0) return "is another device than the configuration names";
  return {};
}

constexpr const char* kHasTorque = "has torque";

/// No motor that has torque gets as far as to have its commands broken off.
bool shows_torque(const AxisImage& axis) {
  return model::holds_motor(model::state_of(static_cast<std::uint16_t>(axis[Quantity::statusword].value)));
}

std::string found(Disarming::Outcome outcome) {
  switch (outcome) {
    case Disarming::Outcome::enabled:
      return kHasTorque;
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

BusRelease::BusRelease(Runtime& runtime, const std::vector<BusLine*>& buses, std::function<Reasons()> last_word,
                       std::function<void(Reasons)> done)
    : runtime_(runtime),
      looked_by_(runtime.now() + kBusReleaseStep),
      last_word_(std::move(last_word)),
      done_(std::move(done)),
      timer_(runtime.make_timer([this] { step(); })) {
  for (BusLine* bus : buses)
    for (const auto& drive : bus->drives()) drives_.push_back(drive.get());
  timer_->expires_at(runtime_.now());
}

BusRelease::~BusRelease() { reopen(); }

void BusRelease::close(Closing why, Instant by) {
  step_ = why;
  closed_ = true;
  open_.assign(drives_.begin(), drives_.end());
  timer_->expires_at(drives_.empty() ? runtime_.now() : by);
  for (drive::Drive* drive : drives_) {
    drive->close(why, [this, drive, alive = std::weak_ptr(alive_)] {
      if (alive.expired()) return;
      std::erase(open_, drive);
      if (open_.empty()) timer_->expires_at(runtime_.now());
    });
  }
}

void BusRelease::step() {
  Reasons problems = in_the_way();
  if (!problems.empty()) return end(std::move(problems));
  if (!closed_ && commands_are_under_way()) return timer_->expires_at(runtime_.now() + kCommandsFirst);
  if (!closed_) return close(Closing::look, looked_by_);
  if (step_ == Closing::look) return close(Closing::taken_away, runtime_.now() + kBusReleaseStep);
  problems = last_word_();
  if (problems.empty()) closed_ = false;  // they are not ours any more
  end(std::move(problems));
}

void BusRelease::reopen() {
  if (!std::exchange(closed_, false)) return;
  for (drive::Drive* drive : drives_) drive->reopen();
}

void BusRelease::end(Reasons why_not) {
  reopen();
  std::exchange(done_, nullptr)(std::move(why_not));
}

BusRelease::Reasons BusRelease::in_the_way() const {
  Reasons out;
  for (const drive::Drive* drive : drives_) {
    for (std::size_t slot = 0; slot < drive->axis_count(); ++slot) {
      const drive::Axis& axis = drive->axis(static_cast<AxisSlot>(slot));
      const std::string why = why_not(*drive, axis);
      if (!why.empty()) out.push_back(fmt::format("axis {} ({}) {}", axis.image().number, axis.image().name, why));
    }
  }
  return out;
}

std::string BusRelease::why_not(const drive::Drive& drive, const drive::Axis& axis) const {
  if (std::string why = not_to_be_asked(axis.image()); !why.empty()) return why;
  if (closed_ && std::ranges::find(open_, &drive) != open_.end()) return "has not come to its end in time";
  if (closed_) return found(drive.closing_outcome());
  if (shows_torque(axis.image())) return kHasTorque;
  const bool in_time = runtime_.now() < looked_by_;
  return axis.pending().empty() || in_time ? ""
                                           : "carries out commands all the time: reload while its clients are quiet";
}

bool BusRelease::commands_are_under_way() const {
  return std::ranges::any_of(drives_, [](const drive::Drive* drive) {
    for (std::size_t slot = 0; slot < drive->axis_count(); ++slot)
      if (!drive->axis(static_cast<AxisSlot>(slot)).pending().empty()) return true;
    return false;
  });
}

}  // namespace axisgate::compose
