// SPDX-License-Identifier: Apache-2.0
// What the gateway tells whoever started it as a service (sd_notify(3), Type=notify): ready, reloading, stopping, and
// that it lives (WatchdogSec). Promises that the loop never waits for whoever listens, who is notified from a thread of
// its own, and the end of the process neither, beyond kLastReport; that the watchdog is fed only while the loop turns
// and every bus had its turn; that without a service manager nothing happens. Never takes an unresponsive drive, a
// missing device or a log that nobody reads for a gateway that hangs.
#pragma once

#include <boost/noncopyable.hpp>
#include <functional>
#include <memory>
#include <string>

#include "gateway/core/clock.hpp"

namespace axisgate::process {

inline constexpr Duration kLastReport = std::chrono::seconds(1);

class Service : boost::noncopyable {
 public:
  /// `all_turn(slack)`: every bus had its turn when it was due, or at most so long ago.
  Service(Runtime& runtime, std::function<bool(Duration slack)> all_turn);
  ~Service();

  /// `status`: one line, as `systemctl status` shows it.
  void ready(const std::string& status);
  void reloading();
  void stopping();

 private:
  struct Teller;
  void feed();

  Runtime& runtime_;
  std::function<bool(Duration)> all_turn_;
  Duration watchdog_{};  ///< WatchdogSec; 0: none is asked for
  std::unique_ptr<Timer> feeds_;
  std::shared_ptr<Teller> teller_;  ///< its thread's, too: whoever listens may never take what it is sent
};

}  // namespace axisgate::process
