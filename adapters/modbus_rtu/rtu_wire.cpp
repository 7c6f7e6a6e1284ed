// SPDX-License-Identifier: Apache-2.0
#include "adapters/modbus_rtu/rtu_wire.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "adapters/modbus_rtu/rtu_text.hpp"
#include "gateway/core/rtu_crc.hpp"

namespace axisgate::modbus_rtu {

namespace {

/// All slaves obey it and none answers (Modbus over serial line V1.02, 2.2).
constexpr std::uint8_t kStandardBroadcast = 0;

}  // namespace

RtuWire::RtuWire(std::string name, std::vector<RtuNode> nodes, LineSpeed speed, std::unique_ptr<RtuLink> link,
                 Runtime& runtime, const Log& log)
    : log_source_(bus_source(std::move(name))),
      nodes_(std::move(nodes)),
      speed_(speed),
      runtime_(runtime),
      log_(log),
      remarks_(log, log_source_),
      broadcast_timer_(runtime.make_timer([this] { broadcast_over(); })),
      watch_(runtime, {.reopen = [this](std::string_view why) { link_->reopen(why); }, .drop = [this] { abandon(); }}),
      link_(std::move(link)) {
  assert(!nodes_.empty() && link_ != nullptr);
  for (const RtuNode& node : nodes_) heard_[node.node];
}

RtuWire::~RtuWire() = default;

void RtuWire::start(bus::WireEvents& events) {
  events_ = &events;
  watch_.start(events);
  link_->start(*this);
}

void RtuWire::send(const bus::Exchange& exchange) {
  assert(watch_.up() && !outstanding_);
  const bool broadcast = is_broadcast(exchange.node);
  assert(!broadcast || exchange.access == bus::Access::write);
  const Frame frame = request_of(exchange, node_of(exchange.node));
  outstanding_ = {++last_number_, exchange, broadcast, runtime_.now(), frame.size() + kCrcSize};
  request_ = frame;
  clean_ = true;
  echo_.on_sent(exchange.access == bus::Access::read);
  remarks_.tell_of(echo_, runtime_.now());
  if (decode_) log_frame("->", frame, describe_request(frame));
  link_->transmit(last_number_, frame);
  if (!broadcast) return;
  // The silence belongs to it: only then can no drive take the next frame for a part of this one.
  const Duration on_wire = wire_time(speed_.baud, speed_.parity_bits, frame.size() + kCrcSize, 0);
  broadcast_timer_->expires_at(runtime_.now() + on_wire + gap_time(speed_.baud));
}

void RtuWire::abandon() {
  if (outstanding_) link_->withdraw(outstanding_->number);
  give_up();
}

void RtuWire::give_up() {
  // What comes early from now on may be the answer to this one, and the same as what was heard last all the same.
  if (outstanding_ && !outstanding_->broadcast) heard_[outstanding_->exchange.node] = {{}, runtime_.now()};
  outstanding_.reset();
}

const bus::Statistics& RtuWire::statistics() const {
  statistics_.reconnects = watch_.reconnects();
  return statistics_;
}

void RtuWire::end(const bus::ExchangeResult& result) {
  outstanding_.reset();
  if (watch_.up()) events_->on_reply(result);  // last: the bus may send its next request from inside this call
}

void RtuWire::broadcast_over() {
  if (outstanding_ && outstanding_->broadcast) end({});
}

void RtuWire::on_link_up() {
  give_up();
  for (auto& [unit, heard] : heard_) heard.last.clear();
  request_.clear();
  echo_.reset();
  timed_ = true;
  watch_.on_link_up();
}

void RtuWire::on_link_down(std::string_view why) {
  give_up();
  watch_.on_link_down(why);
}

void RtuWire::on_frame(ExchangeNumber newest, Bytes frame) {
  if (newest == last_number_ && std::ranges::equal(frame, request_) && take_copy(frame)) return;
  std::string_view remark = "not asked for";
  if (outstanding_ && !outstanding_->broadcast) {
    const Judgement judgement = judge(frame, outstanding_->exchange, node_of(outstanding_->exchange.node));
    const auto* result = std::get_if<bus::ExchangeResult>(&judgement);
    const bool mine = result != nullptr && newest == outstanding_->number;
    const bool too_soon = mine && timed_ && early(frame);
    Heard& heard = heard_[outstanding_->exchange.node];
    const bool said_again = too_soon && std::ranges::equal(frame, heard.last);
    if (mine && !said_again) {
      if (decode_) log_frame("<-", frame, describe_reply(frame));
      watch_.on_answer();
      echo_.on_answer(clean_ && !(too_soon && may_owe(outstanding_->exchange.node)));
      heard.last.assign(frame.begin(), frame.end());
      // Of a drive that may owe an answer it says nothing about the line, and is nothing to compare the next one with.
      if (too_soon && may_owe(outstanding_->exchange.node)) {
        heard.last.clear();
      } else if (too_soon) {
        timed_ = false;
      }
      end(*result);
      return;
    }
    remark = mine ? "said twice" : result != nullptr ? "late" : text(std::get<NotMine>(judgement));
    if (result == nullptr && newest == outstanding_->number) tell_misfit(frame, remark);
  }
  take_other(frame, remark);
}

/// A read's or a longer write's is no answer; that of a write of one register or coil is, on a line without echo.
bool RtuWire::take_copy(Bytes frame) {
  const auto function = static_cast<Function>(frame[1]);
  const bool writes_one = function == Function::write_single_register || function == Function::write_single_coil;
  const bool may_be_answer = outstanding_ && !outstanding_->broadcast && writes_one;
  const bus::EchoWatch::Copy copy = echo_.on_copy(may_be_answer);
  if (copy == bus::EchoWatch::Copy::answer) return false;
  const bool echo = copy == bus::EchoWatch::Copy::echo;
  if (echo) ++statistics_.echoes;
  if (decode_) log_frame("<-", frame, describe_request(frame) + (echo ? "  (echo)" : "  (echo or answer)"));
  return true;
}

void RtuWire::tell_misfit(Bytes frame, std::string_view why) {
  const bool owed =
      may_owe(outstanding_->exchange.node) || (knows(frame[0]) && heard_.contains(frame[0]) && may_owe(frame[0]));
  if (!owed) remarks_.misfit(describe_request(request_), describe_reply(frame), why, runtime_.now());
}

void RtuWire::take_other(Bytes frame, std::string_view remark) {
  echo_.on_other();
  const bool late = well_formed(frame) && knows(frame[0]);
  ++(late ? statistics_.late_replies : statistics_.bad_frames);
  if (late) heard_[frame[0]] = {Frame(frame.begin(), frame.end()), runtime_.now()};
  if (decode_) log_frame("<-", frame, fmt::format("{}  ({})", describe_reply(frame), remark));
}

/// Sooner than request and answer can have crossed the line, it is no answer: the same as the answer before, it is that
/// one said again. A line where anything else comes as soon has no rate of its own (a pseudo-terminal, a device
/// server), unless its drive may owe it from before.
bool RtuWire::early(Bytes frame) const {
  const Duration crossing =
      wire_time(speed_.baud, speed_.parity_bits, outstanding_->request_bytes, frame.size() + kCrcSize);
  // A tenth less: no two clocks agree. The silence before an answer does not count, since some slaves keep none.
  return runtime_.now() - outstanding_->sent_at < crossing - crossing / 10;
}

void RtuWire::on_glitch(std::size_t bytes) {
  statistics_.dropped_bytes += static_cast<std::uint32_t>(bytes);
  if (decode_) log_.write(LogLevel::info, log_source_, fmt::format("<- skipped {} bytes", bytes));
}

void RtuWire::on_bad_frame(ExchangeNumber, std::size_t bytes) {
  clean_ = false;
  echo_.on_other();
  // A run of noise is one bad frame, in however many parts it is told.
  if (!watch_.noisy()) ++statistics_.bad_frames;
  statistics_.dropped_bytes += static_cast<std::uint32_t>(bytes);
  if (decode_)
    log_.write(LogLevel::info, log_source_, fmt::format("<- {} bytes that are no frame", bytes), LogPace::each);
  watch_.on_noise();
}

bool RtuWire::is_broadcast(std::uint8_t unit) const {
  return unit == kStandardBroadcast ||
         std::ranges::any_of(nodes_, [&](const RtuNode& n) { return n.broadcast == unit; });
}

bool RtuWire::may_owe(std::uint8_t unit) const {
  constexpr int kTimesAsLate = 4;
  return runtime_.now() < heard_.at(unit).unsure_since + kTimesAsLate * node_of(unit).worst_reply;
}

/// Of a broadcast: a drive that obeys it. They are of one type, or nothing sensible could be said to all of them.
const RtuNode& RtuWire::node_of(std::uint8_t unit) const {
  const auto own = std::ranges::find(nodes_, unit, &RtuNode::node);
  if (own != nodes_.end()) return *own;
  const auto obeys = std::ranges::find(nodes_, std::optional<std::uint8_t>(unit), &RtuNode::broadcast);
  return obeys != nodes_.end() ? *obeys : nodes_.front();
}

bool RtuWire::knows(std::uint8_t unit) const {
  return std::ranges::any_of(nodes_, [&](const RtuNode& n) { return n.node == unit || n.broadcast == unit; });
}

void RtuWire::log_frame(std::string_view direction, Bytes frame, std::string_view words) const {
  log_.write(LogLevel::info, log_source_, fmt::format("{} {}  {}", direction, hex_text(frame), words), LogPace::each);
}

}  // namespace axisgate::modbus_rtu
