// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_host/dds_server.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "gateway/upstream/dds_host/program.hpp"

namespace axisgate::dds {
namespace {

/// Texts come from a process that listens to a network: one line of the log stays one line.
std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7F'; }, ' ');
  return text;
}

}  // namespace

DdsServer::DdsServer(boost::asio::io_context& io, Runtime& runtime, const DdsSettings& settings, ProcessImage& image,
                     const EventRing& events, CommandPort& commands, const Log& log, DdsReports reports)
    : io_(io),
      runtime_(runtime),
      settings_(settings),
      log_(log),
      reports_(std::move(reports)),
      turn_timer_(runtime.make_timer([this] { turn(); })),
      patience_(runtime.make_timer([this] { on_patience_ended(); })),
      session_(settings, image, events, commands, [this] { turn_timer_->expires_at(runtime_.now()); },
               {[this](const std::string& line) { log_.write(LogLevel::info, "dds", printable(line)); },
                [this](bool taken, const std::string& where) { on_name_taken(taken, where); },
                [this](const std::string& line) {
                  log_.write(LogLevel::info, "dds", printable(line), LogPace::each);  // that of each writer
                }}) {}

DdsServer::~DdsServer() { stop(); }

void DdsServer::start() {
  reports_.down(true);
  begin();
}

void DdsServer::stop() {
  ready_ = false;
  patience_->expires_at(kNever);
  turn_timer_->expires_at(kNever);
  process_.reset();
}

std::optional<pid_t> DdsServer::pid() const { return process_ ? std::optional(process_->pid()) : std::nullopt; }

void DdsServer::begin() {
  const Program program = find_program();
  if (program.path.empty()) return on_end({ProcessEnd::How::not_found, 0, program.why_not});
  auto started = ChildProcess::start(io_, program.path, serve_arguments(settings_, kLinkDescriptor),
                                     [this](const ProcessEnd& end) { on_end(end); });
  if (const auto* end = std::get_if<ProcessEnd>(&started)) return on_end(*end);
  process_ = std::move(std::get<std::unique_ptr<ChildProcess>>(started));
  patience_->expires_at(runtime_.now() + kReadyWithin);
  read_soon();
}

void DdsServer::on_patience_ended() {
  if (!process_) return begin();
  if (process_->socket() == nullptr) return fail({ProcessEnd::How::closed});
  if (!ready_) return fail({ProcessEnd::How::not_ready});
  look_whether_it_takes(runtime_.now());
}

void DdsServer::look_whether_it_takes(Instant now) {
  if (taking_.stuck(process_->socket()->unread(), now)) return fail({ProcessEnd::How::stuck});
  patience_->expires_at(now + kLooksEach);
}

// --- From the process ------------------------------------------------------------------------------------------------

void DdsServer::read_soon() {
  const bool open = process_ && process_->socket() != nullptr;
  if (!open || reading_ || !session_.has_room()) return;
  reading_ = true;
  process_->socket()->when_readable([this] {
    reading_ = false;
    read_turn();
    turn();
  });
}

