// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/record/record_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>

#include "gateway/commands/common/config_faults.hpp"
#include "gateway/commands/common/exit_codes.hpp"
#include "gateway/commands/record/page_client.hpp"
#include "gateway/commands/record/plan/pieces.hpp"
#include "gateway/commands/record/plan/request.hpp"
#include "gateway/config/config_loader.hpp"

namespace axisgate::commands {
namespace {

using namespace record;
using boost::asio::awaitable;
using std::chrono::steady_clock;

/// What was right by then has come to the page so much later, whatever `sample_ms` is.
constexpr std::chrono::milliseconds kLate{1500};
/// A page that is full or was started anew is asked again while its history still holds what is asked for.
constexpr int kTries = 5;
constexpr unsigned kGood = 200, kMany = 429, kUnavailable = 503;

/// Where it is written to, from the first row on.
class Output {
 public:
  /// Empty: it is open.
  std::string open(const std::string& file) {
    if (file.empty()) return {};
    file_.reset(std::fopen(file.c_str(), "we"));
    return file_ ? std::string() : fmt::format("{}: {}", file, std::strerror(errno));
  }
  bool write(const std::string& rows) {
    std::FILE* const to = file_ ? file_.get() : stdout;
    return std::fwrite(rows.data(), 1, rows.size(), to) == rows.size() && std::fflush(to) == 0;
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
};

class Recording {
 public:
  Recording(boost::asio::io_context& io, const RecordOptions& options, HostPort place)
      : options_(options), page_("http://" + authority_of(place) + "/"), client_(io, std::move(place)), pause_(io) {}

  /// With what there is by now.
  void end() {
    told_to_end_ = true;
    pause_.cancel();
  }
  /// Empty: all of it is written. Else why not.
  awaitable<std::string> run() {
    std::string problem = co_await begin();
    if (!problem.empty()) co_return problem;
    for (Piece piece : pieces_of(from_, to_)) {
      co_await wait_for(piece);
      if (told_to_end_) piece = {piece.from, std::max(page_now(), piece.from + web::kMillisecond), true};
      problem = co_await take(piece);
      if (!problem.empty() || told_to_end_) co_return problem;
    }
    co_return std::string();
  }
  /// Of what was to be recorded some was not in the history any more.
  [[nodiscard]] bool incomplete() const { return incomplete_; }

 private:
  /// Whether the page is there, has these series, and where the file is.
  awaitable<std::string> begin() {
    PageAnswer answer = co_await client_.get("/api/v1/gateway");
    if (!answer.problem.empty())
      co_return fmt::format(
          "{}: {}. Does the gateway run, with a page? \"web\": {{}} in its configuration is one, on port 8080 of this "
          "computer; --config CONFIG finds another",
          page_, answer.problem);
    if (answer.status != kGood) co_return refusal(answer);
    const auto state = page_state(answer.body);
    if (!state) co_return fmt::format("{} is no page of axisgate", page_);
    begun_ = steady_clock::now();
    started_ = state->at;
    if (!state->joined && options_.before == 0)
      co_return fmt::format("{} does not hear its gateway: nothing comes in that could be recorded", page_);
    std::string unknown = co_await find_axes();
    if (!unknown.empty()) co_return unknown;
    answer = co_await client_.get(history_target(series_, {started_ - kSecond, started_}));
    if (!answer.problem.empty()) co_return fmt::format("{}: {}", page_, answer.problem);
    if (answer.status != kGood) co_return refusal(answer);
    from_ = started_ - options_.before * kSecond;
    to_ = options_.before > 0 ? started_ : started_ + options_.seconds * kSecond;
    if (const auto oldest = oldest_of(answer.body); oldest && *oldest > from_) {
      report_lost(from_, std::min(*oldest, to_));
      from_ = std::min(*oldest, to_ - web::kMillisecond);
    }
    std::string problem = output_.open(options_.output);
    if (problem.empty() && options_.before == 0)
      fmt::print(stderr, "axisgate record: {} series for {} s; Ctrl-C ends it with what there is\n", count_of(series_),
                 options_.seconds);
    co_return problem;
  }

  /// The page is asked for names only where one was typed. Empty: it has all of them.
  awaitable<std::string> find_axes() {
    std::vector<AxisNumber> axes;
    std::optional<AxisNames> names;
    for (const std::string& typed : options_.axes) {
      if (const auto number = axis_number_in(typed)) {
        axes.push_back(*number);
        continue;
      }
      if (!names) {
        const PageAnswer answer = co_await client_.get("/api/v1/axes");
        if (!answer.problem.empty()) co_return fmt::format("{}: {}", page_, answer.problem);
        if (answer.status != kGood) co_return refusal(answer);
        names = names_of_axes(answer.body);
      }
      const auto meant = axis_meant(typed, *names, nullptr);
      if (const auto* why = std::get_if<std::string>(&meant)) co_return *why;
      axes.push_back(std::get<AxisNumber>(meant));
    }
    series_ = series_of(axes, options_.series);
    co_return std::string();
  }

