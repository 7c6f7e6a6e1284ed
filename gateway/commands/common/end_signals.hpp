// SPDX-License-Identifier: Apache-2.0
// The signals that end the gateway: SIGTERM, SIGINT and SIGQUIT; SIGHUP where the process was started from a terminal,
// which is then gone. Promises that the first one begins the end on purpose, and a second one ends the process at once;
// that a SIGHUP to a service asks for a reload, and one that whoever started the process has it ignore (nohup) is
// ignored; that one which comes while the process still starts is answered then, and kills nothing; that SIGUSR1,
// SIGUSR2 and the signals of timers end nothing. Never decides what becomes of the drives.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <functional>

#include "gateway/core/log.hpp"

namespace axisgate::commands {

/// Whoever started the process wants it to outlive its terminal (nohup).
[[nodiscard]] bool hangups_are_ignored();

class EndSignals {
 public:
  /// From now on none of them ends the process by itself.
  EndSignals(boost::asio::io_context& io, const Log& log);
  /// `on_end(at_once)` and `on_reload()` run on the loop, also for what has come before.
  void start(std::function<void(bool at_once)> on_end, std::function<void()> on_reload);

 private:
  void wait();
  void on_signal(int signal);

  const Log& log_;
  std::function<void(bool)> on_end_;
  std::function<void()> on_reload_;
  bool has_terminal_;
  bool ending_ = false;
  boost::asio::signal_set signals_;
};

}  // namespace axisgate::commands
