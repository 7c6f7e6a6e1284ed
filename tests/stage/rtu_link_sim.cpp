// SPDX-License-Identifier: Apache-2.0
#include "tests/stage/rtu_link_sim.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::test {
RtuLinkSim::RtuLinkSim(ManualRuntime& runtime, const simulated::RtuLineOptions& options, std::uint64_t seed)
    : SerialCable(runtime, line_), line_(options, simulated::Random(seed), sink()) {}

void RtuLinkSim::start(modbus_rtu::RtuLinkEvents& events) {
  events_ = &events;
  arrived_.clear();
  wake();
}

void RtuLinkSim::hear(simulated::Time at, std::vector<Byte> bytes) {
  arrived_.push_back({at, newest_, std::move(bytes)});
}

std::vector<Byte> RtuLinkSim::refusal(Bytes request) {
  const Bytes pdu = request.subspan(1, request.size() - 3);
  for (std::size_t i = 0; i < line_.size(); ++i) {
    if (line_.slave(i).unit() == request[0]) {
      return simulated::seal_rtu(request[0], line_.slave(i).refusal(pdu, simulated::RtuException::value));
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
  finder_.sent(whole);
  sent.push_back({runtime_.now(), number, whole});
  carry(whole);
}

bool RtuLinkSim::deliver() {
  if (events_ == nullptr) return false;
  if (reopening_ && up_) {
    up_ = false;
    events_->on_link_down(*reopening_);
  } else {
    tell_plugged(*events_);
  }
  reopening_.reset();
  for (const Chunk& chunk : std::exchange(arrived_, {})) {
    if (!up_ || !plugged()) break;  // a reply may have made somebody pull the cable
    on_traffic(false, chunk.bytes);
    take(chunk);
  }
  if (now() >= silence_at()) hear_silence();
  return true;
}

void RtuLinkSim::hear_silence() {
  noisy_ = false;
  take_frames(newest_, true);
  noisy_ = false;
}

void RtuLinkSim::take(const Chunk& chunk) {
  if (chunk.at - line_.on_wire(chunk.bytes.size()) >= silence_at()) hear_silence();
  heard_until_ = chunk.at;
  if (noisy_) {
    bad(chunk.bytes.size());
    return;
  }
  for (Bytes rest(chunk.bytes); !rest.empty() && !noisy_;) {
    const std::size_t fits = std::min(rest.size(), finder_.room());
    finder_.take(rest.first(fits));
    rest = rest.subspan(fits);
    take_frames(chunk.newest, false);
    if (noisy_ && !rest.empty()) bad(rest.size());
  }
}

void RtuLinkSim::take_frames(modbus_rtu::ExchangeNumber newest, bool silence) {
  using Kind = modbus_rtu::FrameFinder::Found::Kind;
  while (!noisy_) {
    const auto found = finder_.next(silence);
    const std::vector<Byte> bytes(found.bytes.begin(), found.bytes.end());
    const bool spoilt = found.kind == Kind::frame && !simulated::open_rtu(bytes);
    if (found.kind == Kind::nothing) return;
    if (found.kind == Kind::glitch) {
      events_->on_glitch(bytes.size());
    } else if (spoilt || found.kind == Kind::noise) {
      noisy_ = true;
      bad(bytes.size() + finder_.drop());
    } else {
      events_->on_frame(newest, Bytes(bytes).first(bytes.size() - 2));
    }
  }
}

void RtuLinkSim::bad(std::size_t bytes) { events_->on_bad_frame(newest_, bytes); }

Instant RtuLinkSim::due() const {
  if (!arrived_.empty() || reopening_) return runtime_.now();
  return !finder_.unfinished() ? kNever : at_time(silence_at());
}

void RtuLinkSim::forget() {
  arrived_.clear();
  finder_ = {};
  noisy_ = false;
}

void RtuLinkSim::reopen(std::string_view why) {
  forget_heard();
  line_.cut();
  reopening_ = why;
  wake();
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
