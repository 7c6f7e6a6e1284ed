// SPDX-License-Identifier: Apache-2.0
#include "adapters/can/link/socketcan_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "adapters/serial/still_open.hpp"

namespace axisgate::can {
namespace {

using Error = boost::system::error_code;
using serial::StillOpen;

}  // namespace

SocketCanLink::SocketCanLink(std::string name, std::string interface, std::uint32_t bitrate,
                             boost::asio::io_context& context, Runtime& runtime, const Log& log)
    : log_source_(bus_source(std::move(name))),
      interface_(std::move(interface)),
      bitrate_(bitrate),
      context_(context),
      runtime_(runtime),
      log_(log),
      socket_(context),
      timer_(runtime.make_timer([this] { wake(); })) {}

SocketCanLink::~SocketCanLink() = default;

void SocketCanLink::start(CanLinkEvents& events, std::vector<CanFilter> filters) {
  assert(events_ == nullptr);
  events_ = &events;
  filters_ = FilterSet(std::move(filters));
  watch_ = std::make_unique<InterfaceWatch>(context_, interface_,
                                            [this](const InterfaceChange& change) { on_change(change); });
  reopen_.on_request(runtime_.now());
  arm();
}

void SocketCanLink::arm() {
  const Instant now = runtime_.now();
  Instant next = std::min({reopen_.due(), send_again_at_, clog_look_at_});
  if (socket_.is_open()) next = std::min(next, faults_.due(now));
  if (reported_up_) next = std::min(next, queue_.overdue_at());
  if (!broken_.empty() || (reported_up_ && !clogged_.empty())) next = now;
  timer_->expires_at(next);
}

void SocketCanLink::wake() {
  const std::weak_ptr alive(opening_);
  const Instant now = runtime_.now();
  if (!broken_.empty()) {
    lose(std::exchange(broken_, {}));
  } else if (!socket_.is_open()) {
    if (reopen_.due() <= now) try_open();
  } else {
    if (send_again_at_ <= now) pump();
    look_at_clog();
    judge();
  }
  if (!alive.expired()) arm();
}

void SocketCanLink::try_open() {
  const OpenedSocket opened = open_raw_socket(interface_, bitrate_, filters_);
  if (opened.descriptor < 0) {
    reopen_.on_failure(runtime_.now());
    failures_.tell(log_, log_source_, opened.error);
    return;
  }
  socket_.assign(opened.descriptor);
  reopen_.on_open();
  ++*opening_;
  // Taken down and up: whatever was wrong with the controller is forgotten.
  faults_ = BusOffPlan{};
  running_ = opened.running;
  if (!running_) faults_.on_found_stopped();
  dropped_ = 0;
  failures_.opened();
  log_.write(LogLevel::info, log_source_, interface_ + (running_ ? " open" : " open, but its controller is bus-off"));
  wait_for_frames();
  judge();
}

void SocketCanLink::wait_for_frames() {
  socket_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                     [this, still_open = StillOpen(opening_)](const Error& error) {
                       if (still_open && !error) read();
                     });
}

void SocketCanLink::read() {
  const StillOpen still_open(opening_);
  for (std::size_t frames = 0; frames < kMaxFramesPerTurn; ++frames) {
    const Received received = receive(socket_.native_handle());
    if (received.kind == Received::Kind::nothing) break;
    if (received.kind == Received::Kind::failed) {
      lose(interface_trouble(interface_, bitrate_, received.error));
      return;
    }
    take(received);
    if (!still_open) return;
  }
  arm();
  wait_for_frames();
}

void SocketCanLink::take(const Received& received) {
  const Instant now = runtime_.now();
  if (received.dropped > dropped_) {
    trouble_.lost_in += received.dropped - dropped_;
    dropped_ = received.dropped;
  }
  if (received.kind == Received::Kind::errors) {
    log_.write(LogLevel::debug, log_source_, interface_ + ": " + text(received.errors));
    faults_.on_errors(received.errors, now, trouble_);
    judge();
  } else if (received.kind == Received::Kind::frame) {
    const StillOpen still_open(opening_);
    faults_.on_frame();
    if (!reported_up_) judge();
    if (still_open && reported_up_ && filters_.passes(received.frame)) {
      events_->on_frame(received.frame, now - received.age);
    }
  }
}

