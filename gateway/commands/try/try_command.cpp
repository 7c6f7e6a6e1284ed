// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/try/try_command.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <boost/asio/signal_set.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <memory>

#include "adapters/asio/key_input.hpp"
#include "adapters/asio/line_input.hpp"
#include "gateway/commands/common/axis_place.hpp"
#include "gateway/commands/common/config_faults.hpp"
#include "gateway/commands/common/end_signals.hpp"
#include "gateway/commands/common/exit_codes.hpp"
#include "gateway/commands/try/line_output.hpp"
#include "gateway/commands/try/try_bench.hpp"

namespace axisgate::commands {
namespace {

constexpr Duration kTurnPeriod = std::chrono::milliseconds(20);
/// Beyond the gateway's own end on purpose: what is not closed by then is left.
constexpr Duration kCloseLimit = compose::kClosing + std::chrono::seconds(1);

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
}

/// One trial, from the first look to the report.
class Trial {
 public:
  Trial(const config::LoadedConfig& loaded, const AxisPlace& place, const TryOptions& options)
      : log_([this](LogLevel level, std::string_view source,
                    std::string_view message) { take_log(level, source, message); },
             LogLevel::info),
        runtime_(io_),
        plan_(loaded.models[place.bus][place.drive], place.slot,
              {options.axis, options.dry, options.home, loaded.config.buses[place.bus].drives[place.drive].open_before},
              runtime_.now()),
        screen_(STDOUT_FILENO, [this] { plan_.end("the terminal is gone"); }),
        bench_(loaded, place, io_, runtime_, log_),
        lines_(io_, STDIN_FILENO),
        signals_(io_, SIGINT, SIGTERM, SIGQUIT),
        turn_timer_(runtime_.make_timer([this] { turn(); })) {
    if (!hangups_are_ignored()) signals_.add(SIGHUP);
    // They would end or hold this program, and the motor would turn on.
    for (const int signal : {SIGTSTP, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU}) signals_.add(signal);
    if (::isatty(STDIN_FILENO) == 1)
      keys_ = std::make_unique<KeyInput>(
          io_, STDIN_FILENO, KeyInput::Wants::end_alone, [](Bytes) {}, [this] { plan_.end("the terminal is gone"); });
  }
  [[nodiscard]] TryPlan& plan() { return plan_; }
  void say(std::string_view text) {
    for (std::string& line : wrapped(text, 2)) screen_.say(std::move(line));
  }
  void run() {
    await_signal();
    bench_.look();
    turn_timer_->expires_at(runtime_.now());
    io_.run();
    io_.restart();
    close();
  }

 private:
  void take_log(LogLevel level, std::string_view source, std::string_view message) {
    std::string line = fmt::format("{}: {}", source, message);
    if (level <= LogLevel::warning)
      for (std::string& part : wrapped(fmt::format("  log    {}", line), 9)) screen_.say(std::move(part));
    plan_.on_log(std::move(line));
  }
  void turn() {
    bench_.beat();
    plan_.on_look(bench_.seen(), runtime_.now());
    while (const auto order = plan_.take_order())
      bench_.carry_out(*order, [this](std::uint16_t id, const BatchResult& result) { plan_.on_result(id, result); });
    for (std::string& line : plan_.take_words()) screen_.say(std::move(line));
    ask();  // before the question is shown: what was typed before it does not count
    screen_.flush();
    if (plan_.over()) return io_.stop();
    turn_timer_->expires_at(runtime_.now() + kTurnPeriod);
  }
  void ask() {
    if (plan_.asks() == 0 || plan_.asks() == asked_) return;
    asked_ = plan_.asks();
    lines_.next([this](std::optional<std::string> line) { plan_.on_line(std::move(line)); });
  }
  void await_signal() {
    signals_.async_wait([this](const boost::system::error_code& error, int signal) {
      if (error) return;
      await_signal();
      plan_.end(signal == SIGINT    ? "Ctrl-C"
                : signal == SIGHUP  ? "the terminal is gone"
                : signal == SIGTSTP ? "Ctrl-Z"
                                    : fmt::format("signal {}", signal));
    });
  }
  void close() {
    bool closed = false;
    const Instant end = runtime_.now() + kCloseLimit;
    bench_.close([&closed] { closed = true; });
    while (runtime_.now() < end && !(closed && screen_.empty())) {
      io_.run_one_for(kTurnPeriod);
      screen_.flush();
    }
  }

  boost::asio::io_context io_{1};
  Log log_;
  AsioRuntime runtime_;
  TryPlan plan_;
  LineOutput screen_;
  TryBench bench_;  // what it logs is shown
  LineInput lines_;
  std::unique_ptr<KeyInput> keys_;
  boost::asio::signal_set signals_;
  std::unique_ptr<Timer> turn_timer_;
  int asked_ = 0;
};

int tell_end(const TryReport& report, const TryOptions& options, int code) {
  bool kept = true;  // first of all: the terminal may be gone
  if (!options.report.empty()) {
    std::ofstream file(options.report, std::ios::binary | std::ios::trunc);
    file << json_text(report) << std::flush;
    kept = file.good();
  }
  std::string out = "\n";
  for (std::size_t i = 0; i < kTrySteps; ++i)
    out += fmt::format("  {} {:<7} {}\n", i + 1, text(static_cast<TryStep>(i)), text(report.steps[i].verdict));
  if (options.report.empty()) {
    out += "no report was asked for (--report FILE)\n";
  } else {
    out += options.report + (kept ? ": the report\n" : ": the report could not be written\n");
  }
  const bool said = std::fputs(out.c_str(), stdout) >= 0;
  return kept && said ? code : 1;
}

int try_axis(const config::LoadedConfig& loaded, const AxisPlace& place, const TryOptions& options) {
  Trial trial(loaded, place, options);
  trial.say(text(loaded, place));
  if (!options.dry) {
    trial.say(
        "No function of axisgate is a safety function: keep the wired stop in reach. The other drives of this bus must "
        "have no torque. Ctrl-C stops and disables at any time.");
  }
  TryReport& report = trial.plan().report();
  report.config = options.config;
  report.at = utc_now();
  report.version = AXISGATE_VERSION;
  trial.run();
  return tell_end(report, options, trial.plan().exit_code());
}

}  // namespace

int run(const TryOptions& options) {
  if (!keep_stdin_taken() || std::signal(SIGPIPE, SIG_IGN) == SIG_ERR) return 1;
  if (!options.dry && (::isatty(STDIN_FILENO) != 1 || ::isatty(STDOUT_FILENO) != 1)) {
    fmt::print(stderr, "axisgate profile try: needs a terminal, for a person's consents; --dry needs none\n");
    return kWrongCommandLine;
  }
  if (!options.report.empty() && !std::ofstream(options.report, std::ios::binary | std::ios::app)) {
    fmt::print(stderr, "{}: the report could not be written there\n", options.report);
    return 1;
  }
  const config::LoadResult result =
      config::load_config(options.config, options.profile_folders, profile::Pipes::refused, config::OpenAsks::allowed);
  if (const auto* faults = std::get_if<std::vector<config::ConfigFault>>(&result)) return tell(*faults);
  const auto& loaded = std::get<config::LoadedConfig>(result);
  const auto place = find_axis(loaded, options.config, std::to_string(options.axis));
  return place ? try_axis(loaded, *place, options) : 1;
}

}  // namespace axisgate::commands
