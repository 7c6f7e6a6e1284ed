// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/host/keeper.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace axisgate::host {

std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7F'; }, ' ');
  return text;
}

Keeper::Keeper(boost::asio::io_context& io, Runtime& runtime, const HostedProgram& program, HostedSession& session,
               const Log& log, KeeperReports reports)
    : io_(io),
      runtime_(runtime),
      program_(program),
      session_(session),
      log_(log),
      reports_(std::move(reports)),
      turn_timer_(runtime.make_timer([this] { turn(); })),
      patience_(runtime.make_timer([this] { on_patience_ended(); })),
      plan_(program) {}

Keeper::~Keeper() { stop(); }

void Keeper::run(std::optional<Arguments> arguments) {
  if (arguments == arguments_) return;
  arguments_ = std::move(arguments);
  if (process_) return fail({ProcessEnd::How::another_configuration});
  go_on();
}

/// Nothing of it runs.
void Keeper::go_on() {
  report_down(arguments_.has_value());
  report_address(false);
  patience_->expires_at(kNever);
  if (arguments_) begin();
}

void Keeper::stop() {
  ready_ = false;
  patience_->expires_at(kNever);
  turn_timer_->expires_at(kNever);
  process_.reset();
}

std::optional<pid_t> Keeper::pid() const { return process_ ? std::optional(process_->pid()) : std::nullopt; }

void Keeper::begin() {
  const FoundProgram found = find_program(program_);
  if (found.path.empty()) return on_end({ProcessEnd::How::not_found, 0, found.why_not});
  auto started =
      ChildProcess::start(io_, found.path, *arguments_, program_.nicer, [this](const ProcessEnd& end) { on_end(end); });
  if (const auto* end = std::get_if<ProcessEnd>(&started)) return on_end(*end);
  process_ = std::move(std::get<std::unique_ptr<ChildProcess>>(started));
  patience_->expires_at(runtime_.now() + kReadyWithin);
  read_soon();
}

void Keeper::on_patience_ended() {
  if (!process_) return begin();
  if (process_->socket() == nullptr) return fail({ProcessEnd::How::closed});
  if (!ready_) return fail({ProcessEnd::How::not_ready});
  look_whether_it_takes(runtime_.now());
}

void Keeper::look_whether_it_takes(Instant now) {
  if (taking_.stuck(process_->socket()->unread(), now)) return fail({ProcessEnd::How::stuck});
  patience_->expires_at(now + kLooksEach);
}

void Keeper::report_down(bool down) const {
  if (reports_.down) reports_.down(down);
}

void Keeper::report_address(bool missing) const {
  if (reports_.address_missing) reports_.address_missing(missing);
}

// --- From the process ------------------------------------------------------------------------------------------------

void Keeper::read_soon() {
  const bool open = process_ && process_->socket() != nullptr;
  if (!open || reading_ || !session_.has_room()) return;
  reading_ = true;
  process_->socket()->when_readable([this] {
    reading_ = false;
    read_turn();
    turn();
  });
}

void Keeper::read_turn() {
  const Instant now = runtime_.now();
  for (int i = 0; i < kMaxReadATurn && session_.has_room(); ++i) {
    const auto received = process_->socket()->receive();
    if (received.what == PacketSocket::Got::nothing) return;
    if (received.what == PacketSocket::Got::closed) return drop_link();
    if (received.what == PacketSocket::Got::too_long)
      return fail({ProcessEnd::How::not_a_record, 0, "a packet longer than any record"});
    if (!take(received.packet, now)) return;
  }
}

bool Keeper::take(Bytes packet, Instant now) {
  Heard heard = session_.hear(packet);
  if (heard.what == Heard::What::line) {
    take_line(heard, now);
    return true;
  }
  // Where a packet starts with what only we send, or with a request before it is ready, nothing else is to be
  // believed.
  if (heard.what != Heard::What::nonsense && heard.what != (ready_ ? Heard::What::own : Heard::What::ready))
    heard = {Heard::What::nonsense, kOutOfItsTurn};
  if (heard.what == Heard::What::nonsense) {
    fail({ProcessEnd::How::not_a_record, 0, heard.text});
    return false;
  }
  if (ready_)
    session_.take(now);
  else
    on_ready(heard.text, now);
  return true;
}

