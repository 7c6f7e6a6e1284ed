// SPDX-License-Identifier: Apache-2.0
#include "adapters/serial/path_watch.hpp"

#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <utility>

namespace axisgate::serial {

namespace {

/// IN_ATTRIB: udev first makes the device, then gives us the right to open it.
constexpr std::uint32_t kEvents = IN_CREATE | IN_MOVED_TO | IN_ATTRIB | IN_ONLYDIR;
/// Reads in one turn of the loop; more events wait for the next.
constexpr int kMaxReads = 16;

}  // namespace

PathWatch::PathWatch(boost::asio::io_context& context, const std::string& path, std::function<void()> on_change)
    : on_change_(std::move(on_change)), inotify_(context) {
  const std::filesystem::path whole(path);
  folder_ = whole.has_parent_path() ? whole.parent_path().string() : ".";
  name_ = whole.filename().string();
  const int descriptor = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  if (descriptor < 0) return;
  inotify_.assign(descriptor);
  wait();
  renew();
}

PathWatch::~PathWatch() = default;

bool PathWatch::renew() {
  if (!inotify_.is_open()) return false;
  // The same folder gives the same watch again, so this costs nothing when all is well.
  watch_ = ::inotify_add_watch(inotify_.native_handle(), folder_.c_str(), kEvents);
  return watch_ >= 0;
}

void PathWatch::wait() {
  inotify_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                      [this, alive = std::weak_ptr(alive_)](const boost::system::error_code& error) {
                        if (alive.expired() || error) return;
                        const bool ours = drain();
                        wait();
                        if (ours) on_change_();  // last: it may destroy us
                      });
}

bool PathWatch::drain() {
  alignas(inotify_event) std::array<char, 4096> buffer{};
  bool ours = false;
  for (int reads = 0; reads < kMaxReads; ++reads) {
    const ssize_t got = ::read(inotify_.native_handle(), buffer.data(), buffer.size());
    if (got <= 0) break;
    for (std::size_t at = 0; at < static_cast<std::size_t>(got);) {
      inotify_event event{};
      std::memcpy(&event, buffer.data() + at, sizeof event);
      const char* name = buffer.data() + at + sizeof event;
      // A lost event may have been ours.
      if ((event.mask & IN_Q_OVERFLOW) != 0 || (event.len > 0 && name_ == name)) ours = true;
      at += sizeof event + event.len;
    }
  }
  return ours;
}

}  // namespace axisgate::serial
