// SPDX-License-Identifier: Apache-2.0
#include "adapters/can/lawicel_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace axisgate::can {
namespace {

/// Empties what the adapter may have of an earlier command, closes the channel, and asks for something whose answer
/// cannot be one to anything before it.
constexpr std::string_view kClose = "\r\r\rC\rV\r";
constexpr std::string_view kOpen = "O\r";
constexpr std::string_view kStatus = "F\r";

/// 8 data bits, a start and a stop bit.
Duration time_on_line(std::size_t bytes, std::uint32_t baud) {
  return Duration(static_cast<std::int64_t>(bytes) * 10 * 1'000'000'000 / baud);
}

}  // namespace

LawicelSession::LawicelSession(CanDevice device, std::uint32_t bitrate)
    : device_(std::move(device)), bitrate_(bitrate) {}

void LawicelSession::on_port_up(Instant now) {
  plan_ = BusOffPlan{};
  status_offered_ = true;
  status_seen_ = false;
  begin(now);
}

void LawicelSession::on_port_down(std::string_view why) {
  step_ = Step::port_closed;
  step_due_ = kNever;
  up_ = false;
  why_ = why;
  queue_.clear();
  output_.clear();
}

void LawicelSession::begin(Instant now) {
  answers_ = false;
  refusals_ = 0;
  unanswered_ = 0;
  status_asked_at_ = kNever;
  enter(Step::closing, kClose, now);
}

void LawicelSession::enter(Step step, std::string_view command, Instant now) {
  step_ = step;
  step_due_ = now + kReplyWait;
  put(command, now);
}

void LawicelSession::on_line(const LawicelLine& line, Instant now) {
  if (step_ == Step::running) {
    on_line_while_running(line, now);
  } else if (step_ != Step::port_closed && step_ != Step::resting) {
    on_line_while_starting(line, now);
  }
  pump(now);
  judge(now);
}

void LawicelSession::on_line_while_starting(const LawicelLine& line, Instant now) {
  using Kind = LawicelLine::Kind;
  if (line.kind == Kind::version) version_ = line.text;
  const bool answered = line.kind == Kind::done || line.kind == Kind::refused;
  switch (step_) {
    case Step::closing:
      // A closed channel refuses to be closed: nothing but the version tells that all of that has been answered.
      if (line.kind == Kind::version) on_step_deadline(now);
      break;
    case Step::setting_rate:
      if (!answered) break;
      answers_ = true;
      if (line.kind == Kind::done) {
        on_step_deadline(now);
      } else {
        fail(fmt::format("the adapter refuses the bit rate {}", bitrate_), now);
      }
      break;
    case Step::opening:
      if (!answered) break;
      answers_ = true;
      if (line.kind == Kind::done) {
        run(now);
      } else {
        fail("the adapter refuses to open its CAN channel", now);
      }
      break;
    default:
      break;
  }
}

void LawicelSession::on_step_deadline(Instant now) {
  switch (step_) {
    case Step::closing:
      enter(Step::setting_rate, fmt::format("S{}\r", lawicel_rate(bitrate_).value_or('6')), now);
      break;
    case Step::setting_rate:
      enter(Step::opening, kOpen, now);
      break;
    case Step::opening:
      run(now);
      break;
    case Step::running:
      ask_status(now);
      break;
    case Step::resting:
      if (plan_.health(now) == BusOffPlan::Health::given_up) {
        step_due_ = now + kRetry;
      } else {
        begin(now);
      }
      break;
    case Step::port_closed:
      break;
  }
}

void LawicelSession::run(Instant now) {
  step_ = Step::running;
  step_due_ = status_offered_ ? now : kNever;
  plan_.on_restart();
}

void LawicelSession::fail(std::string_view why, Instant now) {
  step_ = Step::resting;
  step_due_ = now + kRetry;
  why_ = fmt::format("{}: {}", device_.path, why);
  up_ = false;
  queue_.clear();
}

void LawicelSession::on_line_while_running(const LawicelLine& line, Instant now) {
  using Kind = LawicelLine::Kind;
  switch (line.kind) {
    case Kind::frame:
      plan_.on_frame();
      refusals_ = 0;
      break;
    case Kind::done:
    case Kind::sent:
      refusals_ = 0;
      line_free_at_ = std::min(line_free_at_, now);
      break;
    case Kind::refused:
      line_free_at_ = std::min(line_free_at_, now);
      on_refusal(now);
      break;
    case Kind::status:
      on_status(line.flags, now);
      break;
    case Kind::version:
    case Kind::serial_number:
      break;
  }
}

void LawicelSession::on_refusal(Instant now) {
  if (status_asked_at_ != kNever && !status_seen_) {
    // An adapter without this command.
    status_offered_ = false;
    status_asked_at_ = kNever;
    step_due_ = kNever;
    return;
  }
  ++trouble_.no_ack;
  if (++refusals_ < kMaxRefusals) return;
  CanErrors errors;
  errors.bus_off = true;
  plan_.on_errors(errors, now, trouble_);
  const bool given_up = plan_.health(now) == BusOffPlan::Health::given_up;
  fail(given_up ? text(BusOffPlan::Health::given_up)
                : "the adapter refuses frames: bus-off, or nobody acknowledges (cable, power of the drives, bit rate)",
       now);
}

void LawicelSession::on_status(Byte flags, Instant now) {
  const auto has = [flags](Byte bit) { return (flags & bit) != 0; };
  status_seen_ = true;
  status_asked_at_ = kNever;
  unanswered_ = 0;
  CanErrors errors;
  errors.error_passive = has(lawicel_flag::kErrorPassive);
  errors.protocol_error = has(lawicel_flag::kBusError);
  // The status does not say which error; of an error passive sender it is the missing acknowledgement.
  errors.no_ack = errors.error_passive && errors.protocol_error;
  errors.error_warning = has(lawicel_flag::kErrorWarning) && !errors.error_passive;
  errors.receive_overflow = has(lawicel_flag::kDataOverrun) || has(lawicel_flag::kReceiveQueueFull);
  errors.transmit_overflow = has(lawicel_flag::kTransmitQueueFull);
  if (errors == CanErrors{}) {
    if (plan_.error_passive()) plan_.on_restart();
    return;
  }
  plan_.on_errors(errors, now, trouble_);
  if (errors.transmit_overflow) {
    ++trouble_.send_waits;
    plan_.on_queue_full();
  }
}

void LawicelSession::on_babble(Instant now) {
  if (step_ == Step::port_closed || step_ == Step::resting) return;
  fail("it sends what no Lawicel adapter sends: is it one, and is its serial rate right (slcan:PATH@BAUD)?", now);
}

void LawicelSession::ask_status(Instant now) {
  if (status_asked_at_ != kNever && ++unanswered_ >= kMaxUnanswered) {
    unanswered_ = 0;
    status_asked_at_ = kNever;
    if (status_seen_) {
      fail("the adapter answers no more", now);
    } else {
      status_offered_ = false;
      step_due_ = kNever;
    }
    return;
  }
  status_asked_at_ = now;
  step_due_ = now + kStatusPeriod;
  put(kStatus, now);
}

void LawicelSession::on_deadline(Instant now) {
  if (step_due_ <= now) on_step_deadline(now);
  if (queue_.overdue_at() <= now) {
    fail(fmt::format("the bus is overloaded: {} frames wait to be sent", queue_.size()), now);
  }
  pump(now);
  judge(now);
}

void LawicelSession::send(const CanFrame& frame, bool urgent, Instant now) {
  if (!up_) return;
  if (!queue_.push(frame, urgent, now)) {
    fail(fmt::format("the bus is overloaded: {} frames wait to be sent", queue_.size()), now);
    return;
  }
  pump(now);
}

void LawicelSession::put(std::string_view bytes, Instant now) {
  output_ += bytes;
  line_free_at_ = std::max(line_free_at_, now) + time_on_line(bytes.size(), device_.baud);
}

void LawicelSession::pump(Instant now) {
  while (step_ == Step::running && !queue_.empty() && line_free_at_ <= now) {
    put(lawicel_text(queue_.front()), now);
    queue_.pop();
  }
}

void LawicelSession::judge(Instant now) {
  if (step_ != Step::running) return;
  const BusOffPlan::Health health = plan_.health(now);
  const bool usable = health == BusOffPlan::Health::usable;
  if (up_ && !usable) {
    why_ = fmt::format("{}: {}", device_.path, text(health));
    queue_.clear();
  }
  up_ = usable;
}

Instant LawicelSession::due(Instant now) const {
  Instant next = std::min(step_due_, queue_.overdue_at());
  if (step_ == Step::running) {
    next = std::min(next, plan_.due(now));
    if (!queue_.empty()) next = std::min(next, line_free_at_);
  }
  return next;
}

std::string LawicelSession::take_output() { return std::exchange(output_, {}); }

}  // namespace axisgate::can
