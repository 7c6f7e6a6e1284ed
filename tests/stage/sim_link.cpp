#include "tests/stage/sim_link.hpp"

#include <utility>

namespace axisgate::test {

SimLink::SimLink(ManualRuntime& runtime, simulated::LineOptions options, std::uint64_t seed)
    : runtime_(runtime),
      origin_(runtime.now()),
      line_(options, simulated::Random(seed),
            [this](const simulated::ToHost& chunk) {
              if (plugged_) arrived_.insert(arrived_.end(), chunk.bytes.begin(), chunk.bytes.end());
            }),
      timer_(runtime.make_timer([this] { deliver(); })) {}

void SimLink::start(bus::ByteLinkEvents& events) {
  events_ = &events;
  timer_->expires_at(runtime_.now());
}

void SimLink::send(Bytes bytes) {
  if (!up_) return;
  sent.push_back({runtime_.now(), {bytes.begin(), bytes.end()}});
  on_traffic(true, bytes);
  line_.from_host(bytes, time_of(runtime_.now()));
  arm();
}

void SimLink::deliver() {
  advance_drives();
  if (events_ == nullptr) return;
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

void SimLink::reopen(std::string_view) {
  arrived_.clear();
  line_.cut();
  arm();
}

void SimLink::unplug() {
  plugged_ = false;
  arrived_.clear();
  line_.cut();
  timer_->expires_at(runtime_.now());
}

void SimLink::plug() {
  plugged_ = true;
  timer_->expires_at(runtime_.now());
}

}  // namespace axisgate::test
