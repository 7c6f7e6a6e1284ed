// A drive when the gateway ends on purpose, or lets go of it (design 7).
#include <string>
#include <utility>

#include "gateway/drive/drive.hpp"

namespace axisgate::drive {

void Drive::close(Closing why, std::function<void()> closed) {
  closing_ = why;
  closed_ = std::move(closed);
  for (auto& axis : axes_) axis->close();
  // A bring-up would arm what is to be disarmed, and start nodes. What it has not read nobody knows: it is left.
  if (setup_order_ != 0) bus_.finish(std::exchange(setup_order_, 0));
  disarming_.give_up();
  if (brought_up()) {
    if (why == Closing::look)
      disarming_.begin_look(store_);
    else
      disarming_.begin(store_);
    // Polls and what else is slow do not hold up the end.
    const Queued queued = queue_own(bus::Priority::command);
    if (queued.code == Errc::ok) closing_order_ = queued.id;
  }
  after_event();
}

void Drive::reopen() {
  const bool disarmed = std::exchange(closing_, std::nullopt) != Closing::look && brought_up();
  closed_ = nullptr;
  if (closing_order_ != 0) bus_.finish(std::exchange(closing_order_, 0));
  for (auto& axis : axes_) axis->reopen();
  if (disarmed && bring_up_.has_setup()) begin_bring_up(false);
  if (state_ == LinkState::unknown) probe_due_ = now();  // a bring-up that was not begun meanwhile
  after_event();
}

// Stops go first, to their end: what a motor does is not known before.
std::optional<bus::Exchange> Drive::next_of_closing() {
  for (const auto& axis : axes_) {
    if (axis->idle() && !axis->owes_stop()) continue;
    constexpr Duration kStopsFirst = std::chrono::milliseconds(10);
    bus_.wait(closing_order_, now() + kStopsFirst);
    return std::nullopt;
  }
  const auto next = disarming_.next();
  if (!next) {
    end_closing();
    return std::nullopt;
  }
  return next->write ? write(next->object, next->number) : read(next->object);
}

void Drive::carry_on_closing(const bus::ExchangeResult& result, bool trusted) {
  disarming_.on_result(result, trusted, store_);
  if (!disarming_.next()) end_closing();
}

void Drive::end_closing() {
  bus_.finish(std::exchange(closing_order_, 0));
  if (closing_ != Closing::gateway_ends || disarming_.outcome() == Disarming::Outcome::nothing_to_do) return;
  for (const auto& axis : axes_)
    event(axis->core().model.number, EventKind::boot, 0,
          "the gateway ends: " + std::string(text(disarming_.outcome())));
}

void Drive::tell_closed() {
  if (!closing_ || closing_order_ != 0 || !closed_) return;
  for (const auto& axis : axes_)
    if (!axis->idle()) return;
  std::exchange(closed_, nullptr)();
}

}  // namespace axisgate::drive
