// SPDX-License-Identifier: Apache-2.0
#include "adapters/bus/line_watch.hpp"

#include <string>
#include <utility>

namespace axisgate::bus {

LineWatch::LineWatch(Runtime& runtime, Line line)
    : runtime_(runtime), line_(std::move(line)), timer_(runtime.make_timer([this] { look_again(); })) {}

void LineWatch::on_link_up() {
  link_up_ = true;
  noise_.clear();
  if (!given_up_) report(true, "");
}

void LineWatch::on_link_down(std::string_view why) {
  link_up_ = false;
  report(false, why);
}

void LineWatch::on_answer() {
  noise_.clear();
  reopens_ = 0;
}

void LineWatch::on_noise() {
  const Instant now = runtime_.now();
  noise_.on_noise(now);
  if (!given_up_ && noise_.babbles(now)) on_babble();
}

void LineWatch::on_babble() {
  static constexpr std::string_view kWhy =
      "noise without a pause: wrong baud rate, another protocol, or a fault on the line";
  noise_.clear();
  if (reopens_ < kReopensInARow) {
    ++reopens_;
    line_.reopen(kWhy);
    return;
  }
  given_up_ = true;
  timer_->expires_at(runtime_.now() + kSecondLook);
  line_.drop();
  std::string why(kWhy);
  why.append("; opened anew ").append(std::to_string(kReopensInARow)).append(" times, waiting for silence");
  report(false, why);
}

/// Of a line that was given up: still noisy, then it is opened anew; quiet, then it is taken back.
void LineWatch::look_again() {
  if (!given_up_) return;
  if (link_up_ && !noisy()) {
    given_up_ = false;
    reopens_ = 0;
    report(true, "");
    return;
  }
  timer_->expires_at(runtime_.now() + kSecondLook);
  if (link_up_) line_.reopen("the line is still noisy");
}

void LineWatch::report(bool up, std::string_view why) {
  if (up == std::exchange(reported_up_, up)) return;
  if (!up) {
    events_->on_wire_down(why);
    return;
  }
  if (std::exchange(ever_up_, true)) ++reconnects_;
  events_->on_wire_up();
}

}  // namespace axisgate::bus