void DdsServer::read_turn() {
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

bool DdsServer::take(Bytes packet, Instant now) {
  const Decoded decoded = decode(packet);
  if (decoded.error == DecodeError::none) return take(decoded.record, now);
  fail({ProcessEnd::How::not_a_record, 0, text(decoded.error, "axisgate-dds")});
  return false;
}

bool DdsServer::take(const Record& record, Instant now) {
  if (const auto* line = std::get_if<LogRecord>(&record)) {
    take_line(*line, now);
    return true;
  }
  const auto* readiness = std::get_if<ReadyRecord>(&record);
  // Where a packet starts with what only we send, or with a request before there are topics, nothing else is to be
  // believed.
  const bool its_own = record.index() > Record(ReadyRecord{}).index();
  if (ready_ ? !its_own : readiness == nullptr) {
    fail({ProcessEnd::How::not_a_record, 0, "a record out of its turn"});
    return false;
  }
  if (readiness != nullptr) {
    on_ready(*readiness, now);
  } else {
    session_.on_record(record, now);
  }
  return true;
}

void DdsServer::take_line(const LogRecord& line, Instant now) {
  if (!lines_.takes(now)) return;
  if (const auto left_out = lines_.left_out(); left_out > 0)
    log_.write(LogLevel::warning, "dds", std::to_string(left_out) + " lines of axisgate-dds are left out here");
  log_.write(static_cast<LogLevel>(std::min(line.level, static_cast<std::uint8_t>(LogLevel::debug))), "dds",
             printable(line.text));
}

void DdsServer::on_ready(const ReadyRecord& record, Instant now) {
  ready_ = true;
  taking_.on_ready(now);
  patience_->expires_at(now + kLooksEach);
  reports_.down(false);
  if (reports_.address_missing) reports_.address_missing(false);
  reports_.event(EventKind::boot, plan_.on_ready(printable(record.version), now));
  session_.on_link_up(now);
}

void DdsServer::on_name_taken(bool taken, const std::string& where) {
  if (reports_.name_taken) reports_.name_taken(taken);
  const std::string name = "the gateway name \"" + settings_.gateway.name + "\" ";
  if (!taken) return reports_.event(EventKind::warning, name + "is ours alone again: DDS clients may start axes");
  reports_.event(EventKind::warning,
                 name + "is taken in this domain as well (" + printable(where) +
                     "): DDS clients start nothing until it is not; give each gateway a \"gateway\": {\"name\": ...} "
                     "of its own");
}

// --- To the process --------------------------------------------------------------------------------------------------

void DdsServer::turn() {
  send_turn();
  read_soon();  // where it was not read for want of room, replies that went out have made some
}

void DdsServer::send_turn() {
  if (!ready_ || waiting_for_room_) return;
  const Instant now = runtime_.now();
  for (int i = 0; i < kMaxSentATurn; ++i) {
    if (packet_.empty()) {
      const auto record = session_.next(now);
      if (!record) return turn_timer_->expires_at(session_.wake_at());
      packet_ = encode(*record);
    }
    const auto sent = process_->socket()->send(packet_);
    if (sent == PacketSocket::Sent::closed) {
      take_last_lines(now);
      return drop_link();
    }
    if (sent == PacketSocket::Sent::no_room) return wait_for_room();
    taking_.on_sent(packet_.size());
    packet_.clear();
  }
  turn_timer_->expires_at(now);
}

void DdsServer::wait_for_room() {
  waiting_for_room_ = true;
  process_->socket()->when_writable([this] {
    waiting_for_room_ = false;
    turn();
  });
}

// --- Its end ---------------------------------------------------------------------------------------------------------

void DdsServer::drop_link() {
  const Instant now = runtime_.now();
  process_->close_socket();
  packet_.clear();
  waiting_for_room_ = false;
  reading_ = false;
  turn_timer_->expires_at(kNever);
  patience_->expires_at(now + kEndsWithin);
  if (!std::exchange(ready_, false)) return;
  reports_.down(true);
  session_.on_link_down(now);
}

void DdsServer::fail(ProcessEnd cause) {
  if (!cause_) cause_ = std::move(cause);
  drop_link();
  process_->kill();
}

void DdsServer::on_end(const ProcessEnd& end) {
  const Instant now = runtime_.now();
  if (process_ && process_->socket() != nullptr) take_last_lines(now);
  if (process_) drop_link();
  process_.reset();
  const ProcessEnd how = std::exchange(cause_, {}).value_or(end);
  if (reports_.address_missing) reports_.address_missing(has_no_address(how));
  const auto next = plan_.on_end(how, now);
  if (next.report) reports_.event(EventKind::warning, *next.report);
  patience_->expires_at(now + next.pause);
}

/// What it said before it died often tells why.
void DdsServer::take_last_lines(Instant now) {
  for (int i = 0; i < kMaxReadATurn; ++i) {
    const auto received = process_->socket()->receive();
    if (received.what != PacketSocket::Got::packet) return;
    const Decoded decoded = decode(received.packet);
    const auto* line = std::get_if<LogRecord>(&decoded.record);
    if (decoded.error == DecodeError::none && line != nullptr) take_line(*line, now);
  }
}

}  // namespace axisgate::dds
