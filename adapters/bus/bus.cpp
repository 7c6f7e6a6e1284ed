// SPDX-License-Identifier: Apache-2.0
#include "adapters/bus/bus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace axisgate::bus {

Bus::Bus(BusSettings settings, std::size_t drives, std::unique_ptr<Wire> wire, Runtime& runtime, const Log& log)
    : settings_(std::move(settings)),
      arbiter_(drives),
      runtime_(runtime),
      log_(log),
      drives_(drives, nullptr),
      noisy_timeouts_(drives, 0),
      bits_(settings_.bit_rate),
      timer_(runtime.make_timer([this] { pump(); })),
      wire_(std::move(wire)) {
  assert(wire_ != nullptr);
}

Bus::~Bus() = default;

void Bus::attach(DriveSlot slot, BusDrive& drive) {
  assert(slot < drives_.size() && drives_[slot] == nullptr);
  drives_[slot] = &drive;
}

void Bus::start() {
  assert(std::ranges::count(drives_, nullptr) == 0);
  wire_->start(*this);
}

Arbiter::Submission Bus::submit(const BusJob& job) {
  if (!up_) return {Errc::offline, 0, false};
  const Arbiter::Submission submission = arbiter_.submit(job, now());
  soon();
  return submission;
}

void Bus::wait(JobId id, Instant until) {
  arbiter_.wait(id, until);
  soon();
}

bool Bus::go_on_as(JobId id, const BusJob& rest) {
  const bool there_is_room = arbiter_.go_on_as(id, rest);
  soon();
  return there_is_room;
}

void Bus::finish(JobId id) {
  arbiter_.finish(id);
  soon();
}

void Bus::set_poll_due(DriveSlot drive, Instant due) {
  arbiter_.set_poll_due(drive, due);
  soon();
}

void Bus::end_drive(DriveSlot drive, Errc waiting, Errc started) {
  arbiter_.end_drive(drive, waiting, started);
  soon();
}

/// A drive that calls us is never called back from inside its call.
void Bus::soon() {
  if (!pumping_) turn_at(now());
}

void Bus::turn_at(Instant due) {
  turn_due_ = due;
  timer_->expires_at(due);
}

void Bus::pump() {
  if (pumping_) return;
  pumping_ = true;
  int turns = 0;
  bool more = true;
  while (more) more = take_wire_event() || (turns++ < kMaxTurnsPerPump && (take_unsolicited() || take_turn()));
  pumping_ = false;
  if (turns > kMaxTurnsPerPump) {
    turn_at(now());
    return;
  }
  // While the link is down no exchange can go out: what waits for the wire then waits for on_wire_up().
  const Instant arbiter_deadline = up_ ? arbiter_.next_deadline() : kNever;
  turn_at(outstanding_ ? std::min(outstanding_->deadline, arbiter_deadline) : arbiter_deadline);
}

bool Bus::take_wire_event() {
  if (heard_reply_) {
    const ExchangeResult result = *std::exchange(heard_reply_, std::nullopt);
    if (outstanding_) {
      ++statistics_.replies;
      const ExchangeResult useless{.code = Errc::bad_reply};
      if (outstanding_->part.answered(result))
        outstanding_->deadline = outstanding_->goes_on_at = now() + settings_.min_gap;
      else
        end_exchange(outstanding_->part.is_useless(result) ? useless : result, settings_.min_gap);
    }
    return true;
  }
  if (heard_down_) {
    link_down(*std::exchange(heard_down_, std::nullopt));
    return true;
  }
  if (heard_up_) {
    heard_up_ = false;
    if (up_) return true;
    up_ = true;
    log_.write(LogLevel::info, log_source(), "link up");
    for (BusDrive* drive : drives_) drive->on_link(true);
    return true;
  }
  return false;
}

/// A drive that has started anew, or is gone, will answer nothing any more: its exchange ends now, not at its timeout.
bool Bus::take_unsolicited() {
  if (heard_unsolicited_.empty()) return false;
  bits_.count(wire_->bits_carried(), now());
  const UnsolicitedEvent unsolicited = heard_unsolicited_.front();
  heard_unsolicited_.pop_front();
  if (!up_) return true;
  const auto named = std::ranges::find_if(drives_, [&](const BusDrive* drive) {
    return drive != nullptr && drive->node() != 0 && drive->node() == unsolicited.node;
  });
  if (named == drives_.end()) return true;
  const bool ends =
      unsolicited.kind == UnsolicitedEvent::Kind::started || unsolicited.kind == UnsolicitedEvent::Kind::gone;
  if (ends && outstanding_ && drives_[outstanding_->drive] == *named) {
    if (outstanding_->goes_on_at == kNever) wire_->abandon();
    end_exchange({.code = Errc::link_lost}, settings_.min_gap);
  }
  (*named)->on_unsolicited(unsolicited);
  return true;
}

