// SPDX-License-Identifier: Apache-2.0
#include "tests/stage/rtu_link_sim.hpp"

#include <utility>

namespace axisgate::test {
namespace {

/// Bytes of the frame that begins like this, CRC included; nothing: more must come to tell.
std::optional<std::size_t> frame_size(Bytes begun) {
  if (begun.size() < 2) return std::nullopt;
  switch (begun[1]) {
    case simulated::function::write_one:
    case simulated::function::write_several:
      return 8;
    case simulated::function::read:
      if (begun.size() < 3) return std::nullopt;
      return std::size_t{5} + begun[2];
    default:
      return 5;  // an error reply: one byte of data
  }
}

}  // namespace

RtuLinkSim::RtuLinkSim(ManualRuntime& runtime, simulated::RtuLineOptions options, std::uint64_t seed)
    : runtime_(runtime),
      origin_(runtime.now()),
      line_(options, simulated::Random(seed),
            [this](const simulated::ToHost& chunk) {
              if (plugged_ && wire_whole_)
                arrived_.push_back({chunk.at, newest_, {chunk.bytes.begin(), chunk.bytes.end()}});
            }),
      timer_(runtime.make_timer([this] { deliver(); })) {}

void RtuLinkSim::start(modbus_rtu::RtuLinkEvents& events) {
  events_ = &events;
  arrived_.clear();
  timer_->expires_at(runtime_.now());
}

std::vector<Byte> RtuLinkSim::error_reply(Bytes whole) {
  const Bytes pdu = whole.subspan(1, whole.size() - 3);
  for (std::size_t i = 0; i < line_.size(); ++i) {
    if (line_.slave(i).unit() == whole[0]) {
      return simulated::seal_rtu(whole[0], line_.slave(i).refusal(pdu, simulated::RtuException::value));
    }
  }
  return {};
}

void RtuLinkSim::transmit(modbus_rtu::ExchangeNumber number, Bytes frame) {
  if (!up_ || last_words.dead()) return;
  advance_drives();  // what came until now was heard before
  newest_ = number;
  std::vector<Byte> whole = simulated::seal_rtu(frame[0], frame.subspan(1));
  whole.resize(last_words.take(whole.size()));
  sent.push_back({runtime_.now(), number, whole});
  fate = Fate::delivered;
  on_traffic(true, whole);
  if (!wire_whole_) return arm();
  switch (fate) {
    case Fate::refused:
      arrived_.push_back({time_of(runtime_.now()), number, error_reply(whole)});
      break;
    case Fate::cut_before:
      unplug();
      return;
    case Fate::cut_after:
      cut_when_heard_ = line_.journal().recorded() + 1;
      line_.from_host(whole, time_of(runtime_.now()));
      break;
    case Fate::delivered:
      line_.from_host(whole, time_of(runtime_.now()));
      break;
  }
  arm();
}

void RtuLinkSim::deliver() {
  advance_drives();
  if (cut_when_heard_ && line_.journal().recorded() >= *cut_when_heard_) unplug();
  if (events_ == nullptr || last_words.dead()) return;
  if (reopening_ && up_) {
    up_ = false;
    events_->on_link_down(*reopening_);
  } else if (plugged_ != up_) {
    up_ = plugged_;
    if (up_)
      events_->on_link_up();
    else
      events_->on_link_down("unplugged");
  }
  reopening_.reset();
  for (const Chunk& chunk : std::exchange(arrived_, {})) {
    if (!up_ || !plugged_) break;  // a reply may have made somebody pull the cable
    on_traffic(false, chunk.bytes);
    take(chunk);
  }
  if (time_of(runtime_.now()) >= silence_at()) {
    noisy_ = false;
    if (!begun_.empty()) bad(std::exchange(begun_, {}).size());
  }
  arm();
}

void RtuLinkSim::take(const Chunk& chunk) {
  const simulated::Time begins = chunk.at - line_.on_wire(chunk.bytes.size());
  if (begins >= silence_at()) {
    noisy_ = false;
    if (!begun_.empty()) bad(std::exchange(begun_, {}).size());
  }
  heard_until_ = chunk.at;
  if (noisy_) {
    bad(chunk.bytes.size());
    return;
  }
  begun_.insert(begun_.end(), chunk.bytes.begin(), chunk.bytes.end());
  take_frames(chunk.newest);
}

void RtuLinkSim::take_frames(modbus_rtu::ExchangeNumber newest) {
  for (auto size = frame_size(begun_); size && *size <= begun_.size(); size = frame_size(begun_)) {
    const std::vector<Byte> frame(begun_.begin(), begun_.begin() + static_cast<std::ptrdiff_t>(*size));
    if (!simulated::open_rtu(frame)) {
      noisy_ = true;
      bad(std::exchange(begun_, {}).size());
      return;
    }
    begun_.erase(begun_.begin(), begun_.begin() + static_cast<std::ptrdiff_t>(*size));
    events_->on_frame(newest, Bytes(frame).first(*size - 2));
  }
}

void RtuLinkSim::bad(std::size_t bytes) { events_->on_bad_frame(newest_, bytes); }

void RtuLinkSim::arm() {
  Instant next = kNever;
  if (!arrived_.empty() || plugged_ != up_ || reopening_) next = runtime_.now();
  const auto consider = [&](simulated::Time at) { next = std::min(next, std::max(runtime_.now(), origin_ + at)); };
  if (const auto event = line_.next_event()) consider(*event);
  if (!begun_.empty()) consider(silence_at());
  timer_->expires_at(next);
}

void RtuLinkSim::forget_heard() {
  arrived_.clear();
  begun_.clear();
  noisy_ = false;
  cut_when_heard_.reset();
}

void RtuLinkSim::forget() {
  forget_heard();
  line_.cut();
}

void RtuLinkSim::reopen(std::string_view why) {
  forget();
  reopening_ = why;
  timer_->expires_at(runtime_.now());
}

void RtuLinkSim::unplug() {
  plugged_ = false;
  on_unplugged();
  forget();
  timer_->expires_at(runtime_.now());
}

void RtuLinkSim::plug() {
  plugged_ = true;
  timer_->expires_at(runtime_.now());
}

void RtuLinkSim::cut_wire() {
  wire_whole_ = false;
  line_.cut();
}

void RtuLinkSim::restart(std::size_t drive) {
  advance_drives();
  line_.restart(drive, time_of(runtime_.now()));
  timer_->expires_at(runtime_.now());  // what it says when it is back was not foreseen
}

void RtuLinkSim::let_go() {
  events_ = nullptr;
  last_words.live();
  up_ = false;
  newest_ = 0;
  reopening_.reset();
  forget_heard();
}

}  // namespace axisgate::test
