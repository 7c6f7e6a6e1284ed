// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/common/end_signals.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <utility>

namespace axisgate::commands {
namespace {

/// /dev/tty can be opened by a process that has a controlling terminal, and by no other (tty(4)).
bool has_controlling_terminal() {
  const int terminal = ::open("/dev/tty", O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (terminal < 0) return false;
  ::close(terminal);
  return true;
}

}  // namespace

bool hangups_are_ignored() {
  struct sigaction now {};
  return ::sigaction(SIGHUP, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

EndSignals::EndSignals(boost::asio::io_context& io, const Log& log)
    : log_(log), has_terminal_(has_controlling_terminal()), signals_(io, SIGINT, SIGTERM, SIGQUIT) {
  // Nobody who sends them means the end, which is what they do by themselves.
  for (const int signal : {SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF}) std::signal(signal, SIG_IGN);
  if (!hangups_are_ignored()) signals_.add(SIGHUP);
}

void EndSignals::start(std::function<void(bool at_once)> on_end, std::function<void()> on_reload) {
  on_end_ = std::move(on_end);
  on_reload_ = std::move(on_reload);
  wait();
}

void EndSignals::wait() {
  signals_.async_wait([this](const boost::system::error_code& error, int signal) {
    if (error) return;
    wait();
    on_signal(signal);
  });
}

void EndSignals::on_signal(int signal) {
  if (signal == SIGHUP && !has_terminal_) {
    log_.write(LogLevel::info, "gateway", "signal 1: the configuration is read anew", LogPace::each);
    return on_reload_();
  }
  if (std::exchange(ending_, true)) {
    log_.write(LogLevel::warning, "gateway", fmt::format("signal {} again: ending at once", signal), LogPace::each);
    return on_end_(true);
  }
  log_.write(LogLevel::info, "gateway",
             fmt::format("signal {}: ending; the drives keep what they do, and only stops are accepted now. One that "
                         "watches for a dead gateway will miss it if a motor of it has torque",
                         signal),
             LogPace::each);
  on_end_(false);
}

}  // namespace axisgate::commands
