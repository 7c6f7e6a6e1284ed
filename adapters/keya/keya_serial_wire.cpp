// SPDX-License-Identifier: Apache-2.0
#include "adapters/keya/keya_serial_wire.hpp"

#include <fmt/format.h>

#include <array>
#include <cassert>
#include <optional>
#include <utility>

#include "adapters/bus/line_remarks.hpp"
#include "adapters/bus/line_watch.hpp"
#include "adapters/keya/keya_serial_receiver.hpp"
#include "adapters/keya/keya_text.hpp"

namespace axisgate::keya {

namespace {

using Heard = SerialReceiver::Heard;

class KeyaSerialWire final : public bus::Wire, private bus::ByteLinkEvents {
 public:
  KeyaSerialWire(KeyaSerialSettings settings, std::unique_ptr<bus::ByteLink> link, Runtime& runtime, const Log& log);

  void start(bus::WireEvents& events) override;
  void send(const bus::Exchange& exchange) override;
  void abandon() override;
  [[nodiscard]] const bus::Statistics& statistics() const override;
  void set_decode(bool on) override { decode_ = on; }

 private:
  /// What a piece of the stream has brought.
  struct News {
    std::optional<bus::ExchangeResult> answer{};
    bool present = false;
  };

  void on_link_up() override;
  void on_link_down(std::string_view why) override;
  void on_bytes(Bytes bytes) override;

  void owe(const bus::ExchangeResult& result, Duration after);
  void pay();
  void on_silence();
  void hear(Heard heard, News& news);
  void tell(const News& news, std::uint32_t dropped);
  void tell_misfit(const SerialFrame& frame, std::string_view why);
  void drop_outstanding();
  void log_frame(std::string_view direction, Bytes bytes, std::string_view text) const;

