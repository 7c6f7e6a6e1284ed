// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/scan/serial_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <cstdio>
#include <memory>

#include "adapters/asio/asio_runtime.hpp"
#include "adapters/kinco/kinco_wire.hpp"
#include "adapters/modbus_rtu/link/libmodbus_link.hpp"
#include "adapters/modbus_rtu/rtu_wire.hpp"
#include "adapters/serial/serial_link.hpp"
#include "gateway/commands/common/profile_folders.hpp"
#include "gateway/commands/scan/scan_progress.hpp"
#include "gateway/config/adapter_names.hpp"

namespace axisgate::commands {
namespace {

/// A port that cannot be opened by then is not waited for.
constexpr Duration kOpenLimit = std::chrono::seconds(3);

/// The scan of one line, from its first opening to its end: one speech after the other, each with a wire of its own.
class SerialScanner final : private bus::WireEvents {
 public:
  SerialScanner(const ScanOptions& options, std::vector<profile::Profile> profiles, boost::asio::io_context& io);
  void start();
  /// The first reason counts; empty: all were asked.
  void end(std::string_view why);

  [[nodiscard]] const SerialScanPlan& plan() const { return plan_; }
  [[nodiscard]] const std::string& why() const { return why_; }
  [[nodiscard]] std::uint32_t late_replies() const { return late_; }
  [[nodiscard]] std::uint32_t bad_frames() const { return bad_; }
  [[nodiscard]] std::uint32_t dropped_bytes() const { return dropped_; }
  [[nodiscard]] std::uint32_t echoes() const { return echoes_; }

 private:
  void on_wire_up() override { soon(); }
  void on_wire_down(std::string_view why) override { end(why); }
  void on_reply(const bus::ExchangeResult& result) override { take(result); }
  void on_unsolicited(const bus::UnsolicitedEvent&) override {}

  void on_not_opened(const OpeningFailure& failure);
  [[nodiscard]] std::unique_ptr<bus::Wire> wire_for(const SerialSpeech& speech);
  void drop_wire();
  /// From the loop: neither wires nor their links are called or dropped from inside their own calls.
  void soon();
  void go_on();
  void take(const bus::ExchangeResult& result);
  void tell_progress();