void Keeper::take_line(const Heard& line, Instant now) {
  if (!lines_.takes(now)) return;
  if (const auto left_out = lines_.left_out(); left_out > 0)
    log_.write(LogLevel::warning, program_.log_source,
               std::to_string(left_out) + " lines of " + std::string(program_.name) + " are left out here");
  log_.write(static_cast<LogLevel>(std::min(line.level, static_cast<std::uint8_t>(LogLevel::debug))),
             program_.log_source, printable(line.text));
}

void Keeper::on_ready(const std::string& version, Instant now) {
  ready_ = true;
  ++starts_;
  taking_.on_ready(now);
  patience_->expires_at(now + kLooksEach);
  report_down(false);
  report_address(false);
  reports_.event(EventKind::boot, plan_.on_ready(printable(version), now));
  session_.on_link_up(now);
}

// --- To the process --------------------------------------------------------------------------------------------------

void Keeper::turn() {
  send_turn();
  read_soon();  // where it was not read for want of room, replies that went out have made some
}

void Keeper::send_turn() {
  if (!ready_ || !packet_.empty()) return;
  const Instant now = runtime_.now();
  for (int i = 0; i < kMaxSentATurn; ++i) {
    auto packet = session_.next(now);
    if (!packet) return turn_timer_->expires_at(session_.wake_at());
    packet_ = std::move(*packet);
    if (!send_packet(now)) return;
  }
  turn_timer_->expires_at(now);
}

bool Keeper::send_packet(Instant now) {
  const auto sent = process_->socket()->send(packet_);
  if (sent == PacketSocket::Sent::closed) {
    take_last_lines(now);
    drop_link();
    return false;
  }
  if (sent == PacketSocket::Sent::no_room) {
    session_.on_no_room();
    wait_for_room();
    return false;
  }
  taking_.on_sent(packet_.size());
  packet_.clear();
  return true;
}

void Keeper::wait_for_room() {
  process_->socket()->when_writable([this] {
    if (send_packet(runtime_.now())) turn();
  });
}

// --- Its end ---------------------------------------------------------------------------------------------------------

void Keeper::drop_link() {
  const Instant now = runtime_.now();
  process_->close_socket();
  packet_.clear();
  reading_ = false;
  turn_timer_->expires_at(kNever);
  patience_->expires_at(now + kEndsWithin);
  if (!std::exchange(ready_, false)) return;
  report_down(true);
  session_.on_link_down(now);
}

void Keeper::fail(ProcessEnd cause) {
  if (!cause_) cause_ = std::move(cause);
  drop_link();
  process_->kill();
}

void Keeper::on_end(const ProcessEnd& end) {
  const Instant now = runtime_.now();
  if (process_ && process_->socket() != nullptr) take_last_lines(now);
  if (process_) drop_link();
  process_.reset();
  const ProcessEnd how = std::exchange(cause_, {}).value_or(end);
  if (how.how == ProcessEnd::How::another_configuration) return go_on();
  report_address(has_no_address(how));
  const auto next = plan_.on_end(how, now);
  if (next.report) reports_.event(EventKind::warning, *next.report);
  patience_->expires_at(now + next.pause);
}

/// What it said before it died often tells why.
void Keeper::take_last_lines(Instant now) {
  for (int i = 0; i < kMaxReadATurn; ++i) {
    const auto received = process_->socket()->receive();
    if (received.what != PacketSocket::Got::packet) return;
    if (const Heard heard = session_.hear(received.packet); heard.what == Heard::What::line) take_line(heard, now);
  }
}

}  // namespace axisgate::host
