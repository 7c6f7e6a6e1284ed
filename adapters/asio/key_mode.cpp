// SPDX-License-Identifier: Apache-2.0
#include "adapters/asio/key_mode.hpp"

#include <termios.h>
#include <unistd.h>

namespace axisgate {

struct KeyMode::Found {
  termios mode{};
};

KeyMode::KeyMode(int descriptor) : descriptor_(descriptor) {
  auto found = std::make_unique<Found>();
  if (::tcgetattr(descriptor_, &found->mode) != 0) return;
  found_ = std::move(found);
  termios keys = found_->mode;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  keys.c_iflag &= ~static_cast<tcflag_t>(IXON);
  keys.c_cc[VMIN] = 1;
  keys.c_cc[VTIME] = 0;
  keys.c_cc[VSUSP] = _POSIX_VDISABLE;
  static_cast<void>(::tcsetattr(descriptor_, TCSAFLUSH, &keys));
}

KeyMode::~KeyMode() {
  // Also what was pressed last and not read: it is none of the shell's.
  if (found_) static_cast<void>(::tcsetattr(descriptor_, TCSAFLUSH, &found_->mode));
}

void KeyMode::forget_keys() const { static_cast<void>(::tcflush(descriptor_, TCIFLUSH)); }

}  // namespace axisgate
