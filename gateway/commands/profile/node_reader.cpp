// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/profile/node_reader.hpp"

#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <charconv>
#include <csignal>
#include <memory>
#include <optional>

#include "adapters/asio/asio_runtime.hpp"
#include "adapters/bus/bus.hpp"
#include "adapters/can/can_device.hpp"
#include "adapters/can/link/make_can_link.hpp"
#include "adapters/canopen/canopen_wire.hpp"

namespace axisgate::commands {
namespace {

/// A bus that cannot be spoken on by then is not waited for.
constexpr Duration kUpLimit = std::chrono::seconds(3);
constexpr Duration kReplyLimit = std::chrono::milliseconds(300);
constexpr std::uint8_t kLastNode = 127;

std::optional<std::uint8_t> node_of(std::string_view digits) {
  std::uint8_t node = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), node);
  const bool whole = error == std::errc() && end == digits.data() + digits.size();
  return whole && node >= 1 && node <= kLastNode ? std::optional(node) : std::nullopt;
}

/// The node is the bus's only drive.
class Reader final : public bus::BusDrive {
 public:
  Reader(const NodePlace& place, std::uint32_t bitrate, std::vector<ObjectAddress> addresses,
         boost::asio::io_context& io)
      : place_(place),
        addresses_(std::move(addresses)),
        io_(io),
        runtime_(io),
        log_([this](LogLevel, std::string_view, std::string_view message) { complaint_ = message; }, LogLevel::info,
             [this](const OpeningFailure& failure) { end(failure.why); }),
        up_limit_(runtime_.make_timer([this] { end(complaint_); })),
        complaint_(place.device + ": cannot be spoken on"),
        bus_({.name = "profile", .timeout = kReplyLimit}, 1, make_wire(bitrate), runtime_, log_) {
    bus_.attach(0, *this);
  }

  void start() {
    if (addresses_.empty()) return end({});
    up_limit_->expires_at(runtime_.now() + kUpLimit);
    bus_.start();
  }

  /// The first reason counts.
  void end(std::string_view why) {
    if (std::exchange(ended_, true)) return;
    reading.why = why;
    io_.stop();
  }

  std::optional<bus::Exchange> on_grant(const bus::Arbiter::Grant&) override {
    if (ended_ || reading.answers.size() >= addresses_.size()) return std::nullopt;
    bus::Exchange out;
    out.node = place_.node;
    out.object = addresses_[reading.answers.size()];
    return out;
  }
  void on_result(const bus::Exchange&, const bus::ExchangeResult& result) override {
    if (ended_ || !bus_.up()) return;
    const bool read = result.code == Errc::ok && !result.fields.empty();
    if (!read && result.code != Errc::refused_by_drive)
      return end(fmt::format("node {} on {} did not answer", place_.node, place_.device));
    const auto raw = read ? std::optional(result.fields.front().raw) : std::nullopt;
    reading.answers.push_back({addresses_[reading.answers.size()], raw});
    if (reading.answers.size() == addresses_.size()) return end({});
    bus_.set_poll_due(0, runtime_.now());
  }
  void on_job_ended(const bus::Arbiter::Ending&) override {}  // it submits no bus jobs, it polls
  void on_link(bool up) override {
    if (!up) return end(complaint_);
    up_limit_->expires_at(kNever);
    bus_.set_poll_due(0, runtime_.now());
  }
  [[nodiscard]] std::uint8_t node() const override { return place_.node; }
  void on_unsolicited(const bus::UnsolicitedEvent&) override {}

  NodeReading reading;

 private:
  std::unique_ptr<bus::Wire> make_wire(std::uint32_t bitrate) {
    canopen::CanopenSettings settings;  // no heartbeat, no SYNC, no guarding: it is only seen by its reads
    settings.name = "profile";
    settings.timeout = kReplyLimit;
    settings.nodes.emplace_back();
    settings.nodes.back().node = place_.node;
    auto link = can::make_can_link(place_.device, bitrate, settings.name, io_, runtime_, log_);
    return canopen::make_canopen_wire(std::move(settings), std::move(link), runtime_, log_);
  }

  NodePlace place_;
  std::vector<ObjectAddress> addresses_;
  boost::asio::io_context& io_;
  AsioRuntime runtime_;
  Log log_;
  std::unique_ptr<Timer> up_limit_;
  std::string complaint_;  ///< the link's last
  bool ended_ = false;
  bus::Bus bus_;  // last, so that it goes first: it calls and logs
};

}  // namespace

std::string node_place_mistake(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const bool whole = colon != std::string::npos && colon > 0 && node_of(std::string_view(text).substr(colon + 1));
  return whole ? "" : "'" + text + "' is no DEVICE:N: a CAN interface and a node-ID of 1 to 127, such as can0:5";
}

NodePlace node_place(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  return {text.substr(0, colon), node_of(std::string_view(text).substr(colon + 1)).value_or(1)};
}

NodeReading read_node(const NodePlace& place, std::uint32_t bitrate, std::vector<ObjectAddress> addresses) {
  if (const std::string mistake = can::can_device_mistake(place.device, bitrate); !mistake.empty())
    return {{}, mistake};
  boost::asio::io_context io(1);
  Reader reader(place, bitrate, std::move(addresses), io);
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  signals.async_wait([&](const boost::system::error_code& error, int) {
    if (!error) reader.end("ended before all was read");
  });
  reader.start();
  io.run();
  return std::move(reader.reading);
}

}  // namespace axisgate::commands
