// SPDX-License-Identifier: Apache-2.0
#include "adapters/asio/line_input.hpp"

#include <poll.h>
#include <sys/epoll.h>
#include <unistd.h>

#include <array>
#include <boost/asio/post.hpp>
#include <cerrno>
#include <utility>

namespace axisgate {
namespace {

/// Of what nobody waits for; a terminal gives a line a read.
constexpr int kMaxReads = 1024;

}  // namespace

LineInput::LineInput(boost::asio::io_context& context, int descriptor)
    : context_(context), descriptor_(descriptor), terminal_(::isatty(descriptor) == 1), readable_(context) {
  const int watch = ::epoll_create1(EPOLL_CLOEXEC);
  epoll_event event{};
  event.events = EPOLLIN;
  if (watch >= 0 && ::epoll_ctl(watch, EPOLL_CTL_ADD, descriptor, &event) == 0) {
    readable_.assign(watch);
    return;
  }
  ended_ = errno != EPERM;  // EPERM: of a kind that is always ready; else closed, or out of descriptors
  if (watch >= 0) ::close(watch);
}

void LineInput::next(OnLine on_line) {
  on_line_ = std::move(on_line);
  if (terminal_) forget_what_was_typed();
  boost::asio::post(context_, [this, alive = std::weak_ptr(alive_)] {
    if (!alive.expired()) look();
  });
}

void LineInput::forget_what_was_typed() {
  for (int reads = 0; reads < kMaxReads && !ended_ && ready(); ++reads) ended_ = read_some() == Read::end;
  typed_.clear();
}

void LineInput::look() {
  for (;;) {
    if (auto line = cut_line()) return tell(std::move(line));
    if (ended_) return tell(std::nullopt);
    if (readable_.is_open() && !ready()) return wait();
    switch (read_some()) {
      case Read::some:
        break;
      case Read::nothing_yet:
        return wait();
      case Read::end:
        ended_ = true;
    }
  }
}

void LineInput::wait() {
  readable_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                       [this, alive = std::weak_ptr(alive_)](const boost::system::error_code& error) {
                         if (alive.expired()) return;
                         if (error) ended_ = true;
                         look();
                       });
}

void LineInput::tell(std::optional<std::string> line) {
  const OnLine on_line = std::exchange(on_line_, nullptr);
  on_line(std::move(line));  // last: it may destroy us
}

// Who shares a terminal may have read meanwhile what it was readable for; a read would block then.
bool LineInput::ready() const {
  pollfd asked{descriptor_, POLLIN, 0};
  return ::poll(&asked, 1, 0) == 1;
}

LineInput::Read LineInput::read_some() {
  std::array<char, kLongestLine> buffer{};
  const ssize_t got = ::read(descriptor_, buffer.data(), buffer.size());
  if (got > 0) typed_.append(buffer.data(), static_cast<std::size_t>(got));
  if (got > 0 || (got < 0 && errno == EINTR)) return Read::some;
  const bool later = got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK);
  return later && readable_.is_open() ? Read::nothing_yet : Read::end;
}

// A last line without an end of line counts, as everywhere.
std::optional<std::string> LineInput::cut_line() {
  const std::size_t end = typed_.find('\n');
  if (end == std::string::npos && typed_.size() > kLongestLine) {
    typed_.clear();
    ended_ = true;
  }
  if (typed_.empty() || (end == std::string::npos && !ended_)) return std::nullopt;
  std::string line = typed_.substr(0, end);
  typed_.erase(0, end == std::string::npos ? typed_.size() : end + 1);
  return line;
}

}  // namespace axisgate
