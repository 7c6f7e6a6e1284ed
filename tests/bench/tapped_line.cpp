// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/tapped_line.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "tests/bench/process.hpp"

namespace axisgate::bench {

TappedLine::TappedLine(const std::string& link, const std::string& drive, MotionProtocol protocol)
    : gateway_(link),
      drive_(::open(drive.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)),
      ending_(::eventfd(0, EFD_CLOEXEC)),
      commands_(make_host_commands(protocol)) {
  if (drive_.get() < 0 || ending_.get() < 0) throw std::runtime_error("cannot open " + drive);
  thread_ = std::thread([this] { relay(); });
}

TappedLine::~TappedLine() {
  const std::uint64_t one = 1;
  static_cast<void>(!::write(ending_.get(), &one, sizeof one));
  thread_.join();
}

void TappedLine::relay() {
  go_before_others();
  std::array<pollfd, 4> watched{{{gateway_.readable(), POLLIN, 0},
                                 {gateway_.closings(), POLLIN, 0},
                                 {drive_.get(), POLLIN, 0},
                                 {ending_.get(), POLLIN, 0}}};
  while (watched[3].revents == 0) {
    if (::poll(watched.data(), watched.size(), -1) <= 0) continue;
    if (watched[0].revents != 0) hear_gateway();
    if (watched[1].revents != 0) gateway_.user_closed();
    if (watched[2].revents != 0) hear_drive();
  }
}

void TappedLine::hear_gateway() {
  const auto bytes = gateway_.read();
  const auto now = steady_now();
  static_cast<void>(!::write(drive_.get(), bytes.data(), bytes.size()));
  for (const std::uint8_t byte : bytes) {
    const auto command = commands_->take(byte, now);
    if (!command) continue;
    const std::lock_guard lock(guard_);
    overflowed_ = overflowed_ || tapped_.size() == kKept;
    if (!overflowed_) tapped_.push_back({now, *command});
    more_.notify_all();
  }
}

void TappedLine::hear_drive() {
  std::array<std::uint8_t, 4096> bytes{};
  const ssize_t got = ::read(drive_.get(), bytes.data(), bytes.size());
  if (got > 0) gateway_.write(std::span(bytes).first(static_cast<std::size_t>(got)));
}

std::vector<TappedCommand> TappedLine::since(std::chrono::nanoseconds from) const {
  const std::lock_guard lock(guard_);
  if (overflowed_) throw std::runtime_error("more commands than the tap keeps: measure for less long");
  const auto first = std::ranges::lower_bound(tapped_, from, {}, &TappedCommand::at);
  return {first, tapped_.end()};
}

std::chrono::nanoseconds TappedLine::await_stop(std::chrono::nanoseconds from, std::chrono::milliseconds patience) {
  std::unique_lock lock(guard_);
  auto stop = tapped_.end();
  const bool stopped = more_.wait_for(lock, patience, [&] {
    stop = std::find_if(std::ranges::lower_bound(tapped_, from, {}, &TappedCommand::at), tapped_.end(),
                        [](const TappedCommand& it) { return (it.command.stopped & kFirstMotor) != 0; });
    return stop != tapped_.end();
  });
  if (!stopped) throw std::runtime_error("no stop on the line");
  return stop->at;
}

}  // namespace axisgate::bench
