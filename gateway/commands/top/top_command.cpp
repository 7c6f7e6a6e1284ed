// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/top/top_command.hpp"
#include "gateway/commands/common/exit_codes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <csignal>
#include <iterator>
#include <map>

#include "gateway/commands/client/host_port.hpp"
#include "gateway/commands/client/named_axis.hpp"
#include "gateway/commands/client/top_client.hpp"
#include "gateway/commands/common/config_faults.hpp"
#include "gateway/commands/top/top_screen.hpp"
#include "gateway/commands/view/top_table.hpp"
#include "gateway/config/config_loader.hpp"
#include "gateway/image/register_map.hpp"
#include "gateway/upstream/modbus_tcp/session/device_identification.hpp"

namespace axisgate::commands {
namespace {

using boost::asio::awaitable;

constexpr std::chrono::milliseconds kAnswerLimit{2000};
constexpr std::chrono::milliseconds kConnectLimit{3000};
constexpr std::chrono::milliseconds kRetryPeriod{1000};
constexpr std::uint8_t kTargetFailed = 0x0B;  // a listener with "offline_reads": "exception" says so of a silent axis

class Top {
 public:
  using Axes = std::map<AxisNumber, config::AxisConfig>;
  /// `asks_names`: of the gateway, for axes that `axes` has not.
  Top(boost::asio::io_context& io, const TopOptions& options, HostPort place, Axes axes, bool asks_names)
      : options_(options),
        place_(std::move(place)),
        axes_(std::move(axes)),
        asks_names_(asks_names),
        client_(io),
        pause_(io),
        screen_(options.plain) {}

  [[nodiscard]] bool has_shown() const { return shown_ != 0; }
  /// What stood in the way last; empty where nothing did.
  [[nodiscard]] const std::string& problem() const { return problem_; }

  /// Ends with the last table; otherwise only when its io_context does.
  awaitable<void> run() {
    for (;;) {
      problem_ = co_await client_.connect(place_.host, place_.port, kConnectLimit);
      if (problem_.empty()) problem_ = co_await watch();
      if (problem_.empty() || options_.count == 1) co_return;
      client_.close();
      screen_.show_message(
          fmt::format("cannot read {}: {}; trying again each second (Ctrl-C ends)", options_.endpoint, problem_));
      co_await wait(kRetryPeriod);
    }
  }

 private:
  /// Shows tables until the last one (empty) or until something is wrong with the connection (what it is).
  awaitable<std::string> watch() {
    std::string problem = co_await find_axes();
    if (!problem.empty()) co_return problem;
    for (;;) {
      problem = co_await refresh();
      if (!problem.empty()) co_return problem;
      problem_.clear();
      show();
      if (++shown_ == options_.count) co_return std::string();
      co_await wait(std::chrono::milliseconds(options_.interval_ms));
    }
  }

  /// Which axes there are does not change while a gateway runs: asked once per connection, number by number until
  /// axis_count are found, since the overview does not tell an absent axis from a silent one.
  awaitable<std::string> find_axes() {
    reading_ = {};
    reading_.server = options_.endpoint;
    std::string problem = co_await read_gateway();
    if (!problem.empty()) co_return problem;
    const ObjectRead numbers = co_await client_.identification(modbus_tcp::kNumbersObject, kAnswerLimit);
    if (!numbers.problem.empty()) co_return numbers.problem;
    reading_.float_numbers = numbers.text == "float";
    if (asks_names_) {
      NamesRead told = co_await read_names(client_, kAnswerLimit);
      if (!told.problem.empty()) co_return told.problem;
      names_ = std::move(told.names);
    }
    const std::uint16_t expected = reading_.gateway[1];
    for (AxisNumber axis = 1; axis <= kMaxAxisNumber && reading_.axes.size() < expected; ++axis) {
      const RegistersRead read =
          co_await client_.read(address_of(Block::axis, axis) + axis_offset(Source::supported), 2, kAnswerLimit);
      if (!read.connected()) co_return read.problem;
      const bool supports = read.ok() && (read.registers[0] != 0 || read.registers[1] != 0);
      if (supports || read.exception == kTargetFailed) reading_.axes.push_back(as_configured(axis));
    }
    co_return std::string();
  }

  [[nodiscard]] AxisReading as_configured(AxisNumber axis) const {
    const auto found = axes_.find(axis);
    if (found == axes_.end()) {
      const auto name = names_.find(axis);
      return {.axis = axis, .name = name == names_.end() ? std::string() : name->second};
    }
    return {.axis = axis, .name = found->second.name, .units_per_rev = found->second.units_per_rev};
  }