  const ScanOptions& options_;
  boost::asio::io_context& io_;
  AsioRuntime runtime_;
  Log log_;
  std::vector<profile::Profile> profiles_;
  SerialScanPlan plan_;
  ScanProgress progress_;
  std::string complaint_;
  std::string why_;
  bool ended_ = false;
  bool opened_ = false;
  bool asked_ = false;
  std::uint32_t late_ = 0, bad_ = 0, dropped_ = 0, echoes_ = 0;
  std::unique_ptr<Timer> open_limit_;
  std::unique_ptr<Timer> answer_limit_;
  std::optional<SerialSpeech> speech_;
  std::unique_ptr<bus::Wire> wire_;  // last, so that it goes first: it calls back
};

SerialScanner::SerialScanner(const ScanOptions& options, std::vector<profile::Profile> profiles,
                             boost::asio::io_context& io)
    : options_(options),
      io_(io),
      runtime_(io),
      log_({}, LogLevel::info, [this](const OpeningFailure& failure) { on_not_opened(failure); }),
      profiles_(std::move(profiles)),
      plan_(profiles_, options.serial),
      complaint_(fmt::format("{}: cannot be opened", options.device)),
      open_limit_(runtime_.make_timer([this] { end(complaint_); })),
      answer_limit_(runtime_.make_timer([this] {
        wire_->abandon();
        bus::ExchangeResult nobody;
        nobody.code = Errc::timed_out;
        take(nobody);
      })) {}

void SerialScanner::start() {
  const auto longest = longest_silence(plan_, std::chrono::milliseconds(options_.timeout_ms));
  const SerialScanSettings& serial = options_.serial;
  progress_.say(
      fmt::format("{} rate(s), {} station(s): {} reads, {} s at most where nobody answers; Ctrl-C shows what was found",
                  serial.bauds.size(), serial.stations.count(), plan_.knocks(),
                  (longest + std::chrono::milliseconds(999)) / std::chrono::seconds(1)));
  soon();
}

void SerialScanner::end(std::string_view why) {
  if (std::exchange(ended_, true)) return;
  why_ = why;
  progress_.clear();
  io_.stop();
}

/// The link goes on trying: a scan does not.
void SerialScanner::on_not_opened(const OpeningFailure& failure) {
  complaint_ = failure.why;
  open_limit_->expires_at(runtime_.now());
}

std::unique_ptr<bus::Wire> SerialScanner::wire_for(const SerialSpeech& speech) {
  serial::SerialSettings settings;
  settings.device = options_.device;
  settings.baud = speech.baud;
  if (options_.parity == "even") settings.parity = serial::Parity::even;
  if (options_.parity == "odd") settings.parity = serial::Parity::odd;
  if (speech.protocol == config::adapter::kKincoSerial) {
    auto link = std::make_unique<serial::SerialLink>("scan", settings, io_, runtime_, log_);
    return std::make_unique<kinco::KincoWire>("scan", std::move(link), runtime_, log_);
  }
  std::vector<std::uint8_t> errors;
  for (const profile::Profile& profile : profiles_)
    if (const auto spec = profile.protocols.find(speech.protocol); spec != profile.protocols.end())
      errors.insert(errors.end(), spec->second.rtu.error_functions.begin(), spec->second.rtu.error_functions.end());
  std::vector<modbus_rtu::RtuNode> nodes;
  for (int station = 1; station <= kLastRtuStation; ++station)
    nodes.push_back({.node = static_cast<std::uint8_t>(station), .error_functions = errors});
  const int parity_bits = settings.parity == serial::Parity::none ? 0 : 1;
  auto link = std::make_unique<modbus_rtu::LibmodbusLink>("scan", settings, io_, runtime_, log_);
  return std::make_unique<modbus_rtu::RtuWire>(
      "scan", std::move(nodes), modbus_rtu::LineSpeed{speech.baud, parity_bits}, std::move(link), runtime_, log_);
}

void SerialScanner::drop_wire() {
  if (!wire_) return;
  late_ += wire_->statistics().late_replies;
  bad_ += wire_->statistics().bad_frames;
  dropped_ += wire_->statistics().dropped_bytes;
  echoes_ += wire_->statistics().echoes;
  wire_.reset();
}

void SerialScanner::soon() {
  boost::asio::post(io_, [this] { go_on(); });
}

void SerialScanner::go_on() {
  if (ended_ || asked_) return;
  const auto wanted = plan_.speech();
  if (!wanted) {
    drop_wire();
    return end({});
  }
  if (wanted != speech_) {
    drop_wire();
    speech_ = wanted;
    open_limit_->expires_at(runtime_.now() + kOpenLimit);
    wire_ = wire_for(*wanted);
    wire_->start(*this);  // on_wire_up() goes on
    return;
  }
  open_limit_->expires_at(kNever);
  asked_ = true;
  answer_limit_->expires_at(runtime_.now() + std::chrono::milliseconds(options_.timeout_ms));
  wire_->send(*plan_.next());
}

void SerialScanner::take(const bus::ExchangeResult& result) {
  if (ended_ || !asked_) return;
  asked_ = false;
  answer_limit_->expires_at(kNever);
  plan_.on_result(result);
  tell_progress();
  soon();
}

void SerialScanner::tell_progress() {
  const Instant now = runtime_.now();
  if (!progress_.due(now) || !speech_) return;
  const auto next = plan_.next();
  progress_.show(fmt::format("{} % asked, {} found, now {} at {} baud{}",
                             plan_.knocks() == 0 ? 100 : 100 * plan_.knocked() / plan_.knocks(), plan_.found().size(),
                             speech_->protocol, speech_->baud, next ? fmt::format(", station {}", next->node) : ""),
                 now);
}

/// What the line itself did, in the words that the gateway's log has for it.
void tell_line(const SerialScanner& scan, bool found) {
  if (!found && scan.echoes() > 0)
    fmt::print(
        stderr,
        "{} copies of the scan's own reads came and no answer: the adapter hears itself, or the line is looped\n",
        scan.echoes());
  if (found && scan.echoes() > 0)
    fmt::print(stderr,
               "the line echoes: {} copies of the scan's own reads came back and were dropped, as the gateway does\n",
               scan.echoes());
  if (found && scan.bad_frames() == 0 && scan.dropped_bytes() > 0)
    fmt::print(stderr,
               "{} bytes came before answers and were skipped, as the gateway does: a transceiver that turns round\n",
               scan.dropped_bytes());
  if (!found && scan.bad_frames() + scan.dropped_bytes() > 0)
    fmt::print(stderr, "bytes came that are no answer: somebody else speaks there, or the rate is another\n");
}

int tell_serial(const ScanOptions& options, const SerialScanner& scan) {
  fmt::print("{}", serial_scan_table(scan.plan().found(), options.device));
  std::fflush(stdout);
  const bool all_asked = scan.why().empty();
  const bool found = !scan.plan().found().empty();
  if (!all_asked) fmt::print(stderr, "{}\n", scan.why());
  if (all_asked && !found)
    fmt::print(stderr,
               "nothing answered on {}: {} reads, each waited for {} ms. Look at:\n"
               "  the drives    powered, and set to this protocol where they offer several\n"
               "  the cable     RS232: RX to TX, TX to RX, and ground; RS485: A to A, B to B, and ground\n"
               "  the rate      --baud; the station --stations; another character than 8N1 --parity\n"
               "  the device    a serial CAN adapter is given as slcan:{}\n",
               options.device, scan.plan().knocked(), options.timeout_ms, options.device);
  if (scan.late_replies() > 0)
    fmt::print(stderr, "{} answers came that nobody waited for any more: scan again with a longer --timeout-ms\n",
               scan.late_replies());
  tell_line(scan, found);
  return all_asked && found ? 0 : 1;
}

}  // namespace

int run_serial_scan(const ScanOptions& options) {
  boost::asio::io_context io(1);
  SerialScanner scan(options, profiles_in(options.profile_folders), io);
  if (scan.plan().knocks() == 0) {
    fmt::print(stderr,
               "axisgate scan: no drive profile knows what to read there in these protocols and at these stations: "
               "name the folder of the profiles with --profiles, or other --stations\n");
    return 1;
  }
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  signals.async_wait([&](const boost::system::error_code& error, int) {
    if (!error) scan.end("ended before all stations were asked");
  });
  scan.start();
  io.run();
  return tell_serial(options, scan);
}

}  // namespace axisgate::commands