  awaitable<std::string> take(const Piece& piece) {
    PageAnswer answer = co_await ask(csv_target(series_, piece));
    if (!answer.problem.empty()) co_return fmt::format("{}: {}; what came before is written", page_, answer.problem);
    if (answer.status != kGood) co_return refusal(answer);
    const auto rows = joiner_.take(answer.body, piece);
    if (!rows) co_return fmt::format("{}: the axes are others than before; what came before is written", page_);
    if (!output_.write(*rows))
      co_return fmt::format("{}: {}", options_.output.empty() ? "standard output" : options_.output,
                            std::strerror(errno));
    answer = co_await ask(history_target(series_, piece));
    const auto oldest = answer.status == kGood ? oldest_of(answer.body) : std::nullopt;
    if (oldest && *oldest > piece.from) report_lost(piece.from, std::min(*oldest, piece.to));
    co_return std::string();
  }

  void report_lost(UtcNs from, UtcNs to) {
    incomplete_ = true;
    fmt::print(stderr,
               "axisgate record: the page's history does not hold {} to {} (its gateway was started after that, or "
               "\"history_mb\" is small)\n",
               utc_text(from), utc_text(to));
  }

  /// Again where it may be answered later.
  awaitable<PageAnswer> ask(const std::string& target) {
    PageAnswer answer;
    for (int left = kTries; left > 0; --left) {
      answer = co_await client_.get(target);
      if (answer.problem.empty() && answer.status != kMany && answer.status != kUnavailable) break;
      if (left == 1 || told_to_end_) break;
      co_await wait_until(steady_clock::now() + options_.pause);
    }
    co_return answer;
  }

  [[nodiscard]] std::string refusal(const PageAnswer& answer) const {
    const std::string detail = detail_of(answer.body);
    return fmt::format("{} answers {}{}{}", page_, answer.status, detail.empty() ? "" : ": ", detail);
  }

  [[nodiscard]] UtcNs page_now() const {
    return started_ + std::chrono::duration_cast<std::chrono::nanoseconds>(steady_clock::now() - begun_).count();
  }
  awaitable<void> wait_for(const Piece& piece) {
    if (options_.before == 0) co_await wait_until(begun_ + std::chrono::nanoseconds(piece.to - started_) + kLate);
  }
  awaitable<void> wait_until(steady_clock::time_point when) {
    if (told_to_end_) co_return;
    pause_.expires_at(when);
    co_await pause_.async_wait(boost::asio::as_tuple(boost::asio::use_awaitable));
  }

  const RecordOptions& options_;
  const std::string page_;
  std::string series_{};  ///< once the axes are found
  PageClient client_;
  boost::asio::steady_timer pause_;
  Output output_;
  Joiner joiner_;
  UtcNs started_ = 0;  ///< by the page's clock
  steady_clock::time_point begun_;
  UtcNs from_ = 0;
  UtcNs to_ = 0;
  bool told_to_end_ = false;
  bool incomplete_ = false;
};

int say(const std::string& problem, int code) {
  fmt::print(stderr, "axisgate record: {}\n", problem);
  return code;
}

/// Of the file; none: what is wrong was told.
std::optional<HostPort> page_of(const RecordOptions& options) {
  const config::LoadResult result = config::load_config(options.config, options.profile_folders);
  if (const auto* faults = std::get_if<std::vector<config::ConfigFault>>(&result)) {
    static_cast<void>(tell(*faults));
    return std::nullopt;
  }
  const auto& web = std::get<config::LoadedConfig>(result).config.web;
  if (!web) {
    static_cast<void>(say(fmt::format("{}: no page is configured, and its history is what is recorded: add "
                                      "\"web\": {{}}, and reload the gateway",
                                      options.config),
                          1));
    return std::nullopt;
  }
  auto place = parse_host_port(web->listen);
  if (place) place = reached_here(*std::move(place));
  return place;
}

}  // namespace

int run(const RecordOptions& options) {
  const std::size_t count = count_of(series_of(std::vector<AxisNumber>(options.axes.size(), 1), options.series));
  if (count > kMostSeries)
    return say(fmt::format("{} series are more than the page answers at once, which is {}: name fewer axes, or fewer "
                           "values with --series",
                           count, kMostSeries),
               kWrongCommandLine);
  const auto place = options.config.empty() ? parse_page_url(options.url) : page_of(options);
  if (!place) return options.config.empty() ? say(page_url_mistake(options.url), kWrongCommandLine) : 1;
  boost::asio::io_context io(1);
  Recording recording(io, options, *place);
  boost::asio::signal_set signals(io);
  if (options.before == 0) {
    signals.add(SIGINT);
    signals.add(SIGTERM);
  }
  signals.async_wait([&](const boost::system::error_code& error, int) {
    if (error) return;
    recording.end();
    signals.clear();  // a second one ends the process at once
  });
  std::string problem;
  boost::asio::co_spawn(io, recording.run(), [&](const std::exception_ptr& failed, std::string why) {
    if (failed) std::rethrow_exception(failed);
    problem = std::move(why);
    io.stop();
  });
  io.run();
  if (!problem.empty()) return say(problem, 1);
  return recording.incomplete() && options.before == 0 ? 1 : 0;
}

}  // namespace axisgate::commands
