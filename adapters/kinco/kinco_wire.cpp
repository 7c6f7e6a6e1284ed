#include "adapters/kinco/kinco_wire.hpp"

#include <fmt/format.h>

#include <cassert>
#include <utility>

#include "adapters/kinco/kinco_text.hpp"

namespace axisgate::kinco {

KincoWire::KincoWire(std::string name, std::unique_ptr<bus::ByteLink> link, Runtime& runtime, const Log& log)
    : log_source_("bus " + std::move(name)),
      runtime_(runtime),
      log_(log),
      timer_(runtime.make_timer([this] { look_again(); })),
      link_(std::move(link)) {
  assert(link_ != nullptr);
}

KincoWire::~KincoWire() = default;

void KincoWire::start(bus::WireEvents& events) {
  events_ = &events;
  link_->start(*this);
}

void KincoWire::send(const bus::Exchange& exchange) {
  assert(reported_up_);
  const Frame request = request_of(exchange);
  const FrameBytes bytes = encode(request);
  receiver_.await(exchange);
  log_frame("->", bytes, request, "");
  link_->send(bytes);
}

void KincoWire::abandon() { receiver_.give_up(); }

const bus::Statistics& KincoWire::statistics() const {
  statistics_.bad_frames = receiver_.bad_frames();
  statistics_.late_replies = receiver_.late_replies();
  statistics_.dropped_bytes = receiver_.dropped_bytes();
  statistics_.reconnects = reconnects_;
  return statistics_;
}

void KincoWire::on_link_up() {
  link_up_ = true;
  receiver_.reset();
  noise_.clear();
  if (!given_up_) report(true, "");
}

void KincoWire::on_link_down(std::string_view why) {
  link_up_ = false;
  receiver_.reset();
  report(false, why);
}

void KincoWire::on_bytes(Bytes bytes) {
  const std::uint32_t dropped_before = receiver_.dropped_bytes();
  std::optional<Frame> answer;
  for (const Byte byte : bytes) {
    switch (receiver_.take(byte)) {
      case Receiver::Heard::nothing:
        break;
      case Receiver::Heard::answer:
        answer = receiver_.frame();
        log_frame("<-", receiver_.frame_bytes(), *answer, "");
        break;
      case Receiver::Heard::late:
        log_frame("<-", receiver_.frame_bytes(), receiver_.frame(), "  (late)");
        break;
      case Receiver::Heard::echo:
        log_frame("<-", receiver_.frame_bytes(), receiver_.frame(), "  (echo)");
        break;
    }
  }
  const std::uint32_t dropped = receiver_.dropped_bytes() - dropped_before;
  if (decode_ && dropped > 0) log_.write(LogLevel::info, log_source_, fmt::format("<- skipped {} bytes", dropped));
  if (answer) {
    noise_.clear();
    reopens_ = 0;
    // Last: the bus may send its next request from inside this call.
    if (reported_up_) events_->on_reply(result_of(*answer));
  } else if (dropped > 0) {
    noise_.on_noise(runtime_.now());
    if (!given_up_ && noise_.babbles(runtime_.now())) on_babble();
  }
}

void KincoWire::on_babble() {
  static constexpr std::string_view kWhy =
      "noise without a pause: wrong baud rate, another protocol, or a fault on the line";
  noise_.clear();
  if (reopens_ < kReopensInARow) {
    ++reopens_;
    link_->reopen(kWhy);
    return;
  }
  given_up_ = true;
  timer_->expires_at(runtime_.now() + kSecondLook);
  receiver_.give_up();
  report(false, fmt::format("{}; opened anew {} times, waiting for silence", kWhy, kReopensInARow));
}

/// Of a line that was given up: still noisy, then it is opened anew; quiet, then it is taken back.
void KincoWire::look_again() {
  if (!given_up_) return;
  if (link_up_ && !noise_.heard_lately(runtime_.now())) {
    given_up_ = false;
    reopens_ = 0;
    report(true, "");
    return;
  }
  timer_->expires_at(runtime_.now() + kSecondLook);
  if (link_up_) link_->reopen("the line is still noisy");
}

void KincoWire::report(bool up, std::string_view why) {
  if (up == std::exchange(reported_up_, up)) return;
  if (!up) {
    events_->on_wire_down(why);
    return;
  }
  if (std::exchange(ever_up_, true)) ++reconnects_;
  events_->on_wire_up();
}

void KincoWire::log_frame(std::string_view direction, Bytes bytes, const Frame& frame, std::string_view remark) const {
  if (!decode_) return;
  log_.write(LogLevel::info, log_source_,
             fmt::format("{} {}  {}{}", direction, hex_text(bytes), describe(frame), remark));
}

}  // namespace axisgate::kinco
