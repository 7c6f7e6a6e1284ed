// SPDX-License-Identifier: Apache-2.0
#include "adapters/asio/key_input.hpp"

#include <sys/epoll.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace axisgate {

KeyInput::KeyInput(boost::asio::io_context& context, int descriptor, Wants wants, OnBytes on_bytes,
                   std::function<void()> on_end)
    : descriptor_(descriptor), on_bytes_(std::move(on_bytes)), on_end_(std::move(on_end)), watch_(context) {
  const int watch = ::epoll_create1(EPOLL_CLOEXEC);
  if (watch < 0) return;
  epoll_event event{};
  event.events = wants == Wants::bytes ? EPOLLIN : 0U;  // a hang-up is told without being asked for
  if (::epoll_ctl(watch, EPOLL_CTL_ADD, descriptor, &event) != 0) {
    ::close(watch);
    return;
  }
  watch_.assign(watch);
  wait();
}

void KeyInput::wait() {
  watch_.async_wait(boost::asio::posix::stream_descriptor::wait_read, [this](const boost::system::error_code& error) {
    if (!error) look();
  });
}

void KeyInput::look() {
  epoll_event event{};
  if (::epoll_wait(watch_.native_handle(), &event, 1, 0) != 1) return wait();
  ssize_t got = 0;
  if ((event.events & EPOLLIN) != 0) {
    got = ::read(descriptor_, typed_.data(), typed_.size());
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return wait();
  }
  if (got <= 0) {
    watch_.close();
    return on_end_();
  }
  wait();
  on_bytes_(Bytes(typed_).first(static_cast<std::size_t>(got)));
}

}  // namespace axisgate
