// SPDX-License-Identifier: Apache-2.0
#include "adapters/kinco/kinco_wire.hpp"

#include <fmt/format.h>

#include <cassert>
#include <utility>

#include "adapters/kinco/kinco_text.hpp"

namespace axisgate::kinco {

KincoWire::KincoWire(std::string name, std::unique_ptr<bus::ByteLink> link, Runtime& runtime, const Log& log)
    : log_source_(bus_source(std::move(name))),
      log_(log),
      runtime_(runtime),
      remarks_(log, log_source_),
      watch_(runtime, {.reopen = [this](std::string_view why) { link_->reopen(why); }, .drop = [this] { give_up(); }}),
      link_(std::move(link)) {
  assert(link_ != nullptr);
}

KincoWire::~KincoWire() = default;

void KincoWire::start(bus::WireEvents& events) {
  events_ = &events;
  watch_.start(events);
  link_->start(*this);
}

void KincoWire::send(const bus::Exchange& exchange) {
  assert(watch_.up());
  const Frame request = request_of(exchange);
  const FrameBytes bytes = encode(request);
  receiver_.await(exchange);
  before_ = std::exchange(asked_, exchange);
  outstanding_ = exchange;
  echo_.on_sent(exchange.access == bus::Access::read);
  remarks_.tell_of(echo_, runtime_.now());
  log_frame("->", bytes, request, "");
  link_->send(bytes);
}

void KincoWire::abandon() { give_up(); }

void KincoWire::give_up() {
  receiver_.give_up();
  if (outstanding_) given_up_ = std::exchange(outstanding_, std::nullopt);
}

const bus::Statistics& KincoWire::statistics() const {
  statistics_.bad_frames = receiver_.bad_frames() + receiver_.foreign_frames();
  statistics_.late_replies = receiver_.late_replies();
  statistics_.dropped_bytes = receiver_.dropped_bytes();
  statistics_.echoes = receiver_.echoes();
  statistics_.reconnects = watch_.reconnects();
  return statistics_;
}

void KincoWire::on_link_up() {
  receiver_.reset();
  echo_.reset();
  outstanding_.reset();
  before_.reset();
  given_up_.reset();
  watch_.on_link_up();
}

void KincoWire::on_link_down(std::string_view why) {
  receiver_.reset();
  watch_.on_link_down(why);
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
        outstanding_.reset();
        echo_.on_answer(true);
        log_frame("<-", receiver_.frame_bytes(), *answer, "");
        break;
      case Receiver::Heard::late:
        take_other("late");
        break;
      case Receiver::Heard::foreign:
        take_other("another master's");
        break;
      case Receiver::Heard::echo:
        static_cast<void>(echo_.on_copy(false));  // no drive answers with a request
        log_frame("<-", receiver_.frame_bytes(), receiver_.frame(), "  (echo)");
        break;
    }
  }
  const std::uint32_t dropped = receiver_.dropped_bytes() - dropped_before;
  if (decode_ && dropped > 0)
    log_.write(LogLevel::info, log_source_, fmt::format("<- skipped {} bytes", dropped), LogPace::each);
  if (answer) {
    watch_.on_answer();
    // Last: the bus may send its next request from inside this call.
    if (watch_.up()) events_->on_reply(result_of(*answer));
  } else if (dropped > 0) {
    watch_.on_noise();
  }
}

void KincoWire::take_other(std::string_view remark) {
  const Frame& frame = receiver_.frame();
  log_frame("<-", receiver_.frame_bytes(), frame, fmt::format("  ({})", remark));
  echo_.on_other();
  const auto may_come_of = [&](const std::optional<bus::Exchange>& older) { return older && answers(frame, *older); };
  if (!outstanding_ || may_come_of(before_) || may_come_of(given_up_)) return;
  const Frame asked = request_of(*outstanding_);
  remarks_.misfit(fmt::format("station {}: {}", asked.node, describe(asked)),
                  fmt::format("station {}: {}", frame.node, describe(frame)), remark, runtime_.now());
}

void KincoWire::log_frame(std::string_view direction, Bytes bytes, const Frame& frame, std::string_view remark) const {
  if (!decode_) return;
  log_.write(LogLevel::info, log_source_,
             fmt::format("{} {}  {}{}", direction, hex_text(bytes), describe(frame), remark), LogPace::each);
}

}  // namespace axisgate::kinco