void SocketCanLink::send(const CanFrame& frame, bool urgent) {
  if (!reported_up_ || !broken_.empty() || !clogged_.empty()) return;
  if (!queue_.push(frame, urgent, runtime_.now())) {
    clogged_ = fmt::format("{}: nobody acknowledges or the bus is overloaded: {} frames wait to be sent", interface_,
                           queue_.size());
    clog_look_at_ = runtime_.now() + kClogRetry;
  } else if (send_again_at_ == kNever) {
    pump();
  }
  arm();
}

void SocketCanLink::pump() {
  const bool was_full = send_again_at_ != kNever;
  send_again_at_ = kNever;
  while (!queue_.empty()) {
    int error = 0;
    const Transmission outcome = transmit(socket_.native_handle(), queue_.front(), error);
    if (outcome == Transmission::failed) {
      broken_ = interface_trouble(interface_, bitrate_, error);
      return;
    }
    if (outcome == Transmission::queue_full) {
      if (!was_full) ++trouble_.send_waits;
      faults_.on_queue_full();
      send_again_at_ = runtime_.now() + kSendRetry;
      return;
    }
    queue_.pop();
  }
}

void SocketCanLink::look_at_clog() {
  const Instant now = runtime_.now();
  if (clogged_.empty() && queue_.overdue_at() <= now) {
    clogged_ = fmt::format("{}: nobody acknowledges or the bus is overloaded: a frame has waited for {} ms", interface_,
                           elapsed_ms(Instant{}, Instant{} + kMaxSendWait));
    clog_look_at_ = now + kClogRetry;
  } else if (clog_look_at_ <= now) {
    const bool free = takes_frames(socket_.native_handle());
    clog_look_at_ = free ? kNever : now + kClogRetry;
    if (free) clogged_.clear();
  }
}

std::string SocketCanLink::trouble_now() const {
  const BusOffPlan::Health health = faults_.health(runtime_.now());
  if (health != BusOffPlan::Health::usable) return fmt::format("{}: {}", interface_, text(health));
  return clogged_;
}

void SocketCanLink::judge() {
  if (!socket_.is_open()) return;
  const std::string trouble = trouble_now();
  if (trouble.empty() == reported_up_) return;
  reported_up_ = trouble.empty();
  if (!reported_up_) {
    queue_.clear();
    send_again_at_ = kNever;
    arm();
    events_->on_link_down(trouble);
    return;
  }
  if (std::exchange(ever_up_, true)) ++trouble_.reconnects;
  arm();
  events_->on_link_up();
}

void SocketCanLink::on_change(const InterfaceChange& change) {
  if (!socket_.is_open()) {
    if (!change.known || change.up) reopen_.on_path(runtime_.now());
  } else if (change.known && change.up) {
    // A driver takes its interface's carrier away at bus-off and gives it back at the restart.
    if (change.running && !running_) faults_.on_restart();
    running_ = change.running;
    const std::weak_ptr alive(opening_);
    judge();
    if (alive.expired()) return;
  }
  arm();
}

void SocketCanLink::lose(const std::string& why) {
  close();
  reopen_.on_loss(runtime_.now());
  arm();
  if (std::exchange(reported_up_, false)) {
    failures_.was_reported(why);
    events_->on_link_down(why);
  } else {
    failures_.tell(log_, log_source_, why);
  }
}

void SocketCanLink::close() {
  ++*opening_;
  Error ignored;  // the descriptor is gone either way
  socket_.close(ignored);
  queue_.clear();
  send_again_at_ = kNever;
  clog_look_at_ = kNever;
  clogged_.clear();
  broken_.clear();
}

}  // namespace axisgate::can