/// One callback to one drive, if there is reason for one.
bool Bus::take_turn() {
  if (outstanding_ && now() >= outstanding_->goes_on_at) {
    outstanding_->goes_on_at = kNever;
    send(outstanding_->part.on_wire());
    return true;
  }
  if (outstanding_ && now() >= outstanding_->deadline) {
    look_for_noise();
    ++statistics_.timeouts;
    wire_->abandon();
    end_exchange({.code = Errc::timed_out}, std::max(settings_.min_gap, settings_.settle));
    return true;
  }
  if (const auto ending = arbiter_.take_ending(now())) {
    drives_[ending->drive]->on_job_ended(*ending);
    return true;
  }
  if (!up_) return false;
  const auto granted = arbiter_.next(now());
  if (granted) grant(*granted);
  return granted.has_value();
}

void Bus::grant(const Arbiter::Grant& grant) {
  const std::optional<Exchange> exchange = drives_[grant.drive]->on_grant(grant);
  if (!exchange) {
    arbiter_.decline();
    return;
  }
  outstanding_ = {.exchange = *exchange, .drive = grant.drive, .priority = grant.priority, .sent = now()};
  load_.set_busy(true, now());
  send(outstanding_->part.begin(*exchange));
}

void Bus::send(const Exchange& exchange) {
  ++statistics_.requests;
  outstanding_->deadline = now() + settings_.timeout;
  outstanding_->bad_frames = wire_->statistics().bad_frames;
  bits_.count(wire_->bits_carried(), now());
  wire_->send(exchange);
}

void Bus::end_exchange(const ExchangeResult& result, Duration silence) {
  Outstanding ended = *std::exchange(outstanding_, std::nullopt);
  // No more than the read before it was sent, and nothing written.
  if (ended.part.reads()) ended.exchange = ended.part.on_wire();
  if (result.code == Errc::ok) noisy_timeouts_[ended.drive] = 0;
  const Instant over = now();
  if (result.code != Errc::link_lost) statistics_.times.add(ended.priority, over - ended.sent);
  load_.set_busy(false, over);
  arbiter_.exchange_over(over + silence, result.code == Errc::timed_out);
  drives_[ended.drive]->on_result(ended.exchange, result);
}

/// Where replies meet on a serial line, what comes is noise, and only in place of that number's answer.
void Bus::look_for_noise() {
  int& in_a_row = noisy_timeouts_[outstanding_->drive];
  if (wire_->statistics().bad_frames == outstanding_->bad_frames) {
    in_a_row = 0;
  } else if (++in_a_row == kNoisyTimeoutsReported) {
    log_.write(LogLevel::warning, log_source(),
               fmt::format("node {}: noise came in place of its answer {} times in a row: are there two drives with "
                           "this number? Else cable, termination, baud and parity",
                           outstanding_->exchange.node, kNoisyTimeoutsReported));
  }
}

/// All in one turn: clients get their answers now, not after a timeout each.
void Bus::link_down(const std::string& why) {
  if (!up_) return;
  up_ = false;  // from here on nothing new is accepted, so what follows is bounded
  heard_unsolicited_.clear();
  log_.write(LogLevel::warning, log_source(), "link down: " + why);
  if (outstanding_) end_exchange({.code = Errc::link_lost}, Duration{});
  arbiter_.end_all(Errc::offline, Errc::link_lost);
  while (const auto ending = arbiter_.take_ending(now())) {
    drives_[ending->drive]->on_job_ended(*ending);
  }
  for (BusDrive* drive : drives_) drive->on_link(false);
}

void Bus::on_wire_up() {
  heard_up_ = true;
  pump();
}

void Bus::on_wire_down(std::string_view why) {
  if (std::exchange(heard_up_, false) && !up_) return;  // came and went before anybody was told
  heard_down_ = std::string(why);
  pump();
}

void Bus::on_reply(const ExchangeResult& result) {
  heard_reply_ = result;
  pump();
}

void Bus::on_unsolicited(const UnsolicitedEvent& unsolicited) {
  if (heard_unsolicited_.size() >= kMaxUnsolicited) {
    const auto values = std::ranges::find(heard_unsolicited_, UnsolicitedEvent::Kind::values, &UnsolicitedEvent::kind);
    heard_unsolicited_.erase(values == heard_unsolicited_.end() ? heard_unsolicited_.begin() : values);
  }
  heard_unsolicited_.push_back(unsolicited);
  pump();
}

Statistics Bus::statistics() const { return statistics_ + arbiter_.statistics() + wire_->statistics(); }

std::size_t Bus::queue_depth() const { return arbiter_.waiting(); }

std::uint16_t Bus::load_permille() const {
  const auto carried = settings_.bit_rate == 0 ? std::nullopt : wire_->bits_carried();
  return carried ? bits_.permille(*carried, now()) : load_.permille(now());
}

Bus::Times Bus::times() const {
  Times out{statistics_.times, arbiter_.waits(), statistics_.times.sum()};
  const auto carried = settings_.bit_rate == 0 ? std::nullopt : wire_->bits_carried();
  if (!carried) return out;
  const std::uint64_t seconds = *carried / settings_.bit_rate, rest = *carried % settings_.bit_rate;
  const Duration part = Duration(std::chrono::seconds(1)) * static_cast<std::int64_t>(rest) / settings_.bit_rate;
  out.busy = std::chrono::seconds(seconds) + part;
  return out;
}

void Bus::set_decode(bool on) { wire_->set_decode(on); }

}  // namespace axisgate::bus
