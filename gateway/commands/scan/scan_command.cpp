// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/scan/scan_command.hpp"
#include "gateway/commands/common/exit_codes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <cstdio>
#include <memory>

#include "adapters/asio/asio_runtime.hpp"
#include "adapters/bus/bus.hpp"
#include "adapters/can/can_device.hpp"
#include "adapters/can/link/make_can_link.hpp"
#include "adapters/canopen/canopen_wire.hpp"
#include "gateway/commands/common/profile_folders.hpp"
#include "gateway/commands/scan/plan/scan_table.hpp"
#include "gateway/commands/scan/scan_progress.hpp"
#include "gateway/commands/scan/serial_scan.hpp"

namespace axisgate::commands {
namespace {

/// A bus that cannot be spoken on by then is not waited for.
constexpr Duration kUpLimit = std::chrono::seconds(3);

/// The scan of one bus, from its opening to its end.
class Scanner {
 public:
  Scanner(const ScanOptions& options, ScanPlan plan, boost::asio::io_context& io);
  void start(std::function<void()> on_end);
  /// The first reason counts; empty: all were asked.
  void end(std::string_view why);

  [[nodiscard]] const ScanPlan& plan() const { return plan_; }
  [[nodiscard]] bool was_up() const { return was_up_; }
  [[nodiscard]] const std::string& why() const { return why_; }
  [[nodiscard]] std::uint32_t late_replies() const { return bus_.statistics().late_replies; }
  [[nodiscard]] ScanProgress& progress() { return progress_; }

 private:
  /// Each node-ID is a drive of the bus, so that what a node says unasked is heard; all of them share the plan.
  class Node final : public bus::BusDrive {
   public:
    Node(Scanner& scan, std::uint8_t node) : scan_(scan), node_(node) {}
    std::optional<bus::Exchange> on_grant(const bus::Arbiter::Grant&) override { return scan_.next_for(node_); }
    void on_result(const bus::Exchange&, const bus::ExchangeResult& result) override { scan_.on_result(result); }
    void on_job_ended(const bus::Arbiter::Ending&) override {}  // a scan submits no bus jobs, it polls
    void on_link(bool up) override { scan_.on_link(up); }
    [[nodiscard]] std::uint8_t node() const override { return node_; }
    void on_unsolicited(const bus::UnsolicitedEvent& unsolicited) override { scan_.plan_.heard(unsolicited); }

   private:
    Scanner& scan_;
    std::uint8_t node_;
  };
  static_assert(ScanPlan::kLastNode <= bus::kMaxDrivesPerBus);

  [[nodiscard]] static std::unique_ptr<bus::Wire> make_wire(const ScanOptions& options, boost::asio::io_context& io,
                                                            Runtime& runtime, const Log& log);
  void on_log(LogLevel level, std::string_view message);
  void on_not_opened(const OpeningFailure& failure);
  void on_link(bool up);
  void on_result(const bus::ExchangeResult& result);
  [[nodiscard]] std::optional<bus::Exchange> next_for(std::uint8_t node) const;
  void ask_next();
  void tell_progress();

