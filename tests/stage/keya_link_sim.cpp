// SPDX-License-Identifier: Apache-2.0
#include "tests/stage/keya_link_sim.hpp"

#include <utility>

namespace axisgate::test {

KeyaLinkSim::KeyaLinkSim(ManualRuntime& runtime, simulated::KeyaLineOptions options, std::uint64_t seed)
    : runtime_(runtime),
      origin_(runtime.now()),
      line_(options, simulated::Random(seed),
            [this](const simulated::ToHost& chunk) {
              if (plugged_ && wire_whole_) arrived_.insert(arrived_.end(), chunk.bytes.begin(), chunk.bytes.end());
            }),
      timer_(runtime.make_timer([this] { deliver(); })) {}

void KeyaLinkSim::start(bus::ByteLinkEvents& events) {
  events_ = &events;
  arrived_.clear();
  timer_->expires_at(runtime_.now());
}

void KeyaLinkSim::send(Bytes bytes) {
  if (!up_ || last_words.dead()) return;
  advance_drives();  // what came until now was heard before
  bytes = bytes.first(last_words.take(bytes.size()));
  sent.push_back({runtime_.now(), {bytes.begin(), bytes.end()}});
  fate = Fate::delivered;
  on_traffic(true, bytes);
  if (!wire_whole_) return arm();
  if (fate == Fate::cut_before) {
    unplug();
    return;
  }
  if (fate == Fate::cut_after) cut_when_heard_ = line_.requests_heard() + 1;
  line_.from_host(bytes, time_of(runtime_.now()));
  arm();
}

void KeyaLinkSim::deliver() {
  advance_drives();
  if (cut_when_heard_ && line_.requests_heard() >= *cut_when_heard_) unplug();
  if (events_ == nullptr || last_words.dead()) return;
  if (plugged_ != up_) {
    up_ = plugged_;
    if (up_)
      events_->on_link_up();
    else
      events_->on_link_down("unplugged");
  }
  if (up_ && !arrived_.empty()) {
    const std::vector<Byte> bytes = std::exchange(arrived_, {});
    on_traffic(false, bytes);
    events_->on_bytes(bytes);
  }
  arm();
}

void KeyaLinkSim::arm() {
  Instant next = kNever;
  const bool cuts = cut_when_heard_ && line_.requests_heard() >= *cut_when_heard_;
  if (!arrived_.empty() || plugged_ != up_ || cuts) next = runtime_.now();
  if (const auto event = line_.next_event()) next = std::min(next, std::max(runtime_.now(), origin_ + *event));
  timer_->expires_at(next);
}

void KeyaLinkSim::reopen(std::string_view why) {
  arrived_.clear();
  line_.cut();
  if (!up_) return;
  up_ = false;
  events_->on_link_down(why);
  arm();  // and up again with the next turn
}

void KeyaLinkSim::unplug() {
  plugged_ = false;
  on_unplugged();
  arrived_.clear();
  cut_when_heard_.reset();
  line_.cut();
  timer_->expires_at(runtime_.now());
}

void KeyaLinkSim::plug() {
  plugged_ = true;
  timer_->expires_at(runtime_.now());
}

void KeyaLinkSim::cut_wire() {
  wire_whole_ = false;
  line_.cut();
}

void KeyaLinkSim::restart(std::size_t drive) {
  advance_drives();
  line_.restart(drive, time_of(runtime_.now()));
  timer_->expires_at(runtime_.now());  // what it says when it is back was not foreseen
}

void KeyaLinkSim::let_go() {
  events_ = nullptr;
  last_words.live();
  up_ = false;
  arrived_.clear();
  cut_when_heard_.reset();
}

}  // namespace axisgate::test