  KeyaSerialSettings settings_;
  LogSource log_source_;
  Runtime& runtime_;
  const Log& log_;
  bus::WireEvents* events_ = nullptr;
  SerialReceiver receiver_;
  bus::Exchange outstanding_;              // newest
  bool awaiting_ = false;                  // a read
  std::optional<bus::Exchange> before_;    // asked before it: its answer may be said twice
  std::optional<bus::Exchange> given_up_;  // last: its answer may be late
  bus::LineRemarks remarks_;
  /// What ends without an answer ends by a timer, never inside send().
  std::optional<bus::ExchangeResult> owed_;
  Instant last_heartbeat_ = kLongAgo;
  bool decode_ = false;
  mutable bus::Statistics statistics_;
  // Last, so that they go first: none may call into a wire that is half gone.
  std::unique_ptr<Timer> owed_timer_;
  std::unique_ptr<Timer> silence_timer_;
  bus::LineWatch watch_;
  std::unique_ptr<bus::ByteLink> link_;
};

KeyaSerialWire::KeyaSerialWire(KeyaSerialSettings settings, std::unique_ptr<bus::ByteLink> link, Runtime& runtime,
                               const Log& log)
    : settings_(std::move(settings)),
      log_source_(bus_source(settings_.name)),
      runtime_(runtime),
      log_(log),
      receiver_(settings_.line),
      remarks_(log, log_source_),
      owed_timer_(runtime.make_timer([this] { pay(); })),
      silence_timer_(runtime.make_timer([this] { on_silence(); })),
      watch_(runtime,
             {.reopen = [this](std::string_view why) { link_->reopen(why); }, .drop = [this] { drop_outstanding(); }}),
      link_(std::move(link)) {
  assert(link_ != nullptr && settings_.baud > 0);
}

void KeyaSerialWire::start(bus::WireEvents& events) {
  events_ = &events;
  watch_.start(events);
  link_->start(*this);
}

const bus::Statistics& KeyaSerialWire::statistics() const {
  statistics_.bad_frames = receiver_.lost_frames() + receiver_.foreign_frames() + receiver_.odd_heartbeats();
  statistics_.late_replies = receiver_.late_replies();
  statistics_.dropped_bytes = receiver_.dropped_bytes();
  statistics_.echoes = receiver_.echoes();
  statistics_.reconnects = watch_.reconnects();
  return statistics_;
}

// --- What we send ---------------------------------------------------------------------------------------------------

void KeyaSerialWire::send(const bus::Exchange& exchange) {
  assert(watch_.up() && !owed_);
  if (const auto refusal = refusal_of(settings_.line, exchange)) {
    owe(*refusal, Duration{});
    return;
  }
  const SerialFrame request = request_of(settings_.line, exchange);
  const FrameBytes bytes = encode(settings_.line, request);
  before_ = std::exchange(outstanding_, exchange);
  awaiting_ = exchange.access == bus::Access::read;
  receiver_.sent(exchange, bytes);
  remarks_.tell_of(receiver_.echo(), runtime_.now());
  if (decode_) log_frame("->", bytes, describe_request(request));
  if (exchange.access == bus::Access::write) owe({}, frame_time(settings_.baud));
  link_->send(bytes);
}

void KeyaSerialWire::owe(const bus::ExchangeResult& result, Duration after) {
  owed_ = result;
  owed_timer_->expires_at(runtime_.now() + after);
}

void KeyaSerialWire::pay() {
  const auto owed = std::exchange(owed_, std::nullopt);
  // Last: the bus may send its next request from inside this call.
  if (owed && watch_.up()) events_->on_reply(*owed);
}

void KeyaSerialWire::abandon() { drop_outstanding(); }

void KeyaSerialWire::drop_outstanding() {
  receiver_.give_up();
  if (std::exchange(awaiting_, false)) given_up_ = outstanding_;
  owed_.reset();
  owed_timer_->expires_at(kNever);
}

// --- What we hear ---------------------------------------------------------------------------------------------------

void KeyaSerialWire::on_link_up() {
  receiver_.reset();
  before_.reset();
  given_up_.reset();
  last_heartbeat_ = kLongAgo;
  watch_.on_link_up();
}

void KeyaSerialWire::on_link_down(std::string_view why) {
  receiver_.reset();
  drop_outstanding();
  silence_timer_->expires_at(kNever);
  watch_.on_link_down(why);
}

void KeyaSerialWire::on_bytes(Bytes bytes) {
  const std::uint32_t dropped_before = receiver_.dropped_bytes();
  News news;
  for (const Byte byte : bytes) hear(receiver_.take(byte), news);
  silence_timer_->expires_at(receiver_.unfinished() ? runtime_.now() + kInterByteTimeout : kNever);
  tell(news, receiver_.dropped_bytes() - dropped_before);
}

void KeyaSerialWire::on_silence() {
  const std::uint32_t dropped_before = receiver_.dropped_bytes();
  News news;
  hear(receiver_.on_silence(), news);
  tell(news, receiver_.dropped_bytes() - dropped_before);
}

void KeyaSerialWire::hear(Heard heard, News& news) {
  static constexpr std::array kRemarks{"", "", "  (late)", "  (echo)", "", "  (another master)"};
  if (heard == Heard::nothing) return;
  const SerialFrame& frame = receiver_.frame();
  if (decode_) {
    const std::string text = heard == Heard::echo ? describe_request(frame) : describe_answer(settings_.line, frame);
    log_frame("<-", receiver_.frame_bytes(), text + kRemarks.at(static_cast<std::size_t>(heard)));
  }
  if (heard == Heard::answer) {
    awaiting_ = false;
    news.answer = result_of(settings_.line, frame, outstanding_);
  }
  if (heard == Heard::late || heard == Heard::foreign)
    tell_misfit(frame, heard == Heard::late ? "late" : "another master's");
  if (heard == Heard::heartbeat) {
    const Instant before = std::exchange(last_heartbeat_, runtime_.now());
    if (before == kLongAgo || runtime_.now() - before > kSerialHeartbeatSilence) news.present = true;
  }
}

void KeyaSerialWire::tell_misfit(const SerialFrame& frame, std::string_view why) {
  const auto may_come_of = [&](const std::optional<bus::Exchange>& older) {
    return older && answers(settings_.line, frame, *older);
  };
  if (!awaiting_ || may_come_of(before_) || may_come_of(given_up_)) return;
  const SerialFrame asked = request_of(settings_.line, outstanding_);
  remarks_.misfit(fmt::format("node {}: {}", asked.node, describe_request(asked)),
                  fmt::format("node {}: {}", frame.node, describe_answer(settings_.line, frame)), why, runtime_.now());
}

void KeyaSerialWire::tell(const News& news, std::uint32_t dropped) {
  if (decode_ && dropped > 0)
    log_.write(LogLevel::info, log_source_, fmt::format("<- skipped {} bytes", dropped), LogPace::each);
  if (news.answer) {
    watch_.on_answer();
  } else if (dropped > 0) {
    watch_.on_noise();
  }
  // Last: the bus may send its next request from inside these.
  if (news.answer && watch_.up()) events_->on_reply(*news.answer);
  if (news.present && watch_.up()) {
    events_->on_unsolicited(
        {.kind = bus::UnsolicitedEvent::Kind::present, .node = kRs232Node, .state = bus::NodeState::operational});
  }
}

void KeyaSerialWire::log_frame(std::string_view direction, Bytes bytes, std::string_view text) const {
  log_.write(LogLevel::info, log_source_, fmt::format("{} {}  {}", direction, hex_text(bytes), text), LogPace::each);
}

}  // namespace

std::unique_ptr<bus::Wire> make_keya_serial_wire(KeyaSerialSettings settings, std::unique_ptr<bus::ByteLink> link,
                                                 Runtime& runtime, const Log& log) {
  return std::make_unique<KeyaSerialWire>(std::move(settings), std::move(link), runtime, log);
}

}  // namespace axisgate::keya