  void show() {
    std::vector<TopLine> lines = table_lines(reading_, screen_.columns());
    if (screen_.redraws())
      std::ranges::move(lines_below(reading_, options_.notes, screen_.columns(), screen_.colours()),
                        std::back_inserter(lines));
    screen_.show_table(lines);
  }

  awaitable<std::string> refresh() {
    std::string problem = co_await read_gateway();
    if (!problem.empty()) co_return problem;
    for (AxisReading& axis : reading_.axes) {
      const RegistersRead read =
          co_await client_.read(address_of(Block::axis, axis.axis), kAxisRegisters, kAnswerLimit);
      if (!read.connected()) co_return read.problem;
      if (read.ok()) {
        std::copy(read.registers.begin(), read.registers.end(), axis.registers.begin());
      } else {
        mark_out_of_reach(axis);
      }
    }
    co_return std::string();
  }

  awaitable<std::string> read_gateway() {
    const RegistersRead read = co_await client_.read(0, kGatewayRegisters, kAnswerLimit);
    if (!read.connected()) co_return read.problem;
    if (!read.ok())
      co_return fmt::format("register 0 is answered with exception {}: no axisgate there", read.exception);
    std::copy(read.registers.begin(), read.registers.end(), reading_.gateway.begin());
    if (word_order(reading_.gateway) == WordOrder::unknown) {
      co_return "registers 10 and 11 do not hold the test value: no axisgate there";
    }
    co_return std::string();
  }

  awaitable<void> wait(std::chrono::milliseconds period) {
    pause_.expires_after(period);
    co_await pause_.async_wait(boost::asio::as_tuple(boost::asio::use_awaitable));
  }

  TopOptions options_;
  HostPort place_;
  Axes axes_;          ///< of the configuration, where it is given
  AxisNames names_{};  ///< of the gateway, where it was asked
  bool asks_names_;
  TopClient client_;
  boost::asio::steady_timer pause_;
  TopScreen screen_;
  TopReading reading_;
  std::string problem_;
  std::uint32_t shown_ = 0;
};

/// True: somebody ended it, which is no failure.
bool show_until_told(Top& top, boost::asio::io_context& io, std::uint32_t seconds) {
  bool told_to_end = false;
  boost::asio::signal_set ending(io, SIGINT, SIGTERM);
  ending.async_wait([&](const boost::system::error_code& error, int) {
    if (error) return;
    told_to_end = true;
    io.stop();
  });
  boost::asio::steady_timer last_second(io);
  if (seconds != 0) {
    last_second.expires_after(std::chrono::seconds(seconds));
    last_second.async_wait([&](const boost::system::error_code& error) {
      if (!error) io.stop();
    });
  }
  boost::asio::co_spawn(io, top.run(), [&](const std::exception_ptr& failed) {
    if (failed) std::rethrow_exception(failed);
    io.stop();
  });
  io.run();
  return told_to_end;
}

}  // namespace

int run(const TopOptions& asked) {
  TopOptions options = asked;
  std::optional<HostPort> place;
  if (asked.endpoint.empty()) {
    const auto own = own_place("top", asked.config);
    if (!own) return kWrongCommandLine;
    place = own->place;
    options.endpoint = modbus_tcp::address_text(place->host, place->port);
  } else {
    place = parse_host_port(options.endpoint);
  }
  if (!place) {
    fmt::print(stderr, "axisgate top: {}\n", host_port_mistake(options.endpoint));
    return kWrongCommandLine;
  }
  Top::Axes axes;
  if (!options.config.empty()) {
    const config::LoadResult result = config::load_config(options.config, options.profile_folders);
    if (const auto* faults = std::get_if<std::vector<config::ConfigFault>>(&result)) return tell(*faults);
    for (const config::BusConfig& bus : std::get<config::LoadedConfig>(result).config.buses)
      for (const config::DriveConfig& drive : bus.drives)
        for (const config::AxisConfig& axis : drive.axes) axes[axis.number] = axis;
  }
  std::string problem;
  bool has_shown = false;
  {
    // A scope of its own: the terminal is as it was before the last word is said.
    boost::asio::io_context io(1);
    Top top(io, options, std::move(*place), std::move(axes), asked.endpoint.empty());
    if (show_until_told(top, io, options.seconds)) return 0;
    problem = top.problem();
    has_shown = top.has_shown();
  }
  if (!problem.empty()) fmt::print(stderr, "axisgate top: cannot read {}: {}\n", options.endpoint, problem);
  return has_shown && problem.empty() ? 0 : 1;
}

}  // namespace axisgate::commands
