// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/try/line_output.hpp"

#include <poll.h>
#include <unistd.h>

#include <cerrno>

namespace axisgate::commands {

void LineOutput::flush() {
  while (!gone_ && !lines_.empty()) {
    pollfd out{descriptor_, POLLOUT, 0};
    if (::poll(&out, 1, 0) != 1) return;
    gone_ = (out.revents & (POLLERR | POLLHUP)) != 0;
    if (gone_ || (out.revents & POLLOUT) == 0) break;
    std::string& line = lines_.front();
    const ssize_t written = ::write(descriptor_, line.data(), line.size());
    if (written < 0 && (errno == EINTR || errno == EAGAIN)) return;
    gone_ = written < 0;
    if (gone_) break;
    line.erase(0, static_cast<std::size_t>(written));
    if (line.empty()) lines_.pop_front();
  }
  if (!gone_) return;
  lines_.clear();
  if (on_gone_) std::exchange(on_gone_, nullptr)();
}

}  // namespace axisgate::commands
