// SPDX-License-Identifier: Apache-2.0
#include "adapters/can/link/slcan_link.hpp"

#include <fmt/format.h>

#include <cassert>
#include <utility>

namespace axisgate::can {

SlcanLink::SlcanLink(std::string name, CanDevice device, std::uint32_t bitrate, std::unique_ptr<bus::ByteLink> port,
                     Runtime& runtime, const Log& log)
    : log_source_(bus_source(std::move(name))),
      path_(device.path),
      runtime_(runtime),
      log_(log),
      session_(std::move(device), bitrate),
      timer_(runtime.make_timer([this] { wake(); })),
      port_(std::move(port)) {}

SlcanLink::~SlcanLink() = default;

void SlcanLink::start(CanLinkEvents& events, std::vector<CanFilter> filters) {
  assert(events_ == nullptr);
  events_ = &events;
  filters_ = FilterSet(std::move(filters));
  port_->start(*this);
}

void SlcanLink::send(const CanFrame& frame, bool urgent) {
  session_.send(frame, urgent, runtime_.now());
  obey();
}

void SlcanLink::on_link_up() {
  decoder_.clear();
  noise_.clear();
  backlog_.clear();
  session_.on_port_up(runtime_.now());
  obey();
}

void SlcanLink::on_link_down(std::string_view why) {
  backlog_.clear();
  session_.on_port_down(why);
  obey();
  report();
}

void SlcanLink::on_bytes(Bytes bytes) {
  if (backlog_.size() + bytes.size() > kMaxBacklog) {
    ++session_.trouble().lost_in;
    backlog_.clear();
    decoder_.clear();
  }
  backlog_.insert(backlog_.end(), bytes.begin(), bytes.end());
  take_lines();
}

void SlcanLink::take_lines() {
  const std::weak_ptr alive(alive_);
  const std::uint32_t bad_before = decoder_.bad_bytes();
  std::size_t frames = 0;
  std::size_t taken = 0;
  while (taken < backlog_.size() && frames < kMaxFramesPerTurn) {
    const auto line = decoder_.push(backlog_[taken++]);
    if (!line) continue;
    if (line->kind == LawicelLine::Kind::frame) ++frames;
    take(*line);
    if (alive.expired()) return;
    if (backlog_.empty()) taken = 0;  // the port was lost meanwhile
  }
  backlog_.erase(backlog_.begin(), backlog_.begin() + static_cast<std::ptrdiff_t>(taken));
  session_.trouble().bad_bytes = decoder_.bad_bytes();
  const Instant now = runtime_.now();
  if (decoder_.bad_bytes() != bad_before) noise_.on_noise(now);
  if (noise_.babbles(now)) {
    noise_.clear();
    session_.on_babble(now);
  }
  obey();
  report();
}

void SlcanLink::take(const LawicelLine& line) {
  using Kind = LawicelLine::Kind;
  // CR and BEL are in any noise.
  if (line.kind != Kind::done && line.kind != Kind::refused) noise_.clear();
  const Instant now = runtime_.now();
  session_.on_line(line, now);
  const std::weak_ptr alive(alive_);
  obey();
  report();
  if (alive.expired() || line.kind != Kind::frame || !reported_up_ || !filters_.passes(line.frame)) return;
  events_->on_frame(line.frame, now);
}

void SlcanLink::wake() {
  session_.on_deadline(runtime_.now());
  obey();
  const std::weak_ptr alive(alive_);
  report();
  if (!alive.expired() && !backlog_.empty()) take_lines();
}

void SlcanLink::obey() {
  const std::string output = session_.take_output();
  if (!output.empty()) port_->send(Bytes(reinterpret_cast<const Byte*>(output.data()), output.size()));
  const Instant now = runtime_.now();
  const bool something_waits = !backlog_.empty() || session_.up() != reported_up_;
  timer_->expires_at(something_waits ? now : session_.due(now));
}

void SlcanLink::report() {
  if (session_.up() == reported_up_) {
    if (!reported_up_ && !session_.why().empty()) failures_.tell(log_, log_source_, session_.why());
    return;
  }
  reported_up_ = session_.up();
  if (!reported_up_) {
    failures_.was_reported(session_.why());
    events_->on_link_down(session_.why());
    return;
  }
  if (std::exchange(ever_up_, true)) ++session_.trouble().reconnects;
  failures_.opened();
  const std::string adapter = session_.version().empty() ? "of unknown version" : "V" + session_.version();
  log_.write(LogLevel::info, log_source_,
             fmt::format("{}: Lawicel adapter {}, channel open{}", path_, adapter,
                         session_.answers() ? "" : "; it acknowledges nothing, so errors on the bus are not told"));
  events_->on_link_up();
}

}  // namespace axisgate::can
