// SPDX-License-Identifier: Apache-2.0
#include "gateway/process/service.hpp"

#include <fmt/format.h>
#include <systemd/sd-daemon.h>

#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

namespace axisgate::process {
namespace {

/// Of the watchdog's time: fed so often that one late turn costs nothing.
constexpr int kFeedsEach = 4;
/// Messages that wait for whoever listens.
constexpr std::size_t kMaxUntold = 8;

}  // namespace

struct Service::Teller {
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<std::string> untold;
  bool ended = false;

  void tell(std::string state, std::size_t room) {
    const std::lock_guard lock(mutex);
    if (untold.size() >= room) return;
    untold.push_back(std::move(state));
    changed.notify_all();
  }
  void run() {
    std::unique_lock lock(mutex);
    while (true) {
      changed.wait(lock, [this] { return ended || !untold.empty(); });
      if (untold.empty()) return;
      const std::string state = untold.front();
      lock.unlock();
      static_cast<void>(::sd_notify(0, state.c_str()));
      lock.lock();
      untold.pop_front();
      changed.notify_all();
    }
  }
  void end() {
    std::unique_lock lock(mutex);
    ended = true;
    changed.notify_all();
    changed.wait_for(lock, kLastReport, [this] { return untold.empty(); });
  }
};

Service::Service(Runtime& runtime, std::function<bool(Duration)> all_turn)
    : runtime_(runtime), all_turn_(std::move(all_turn)), feeds_(runtime.make_timer([this] { feed(); })) {
  if (std::getenv("NOTIFY_SOCKET") == nullptr) return;
  teller_ = std::make_shared<Teller>();
  std::thread([teller = teller_] { teller->run(); }).detach();
  std::uint64_t microseconds = 0;
  if (::sd_watchdog_enabled(0, &microseconds) > 0) watchdog_ = std::chrono::microseconds(microseconds);
  if (watchdog_ > Duration{}) feeds_->expires_at(runtime_.now());
}

Service::~Service() {
  if (teller_) teller_->end();
}

void Service::ready(const std::string& status) {
  if (teller_) teller_->tell("READY=1\nSTATUS=" + status, kMaxUntold);
}

// MONOTONIC_USEC: of this message, so that a READY=1 of before is not taken for its end (systemd.service(5)).
void Service::reloading() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  constexpr std::int64_t kMicrosecondsEach = 1'000'000;
  constexpr std::int64_t kNanosecondsEach = 1'000;
  const std::int64_t at = static_cast<std::int64_t>(now.tv_sec) * kMicrosecondsEach + now.tv_nsec / kNanosecondsEach;
  if (teller_)
    teller_->tell(fmt::format("RELOADING=1\nMONOTONIC_USEC={}\nSTATUS=reading the configuration anew", at), kMaxUntold);
}

void Service::stopping() {
  if (teller_) teller_->tell("STOPPING=1\nSTATUS=ending: only stops are accepted", kMaxUntold);
}

// Where something is untold, whoever listens has not taken the last sign of life yet.
void Service::feed() {
  const Duration each = watchdog_ / kFeedsEach;
  feeds_->expires_at(runtime_.now() + each);
  if (all_turn_(2 * each)) teller_->tell("WATCHDOG=1", 1);
}

}  // namespace axisgate::process
