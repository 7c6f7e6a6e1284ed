// SPDX-License-Identifier: Apache-2.0
#include "tests/stage/can_link_sim.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::test {
namespace {

constexpr std::uint32_t kRefused = 0x06090030;

}  // namespace

can::CanFrame can_frame_of(const simulated::BusFrame& frame) {
  can::CanFrame made;
  made.id = frame.id;
  made.extended = frame.extended;
  made.remote = frame.remote;
  made.size = frame.size;
  if (!frame.remote) std::copy_n(frame.data.begin(), frame.size, made.data.begin());
  return made;
}

simulated::BusFrame bus_frame_of(const can::CanFrame& frame) {
  simulated::BusFrame made;
  made.id = frame.id;
  made.extended = frame.extended;
  made.remote = frame.remote;
  made.size = frame.size;
  if (!frame.remote) std::copy_n(frame.data.begin(), frame.size, made.data.begin());
  return made;
}

CanLinkSim::CanLinkSim(ManualRuntime& runtime, simulated::CanLineOptions options, std::uint64_t seed)
    : runtime_(runtime),
      origin_(runtime.now()),
      line_(options, simulated::Random(seed),
            [this](const simulated::CanToHost& frame) {
              const can::CanFrame made = can_frame_of(frame.frame);
              if (plugged_ && passes(made)) arrived_.push_back({frame.at, frame.tag, made});
            }),
      timer_(runtime.make_timer([this] { deliver(); })) {}

bool CanLinkSim::passes(const can::CanFrame& frame) const {
  return std::ranges::any_of(filters_, [&frame](const can::CanFilter& filter) { return filter.passes(frame); });
}

void CanLinkSim::start(can::CanLinkEvents& events, std::vector<can::CanFilter> filters) {
  events_ = &events;
  filters_ = std::move(filters);
  timer_->expires_at(runtime_.now());
}

void CanLinkSim::send(const can::CanFrame& frame, bool urgent) {
  if (!up_ || last_words.take(1) == 0) return;
  advance_drives();  // what came until now was heard before
  sent.push_back({runtime_.now(), frame, urgent});
  fate = Fate::delivered;
  on_traffic(true, frame);
  switch (fate) {
    case Fate::refused:
      refuse(frame);
      break;
    case Fate::cut_before:
      unplug();
      return;
    case Fate::cut_after:
      cut_when_heard_ = line_.requests_heard() + 1;
      line_.from_host(bus_frame_of(frame), time_of(runtime_.now()));
      break;
    case Fate::delivered:
      line_.from_host(bus_frame_of(frame), time_of(runtime_.now()));
      break;
  }
  arm();
}

void CanLinkSim::refuse(const can::CanFrame& frame) {
  using namespace simulated;
  if (frame.extended) return;  // Keya's protocol has no refusal: there is no answer
  const std::uint32_t node = frame.id - cob::sdo_request;
  CanBytes bytes{0x80, frame.data[1], frame.data[2], frame.data[3]};
  const CanBytes code = little_endian(kRefused, 4);
  bytes.insert(bytes.end(), code.begin(), code.end());
  arrived_.push_back({time_of(runtime_.now()), 0, can_frame_of(bus_frame(cob::sdo_reply + node, bytes))});
}

void CanLinkSim::deliver() {
  advance_drives();
  if (cut_when_heard_ && line_.requests_heard() >= *cut_when_heard_) unplug();
  if (events_ == nullptr || last_words.dead()) return;
  if (plugged_ != up_) {
    up_ = plugged_;
    if (up_) {
      if (std::exchange(was_up_, true)) ++trouble_.reconnects;
      events_->on_link_up();
    } else {
      events_->on_link_down(why_down_);
    }
  }
  for (const Arrived& frame : std::exchange(arrived_, {})) {
    if (!up_ || !plugged_) break;  // a reply may have made somebody pull the cable
    on_traffic(false, frame.frame);
    received.push_back({origin_ + frame.at, frame.tag, frame.frame});
    events_->on_frame(frame.frame, origin_ + frame.at);
  }
  arm();
}

void CanLinkSim::arm() {
  Instant next = kNever;
  if (!arrived_.empty() || plugged_ != up_) next = runtime_.now();
  if (const auto event = line_.next_event()) next = std::min(next, std::max(runtime_.now(), origin_ + *event));
  timer_->expires_at(next);
}

void CanLinkSim::go_down(std::string why) {
  plugged_ = false;
  why_down_ = std::move(why);
  on_unplugged();
  arrived_.clear();
  cut_when_heard_.reset();
  line_.set_bus_off(true);
  timer_->expires_at(runtime_.now());
}

void CanLinkSim::bus_off() {
  ++trouble_.bus_offs;
  ++trouble_.error_frames;
  go_down("can0 is bus-off");
}

void CanLinkSim::plug() {
  plugged_ = true;
  line_.set_bus_off(false);
  timer_->expires_at(runtime_.now());
}

void CanLinkSim::connect_drives(bool connected) {
  for (std::size_t d = 0; d < line_.size(); ++d) line_.connect(d, connected);
}

void CanLinkSim::restart(std::size_t drive) {
  advance_drives();
  line_.restart(drive, time_of(runtime_.now()));
  timer_->expires_at(runtime_.now());  // what it says when it is back was not foreseen
}

void CanLinkSim::let_go() {
  events_ = nullptr;
  last_words.live();
  up_ = false;
  was_up_ = false;
  filters_.clear();
  trouble_ = {};
  arrived_.clear();
  cut_when_heard_.reset();
}

}  // namespace axisgate::test
