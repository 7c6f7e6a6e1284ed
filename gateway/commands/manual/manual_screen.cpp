// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/manual/manual_screen.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace axisgate::commands {
namespace {

constexpr std::size_t kUsualWidth = 80;

std::size_t width() {
  winsize size{};
  return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col : kUsualWidth;
}

}  // namespace

ManualScreen::ManualScreen(std::function<void()> on_gone)
    : on_gone_(std::move(on_gone)), terminal_(::isatty(STDOUT_FILENO) == 1) {}

void ManualScreen::show(std::string_view line, std::string_view doing, Instant now) {
  if (terminal_) {
    // The last column stays empty: some terminals begin a new line there.
    put("\r" + std::string(line.substr(0, width() - 1)) + "\x1b[K");
    on_line_ = true;
    return;
  }
  if (now < next_ && doing == last_doing_) return;
  next_ = now + kElsewhere;
  last_doing_ = doing;
  put(std::string(line) + "\n");
}

void ManualScreen::clear() {
  if (std::exchange(on_line_, false)) put("\r\x1b[K");
}

void ManualScreen::say(std::string_view line) {
  clear();
  put(std::string(line) + "\n");
}

void ManualScreen::put(std::string_view text) {
  if (gone_) return;
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  if (::poll(&out, 1, 0) == 1 && (out.revents & (POLLERR | POLLHUP)) == 0) {
    if (::write(STDOUT_FILENO, text.data(), text.size()) >= 0 || errno == EINTR || errno == EAGAIN) return;
  } else if ((out.revents & (POLLERR | POLLHUP)) == 0) {
    return;  // it takes nothing now
  }
  gone_ = true;
  on_gone_();
}

}  // namespace axisgate::commands