  AsioRuntime runtime_;
  Log log_;
  ScanPlan plan_;
  ScanProgress progress_;
  std::function<void()> on_end_;
  std::string complaint_;  ///< the link's last
  std::string why_;
  bool was_up_ = false;
  bool ended_ = false;
  std::vector<std::unique_ptr<Node>> nodes_;
  std::unique_ptr<Timer> up_limit_;
  bus::Bus bus_;  // last, so that it goes first: it calls the nodes and logs
};

std::unique_ptr<bus::Wire> Scanner::make_wire(const ScanOptions& options, boost::asio::io_context& io, Runtime& runtime,
                                              const Log& log) {
  canopen::CanopenSettings settings;  // no heartbeat, no SYNC, no guarding: a scan is only seen by its reads
  settings.name = "scan";
  settings.timeout = std::chrono::milliseconds(options.timeout_ms);
  for (std::uint8_t node = 1; node <= ScanPlan::kLastNode; ++node) {
    settings.nodes.emplace_back();
    settings.nodes.back().node = node;
  }
  auto link = can::make_can_link(options.device, options.bitrate, settings.name, io, runtime, log);
  return canopen::make_canopen_wire(std::move(settings), std::move(link), runtime, log);
}

Scanner::Scanner(const ScanOptions& options, ScanPlan plan, boost::asio::io_context& io)
    : runtime_(io),
      log_([this](LogLevel level, std::string_view, std::string_view message) { on_log(level, message); },
           LogLevel::info, [this](const OpeningFailure& failure) { on_not_opened(failure); }),
      plan_(std::move(plan)),
      up_limit_(runtime_.make_timer([this] { end(complaint_); })),
      bus_({.name = "scan", .timeout = std::chrono::milliseconds(options.timeout_ms)}, ScanPlan::kLastNode,
           make_wire(options, io, runtime_, log_), runtime_, log_) {
  complaint_ = fmt::format("{}: cannot be spoken on", options.device);
  for (std::uint8_t node = 1; node <= ScanPlan::kLastNode; ++node) {
    nodes_.push_back(std::make_unique<Node>(*this, node));
    bus_.attach(static_cast<DriveSlot>(node - 1), *nodes_.back());
  }
}

void Scanner::start(std::function<void()> on_end) {
  on_end_ = std::move(on_end);
  up_limit_->expires_at(runtime_.now() + kUpLimit);
  bus_.start();
}

void Scanner::end(std::string_view why) {
  if (std::exchange(ended_, true)) return;
  why_ = why;
  up_limit_->expires_at(kNever);
  progress_.clear();
  on_end_();
}

void Scanner::on_log(LogLevel level, std::string_view message) {
  if (!was_up_ || level <= LogLevel::warning) complaint_ = message;
}

/// The link goes on trying: a scan does not.
void Scanner::on_not_opened(const OpeningFailure& failure) {
  complaint_ = failure.why;
  if (!was_up_ && !ended_) up_limit_->expires_at(runtime_.now());
}

void Scanner::on_link(bool up) {
  if (!up) {
    end(complaint_);
  } else if (!std::exchange(was_up_, true)) {
    up_limit_->expires_at(kNever);
    ask_next();
  }
}

std::optional<bus::Exchange> Scanner::next_for(std::uint8_t node) const {
  auto next = plan_.next();
  if (ended_ || !next || next->node != node) return std::nullopt;
  return next;
}

void Scanner::on_result(const bus::ExchangeResult& result) {
  // The exchange that a lost link took with it says nothing of the node.
  if (ended_ || !bus_.up()) return;
  plan_.on_result(result);
  tell_progress();
  ask_next();
}

void Scanner::ask_next() {
  const auto next = plan_.next();
  if (!next) return end({});
  bus_.set_poll_due(static_cast<DriveSlot>(next->node - 1), runtime_.now());
}

void Scanner::tell_progress() {
  const Instant now = runtime_.now();
  if (!progress_.due(now)) return;
  const auto next = plan_.next();
  const std::string at = !next              ? ""
                         : plan_.knocking() ? fmt::format(", now node {}", next->node)
                                            : fmt::format(", reading what node {} is", next->node);
  const int nodes = plan_.range().count();
  progress_.show(fmt::format("{} of {} nodes asked, {} found{}", plan_.nodes_asked(), nodes, plan_.found().size(), at),
                 now);
}

std::string where_to_look(const ScanOptions& options) {
  const bool lawicel = can::parse_can_device(options.device).lawicel;
  const std::string rate = lawicel ? fmt::format("the adapter was opened with {} (--bitrate)", options.bitrate)
                                   : fmt::format("`ip -details link show {}` shows the interface's", options.device);
  return fmt::format(
      "Look at:\n"
      "  the drives       powered, CANopen chosen where they offer several protocols, a node-ID set\n"
      "  the cable        CAN_H to CAN_H, CAN_L to CAN_L, and a common ground\n"
      "  the bit rate     the same in every drive; {}\n"
      "  the termination  120 ohm at both ends of the line: 60 ohm between CAN_H and CAN_L, all power off\n",
      rate);
}

void tell_why(const ScanOptions& options, const Scanner& scan) {
  fmt::print(stderr, "{}\n", scan.why());
  if (scan.was_up()) return;
  if (can::parse_can_device(options.device).lawicel)
    fmt::print(stderr, "Is the adapter plugged in? ls -l /dev/serial/by-id lists those that are there.\n");
}

int tell(const ScanOptions& options, const Scanner& scan) {
  const std::vector<FoundNode> found = scan.plan().found();
  fmt::print("{}", scan_table(found));
  std::fflush(stdout);
  const bool all_asked = scan.why().empty();
  if (!all_asked) tell_why(options, scan);
  if (all_asked && found.empty())
    fmt::print(stderr, "nothing answered on {}: {} node{} asked, each waited for {} ms. ", options.device,
               scan.plan().nodes_asked(), scan.plan().nodes_asked() == 1 ? "" : "s", options.timeout_ms);
  if (found.empty() && scan.was_up()) fmt::print(stderr, "{}", where_to_look(options));
  if (scan.late_replies() > 0)
    fmt::print(stderr,
               "{} answers came that nobody waited for any more, or that somebody else had asked for: scan again with "
               "a longer --timeout-ms, and with no gateway on this bus\n",
               scan.late_replies());
  return all_asked && !found.empty() ? 0 : 1;
}

}  // namespace

int run(const ScanOptions& options) {
  // A CAN interface's name has no '/'.
  if (!can::parse_can_device(options.device).lawicel && options.device.find('/') != std::string::npos)
    return run_serial_scan(options);
  if (const std::string mistake = can::can_device_mistake(options.device, options.bitrate); !mistake.empty()) {
    fmt::print(stderr, "axisgate scan: {}\n", mistake);
    return kWrongCommandLine;
  }
  boost::asio::io_context io(1);
  Scanner scan(options, ScanPlan(profiles_in(options.profile_folders), options.nodes), io);
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  signals.async_wait([&](const boost::system::error_code& error, int) {
    if (!error) scan.end("ended before all nodes were asked");
  });
  scan.start([&io] { io.stop(); });
  io.run();
  return tell(options, scan);
}

}  // namespace axisgate::commands
