// What names a fault is read next, before anything but stops.
#include <algorithm>

#include "gateway/drive/drive.hpp"

namespace axisgate::drive {

std::optional<ObjectId> Drive::cause_to_read() {
  for (auto& axis : axes_)
    if (const auto object = axis->cause_to_read(now())) return object;
  return std::nullopt;
}

std::optional<bus::Exchange> Drive::next_of_causes() {
  const auto object = cause_to_read();
  if (!object) {
    bus_.finish(cause_order_);
    cause_order_ = 0;
    return std::nullopt;
  }
  for (auto& axis : axes_)
    if (axis->cause_to_read(now()) == object) axis->cause_asked(now());
  return read(*object);
}

bool Drive::causes_are_open() const {
  return std::any_of(axes_.begin(), axes_.end(), [](const auto& axis) { return axis->core().fault.withheld(); });
}

// A drive that comes up reads them in its bring-up's own order; out of sight nothing is shown of them.
void Drive::schedule_causes() {
  for (auto& axis : axes_)
    if (axis->fault_is_over())
      for (const ObjectId word : axis->core().causes)
        if (!tells_state(word)) plan_.hurry(word, now());
  if (!brought_up() || !cause_to_read() || cause_order_ != 0) return;
  const Queued queued = queue_own(bus::Priority::cause);
  cause_order_ = queued.code == Errc::ok ? queued.id : 0;
}

}  // namespace axisgate::drive
