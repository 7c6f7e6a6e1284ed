// SPDX-License-Identifier: Apache-2.0
#include "tests/stage/sim_link.hpp"

#include <utility>

namespace axisgate::test {

SimLink::SimLink(ManualRuntime& runtime, simulated::LineOptions options, std::uint64_t seed)
    : runtime_(runtime),
      origin_(runtime.now()),
      line_(options, simulated::Random(seed),
            [this](const simulated::ToHost& chunk) {
              if (plugged_ && wire_whole_) arrived_.insert(arrived_.end(), chunk.bytes.begin(), chunk.bytes.end());
            }),
      timer_(runtime.make_timer([this] { deliver(); })) {}

void SimLink::start(bus::ByteLinkEvents& events) {
  events_ = &events;
  arrived_.clear();
  timer_->expires_at(runtime_.now());
}

void SimLink::send(Bytes bytes) {
  if (!up_ || last_words.dead()) return;
  bytes = bytes.first(last_words.take(bytes.size()));
  sent.push_back({runtime_.now(), {bytes.begin(), bytes.end()}});
  fate = Fate::delivered;
  on_traffic(true, bytes);
  if (!wire_whole_) return arm();
  switch (fate) {
    case Fate::refused: {
      const auto answer = simulated::seal(bytes[0], simulated::FrameCommand::error,
                                          static_cast<std::uint16_t>(bytes[2] | bytes[3] << 8), bytes[4], 0x06090030);
      arrived_.insert(arrived_.end(), answer.begin(), answer.end());
      break;
    }
    case Fate::cut_before:
      unplug();
      return;
    case Fate::delivered:
    case Fate::cut_after:
      line_.from_host(bytes, time_of(runtime_.now()));
      break;
  }
  if (fate == Fate::cut_after) {
    line_.advance(time_of(runtime_.now()));
    unplug();
    return;
  }
  arm();
}

void SimLink::deliver() {
  advance_drives();
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

void SimLink::arm() {
  Instant next = kNever;
  if (!arrived_.empty() || plugged_ != up_) next = runtime_.now();
  if (const auto event = line_.next_event()) next = std::min(next, std::max(runtime_.now(), origin_ + *event));
  timer_->expires_at(next);
}

void SimLink::reopen(std::string_view why) {
  arrived_.clear();
  line_.cut();
  if (!up_) return;
  up_ = false;
  events_->on_link_down(why);
  arm();  // and up again with the next turn
}

void SimLink::unplug() {
  plugged_ = false;
  on_unplugged();
  arrived_.clear();
  line_.cut();
  timer_->expires_at(runtime_.now());
}

void SimLink::plug() {
  plugged_ = true;
  timer_->expires_at(runtime_.now());
}

void SimLink::cut_wire() {
  wire_whole_ = false;
  line_.cut();
}

void SimLink::restart(std::size_t drive) {
  advance_drives();
  line_.restart(drive, time_of(runtime_.now()));
  timer_->expires_at(runtime_.now());  // what it says when it is back was not foreseen
}

void SimLink::let_go() {
  events_ = nullptr;
  up_ = false;
  last_words.live();
  arrived_.clear();
}

}  // namespace axisgate::test
