// SPDX-License-Identifier: Apache-2.0
#include "adapters/modbus_rtu/link/libmodbus_link.hpp"

#include <fmt/format.h>

#include <boost/asio/post.hpp>
#include <cassert>
#include <utility>

namespace axisgate::modbus_rtu {

namespace {

char parity_letter(serial::Parity parity) {
  return parity == serial::Parity::none ? 'N' : parity == serial::Parity::even ? 'E' : 'O';
}

}  // namespace

LibmodbusLink::LibmodbusLink(std::string name, serial::SerialSettings settings, boost::asio::io_context& context,
                             Runtime& runtime, const Log& log, Duration adapter_latency)
    : log_source_(bus_source(std::move(name))),
      settings_(std::move(settings)),
      adapter_latency_(adapter_latency),
      context_(context),
      runtime_(runtime),
      log_(log),
      timer_(runtime.make_timer([this] { try_open(); })) {}

LibmodbusLink::~LibmodbusLink() = default;

void LibmodbusLink::start(RtuLinkEvents& events) {
  assert(events_ == nullptr);
  events_ = &events;
  worker_ = std::make_unique<PortWorker>(settings_, adapter_latency_, context_, static_cast<PortWorkerEvents&>(*this));
  path_watch_ = std::make_unique<serial::PathWatch>(context_, settings_.device, [this] { on_path(); });
  plan_.on_request(runtime_.now());
  arm();
}

void LibmodbusLink::arm() { timer_->expires_at(plan_.due()); }

void LibmodbusLink::on_path() {
  if (state_ == State::opening) {
    path_appeared_ = true;
    return;
  }
  plan_.on_path(runtime_.now());
  arm();
}

void LibmodbusLink::try_open() {
  if (state_ != State::closed) return;
  path_watch_->renew();  // before the try: what appears after it is then told
  path_appeared_ = false;
  state_ = State::opening;
  worker_->open(++opening_);
}

void LibmodbusLink::on_opened(OpeningNumber opening, const std::vector<std::string>& notes) {
  if (opening != opening_) return;
  state_ = State::open;
  plan_.on_open();
  arm();
  failures_.opened();
  log_.write(LogLevel::info, log_source_,
             fmt::format("{} open, {} baud 8{}1", settings_.device, settings_.baud, parity_letter(settings_.parity)));
  if (notes != last_notes_) {
    for (const std::string& note : notes) {
      log_.write(LogLevel::warning, log_source_, settings_.device + ": " + note);
    }
    last_notes_ = notes;
  }
  events_->on_link_up();
}

void LibmodbusLink::on_not_opened(OpeningNumber opening, const std::string& why) {
  if (opening != opening_) return;
  state_ = State::closed;
  plan_.on_failure(runtime_.now());
  if (path_appeared_) plan_.on_path(runtime_.now());
  arm();
  failures_.tell(log_, log_source_, why);
}

void LibmodbusLink::on_lost(OpeningNumber opening, const std::string& why) {
  if (opening != opening_ || state_ != State::open) return;
  plan_.on_loss(runtime_.now());
  closed(why);
}

void LibmodbusLink::closed(const std::string& why) {
  state_ = State::closed;
  arm();
  events_->on_link_down(why);
}

void LibmodbusLink::on_heard(OpeningNumber opening, ExchangeNumber newest, Bytes frame) {
  if (opening == opening_ && state_ == State::open) events_->on_frame(newest, frame);
}

void LibmodbusLink::on_noise(OpeningNumber opening, ExchangeNumber newest, std::size_t bytes) {
  if (opening == opening_ && state_ == State::open) events_->on_bad_frame(newest, bytes);
}

void LibmodbusLink::on_glitch(OpeningNumber opening, std::size_t bytes) {
  if (opening == opening_ && state_ == State::open) events_->on_glitch(bytes);
}

void LibmodbusLink::transmit(ExchangeNumber number, Bytes frame) {
  if (state_ != State::open || worker_->send(number, frame)) return;
  log_.write(LogLevel::warning, log_source_,
             settings_.device + ": a frame could not leave before the next one and was dropped: the line was not free");
}

void LibmodbusLink::withdraw(ExchangeNumber number) {
  if (state_ == State::open) worker_->withdraw(number);
}

void LibmodbusLink::reopen(std::string_view why) {
  if (state_ == State::closed) {
    plan_.on_request(runtime_.now());
    arm();
  }
  if (state_ != State::open) return;
  state_ = State::closing;
  worker_->close();
  boost::asio::post(context_,
                    [this, alive = std::weak_ptr(alive_), text = fmt::format("{}: {}", settings_.device, why)] {
                      if (alive.expired()) return;
                      plan_.on_request(runtime_.now());
                      closed(text);
                    });
}

}  // namespace axisgate::modbus_rtu
