// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/session/session.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "gateway/core/name_table.hpp"
#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/session/pipeline.hpp"
#include "gateway/upstream/modbus_tcp/wire/rtu_frame.hpp"

namespace axisgate::modbus_tcp {
namespace {

std::shared_ptr<Client> join(const SessionContext& context, const Peer& peer, Instant now) {
  auto connected = context.clients.connect(peer, context.settings.client_is_address, now);
  if (connected.forgotten) context.commands.client_gone(*connected.forgotten);
  return std::move(connected.client);
}

}  // namespace

Session::Session(const SessionContext& context, const Peer& peer, Instant now, std::function<void()> on_output)
    : context_(context),
      client_(join(context, peer, now)),
      on_output_(std::move(on_output)),
      pipeline_(std::make_unique<Pipeline>(
          context, peer.role, client_, now,
          [this](std::uint16_t transaction, std::uint8_t unit, const Pdu& pdu) { put_reply(transaction, unit, pdu); },
          [this](std::uint64_t number, const Outcome& outcome) { on_result(number, outcome); })),
      now_(now),
      active_at_(now) {}

Session::~Session() { on_closed(now_); }

bool Session::finished() const { return why_ != CloseReason::none && pipeline_->under_way() == 0; }

ClientId Session::client() const { return client_->id; }

bool Session::has_room() const { return pipeline_->under_way() + replies_waiting_ < kMaxPipelined; }

void Session::on_bytes(Bytes bytes, Instant now, Instant came) {
  if (over()) return;
  now_ = now;
  came_ = came;
  if (std::exchange(is_new_, false)) name_rtu_client(bytes);
  framer_.push(bytes);
  take_requests();
}

/// What it asks is no Modbus-TCP, and is answered as such: but whoever set it up is told what to change.
void Session::name_rtu_client(Bytes first) {
  if (!is_rtu_request(first)) return;
  context_.log.write(LogLevel::warning, "modbus",
                     client_->life->name + " sends Modbus RTU frames over TCP: set it to Modbus TCP");
}

/// As many as there is room for; the rest stays with the framer until replies were taken.
void Session::take_requests() {
  Frame frame;
  while (!over() && has_room()) {
    const MbapFramer::Verdict verdict = framer_.next(frame);
    if (verdict == MbapFramer::Verdict::need_more) {
      if (framer_.kept() == 0)
        part_since_ = kNever;
      else if (part_since_ == kNever)
        part_since_ = now_;
      return;
    }
    part_since_ = kNever;
    if (verdict == MbapFramer::Verdict::malformed) {
      ++context_.clients.counters.malformed;
      why_ = CloseReason::malformed;
      return;
    }
    active_at_ = now_;
    pipeline_->accept(frame, now_, now_ - came_ < kLongWait ? now_ : came_);
  }
  // What is kept now waits for us, not for the client.
  part_since_ = kNever;
}

void Session::put_reply(std::uint16_t transaction, std::uint8_t unit, const Pdu& pdu) {
  const std::size_t at = output_.size();
  output_.resize(at + kMbapSize + pdu.size());
  const auto head = std::span(output_).subspan(at);
  store_be16(head, 0, transaction);
  store_be16(head, 4, static_cast<std::uint16_t>(1 + pdu.size()));
  head[6] = unit;
  std::copy(pdu.begin(), pdu.end(), head.begin() + kMbapSize);
  ++replies_waiting_;
  if (reply_since_ == kNever) reply_since_ = now_;
}

void Session::on_result(std::uint64_t number, const Outcome& outcome) {
  if (context_.runtime != nullptr) now_ = context_.runtime->now();
  pipeline_->conclude(number, outcome, now_);
  take_requests();
  if (on_output_) on_output_();
}

void Session::take_output(std::size_t bytes, Instant now) {
  assert(bytes <= output().size());
  now_ = now;
  taken_ += bytes;
  if (taken_ < output_.size()) return;
  output_.clear();
  taken_ = 0;
  replies_waiting_ = 0;
  if (reply_since_ != kNever) active_at_ = now;
  reply_since_ = kNever;
  if (!closed_) take_requests();
}

Instant Session::part_deadline() const {
  return part_since_ == kNever ? kNever : part_since_ + context_.settings.request_deadline;
}

Instant Session::reply_deadline() const {
  return reply_since_ == kNever ? kNever : reply_since_ + context_.settings.request_deadline;
}

Instant Session::idle_deadline() const {
  const bool busy = pipeline_->under_way() != 0 || !output().empty();
  return busy || context_.settings.idle_timeout == Duration::zero() ? kNever
                                                                    : active_at_ + context_.settings.idle_timeout;
}

Instant Session::next_deadline() const {
  if (closed_) return kNever;
  if (why_ != CloseReason::none) return reply_deadline();
  return std::min({part_deadline(), reply_deadline(), idle_deadline(), pipeline_->next_deadline()});
}

void Session::on_deadline(Instant now) {
  now_ = now;
  if (closed_) return;
  pipeline_->on_deadline(now);
  if (reply_deadline() <= now) {
    // A client that takes no replies gets no more of them either.
    pipeline_->abandon();
    output_.clear();
    taken_ = 0;
    reply_since_ = kNever;
    if (why_ == CloseReason::none) why_ = CloseReason::reply_not_taken;
  }
  if (why_ != CloseReason::none) return;
  if (part_deadline() <= now) {
    why_ = CloseReason::request_incomplete;
  } else if (idle_deadline() <= now) {
    why_ = CloseReason::idle;
  }
}

void Session::on_closed(Instant now) {
  if (closed_) return;
  closed_ = true;
  now_ = now;
  pipeline_->abandon();
  if (const auto gone = context_.clients.disconnect(client_, now)) context_.commands.client_gone(*gone);
}

std::string_view text(CloseReason why) {
  static constexpr auto kNames = names_of<CloseReason>({
      {CloseReason::none, "closed by the client"},
      {CloseReason::malformed, "malformed frame"},
      {CloseReason::request_incomplete, "request not complete in time"},
      {CloseReason::reply_not_taken, "reply not taken in time"},
      {CloseReason::idle, "idle"},
  });
  static_assert(kNames.has_all_to(CloseReason::idle));
  return kNames.of(why);
}

}  // namespace axisgate::modbus_tcp
