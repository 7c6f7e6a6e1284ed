// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/drive_end.hpp"

#include <utility>

namespace axisgate::drive {

bool DriveEnd::begin(Closing why, Known known, const ObjectStore& store, std::function<void()> closed) {
  why_ = why;
  closed_ = std::move(closed);
  disarming_.give_up();
  if (known == Known::nothing || (known == Known::in_part && why == Closing::look)) return false;
  if (why == Closing::look)
    disarming_.begin_look(store);
  else
    disarming_.begin(store, known == Known::in_part);
  return true;
}

bool DriveEnd::take_back() {
  closed_ = nullptr;
  return std::exchange(why_, std::nullopt) != Closing::look;
}

std::string DriveEnd::event_text() const {
  if (why_ != Closing::gateway_ends || outcome() == Disarming::Outcome::nothing_to_do) return {};
  return "the gateway ends: " + std::string(text(outcome()));
}

std::function<void()> DriveEnd::take_closed() { return why_ ? std::exchange(closed_, nullptr) : nullptr; }

}  // namespace axisgate::drive
