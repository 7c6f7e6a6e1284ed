// SPDX-License-Identifier: Apache-2.0
#include "adapters/keya/keya_can_wire.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "adapters/can/frame_bits.hpp"
#include "adapters/keya/keya_can_client.hpp"
#include "adapters/keya/keya_can_signs.hpp"
#include "adapters/keya/keya_text.hpp"

namespace axisgate::keya {

namespace {

class KeyaCanWire final : public bus::Wire, private can::CanLinkEvents {
 public:
  KeyaCanWire(KeyaCanSettings settings, std::unique_ptr<can::CanLink> link, Runtime& runtime, const Log& log);

  void start(bus::WireEvents& events) override;
  void send(const bus::Exchange& exchange) override;
  void abandon() override;
  [[nodiscard]] const bus::Statistics& statistics() const override;
  [[nodiscard]] std::optional<std::uint64_t> bits_carried() const override { return bits_; }
  void set_decode(bool on) override { decode_ = on; }

 private:
  struct Node {
    std::uint8_t number = 0;
    CanSigns signs;
  };

  void on_link_up() override;
  void on_link_down(std::string_view why) override;
  void on_frame(const can::CanFrame& frame, Instant received) override;

  void end_refused();
  void on_reply_frame(Node& node, const can::CanFrame& frame, Instant now);
  void tell(const CanSigns::News& news);
  [[nodiscard]] Node* find(std::uint8_t number);
  void log_frame(std::string_view direction, const can::CanFrame& frame, std::string_view remark = "") const;

  KeyaCanSettings settings_;
  std::string log_source_;
  Runtime& runtime_;
  const Log& log_;
  bus::WireEvents* events_ = nullptr;
  std::vector<Node> nodes_;
  CanClient client_;
  /// What was refused ends with the next turn of the loop, never inside send().
  std::optional<bus::ExchangeResult> owed_;
  bool decode_ = false;
  bool up_ = false;
  bool ever_up_ = false;
  mutable bus::Statistics statistics_;
  std::uint64_t bits_ = 0;  ///< of all frames, sent and heard
  // Last, so that they go first: neither may call into a wire that is half gone.
  std::unique_ptr<Timer> timer_;
  std::unique_ptr<can::CanLink> link_;
};

KeyaCanWire::KeyaCanWire(KeyaCanSettings settings, std::unique_ptr<can::CanLink> link, Runtime& runtime, const Log& log)
    : settings_(std::move(settings)),
      log_source_("bus " + settings_.name),
      runtime_(runtime),
      log_(log),
      client_(settings_.timeout),
      timer_(runtime.make_timer([this] { end_refused(); })),
      link_(std::move(link)) {
  assert(link_ != nullptr);
  nodes_.reserve(settings_.nodes.size());
  for (const std::uint8_t number : settings_.nodes) {
    assert(number != 0 && find(number) == nullptr);
    nodes_.push_back({.number = number, .signs = CanSigns(number)});
  }
}

KeyaCanWire::Node* KeyaCanWire::find(std::uint8_t number) {
  const auto found = std::ranges::find(nodes_, number, &Node::number);
  return found == nodes_.end() ? nullptr : &*found;
}

void KeyaCanWire::start(bus::WireEvents& events) {
  events_ = &events;
  link_->start(*this, filters_for(settings_.nodes));
}

const bus::Statistics& KeyaCanWire::statistics() const {
  const can::CanTrouble& trouble = link_->trouble();
  statistics_.dropped_bytes = trouble.lost_in + trouble.bad_bytes;
  return statistics_;
}

// --- What we send ---------------------------------------------------------------------------------------------------

void KeyaCanWire::send(const bus::Exchange& exchange) {
  assert(up_ && !owed_ && exchange.node != 0);
  owed_ = refusal_of(exchange);
  if (owed_) {
    timer_->expires_at(runtime_.now());
    return;
  }
  const can::CanFrame frame = request_frame(exchange.node, client_.begin(exchange));
  log_frame("->", frame);
  bits_ += static_cast<std::uint64_t>(can::bits_on_wire(frame));
  link_->send(frame);
}

void KeyaCanWire::end_refused() {
  // Last: the bus may send its next request from inside this call.
  if (const auto owed = std::exchange(owed_, std::nullopt)) events_->on_reply(*owed);
}

void KeyaCanWire::abandon() {
  owed_.reset();
  client_.abandon();
}

// --- What we hear ---------------------------------------------------------------------------------------------------

void KeyaCanWire::on_link_up() {
  up_ = true;
  client_.reset();
  for (Node& node : nodes_) node.signs.reset();
  if (std::exchange(ever_up_, true)) ++statistics_.reconnects;
  events_->on_wire_up();
}

void KeyaCanWire::on_link_down(std::string_view why) {
  if (!std::exchange(up_, false)) return;
  client_.reset();
  owed_.reset();
  events_->on_wire_down(why);
}

void KeyaCanWire::on_frame(const can::CanFrame& frame, Instant received) {
  bits_ += static_cast<std::uint64_t>(can::bits_on_wire(frame));
  const auto origin = origin_of(frame);
  Node* node = up_ && origin ? find(origin->node) : nullptr;
  // A drive nobody configured, another protocol on the same cable: not ours to judge.
  if (node == nullptr) return;
  const Instant now = std::min(received, runtime_.now());
  if (origin->kind == CanOrigin::Kind::reply) return on_reply_frame(*node, frame, now);
  const CanSigns::News news = node->signs.on_heartbeat(frame.bytes(), now);
  log_frame("<-", frame, news.bad ? "  (bad)" : "");
  tell(news);
}

void KeyaCanWire::on_reply_frame(Node& node, const can::CanFrame& frame, Instant now) {
  using What = CanClient::Heard::What;
  const CanClient::Heard heard = client_.take(node.number, frame.bytes(), now);
  switch (heard.what) {
    case What::bad:
      log_frame("<-", frame, "  (bad)");
      ++statistics_.bad_frames;
      tell(node.signs.on_stray_reply(false, now));
      return;
    case What::late:
    case What::second_reply:
      log_frame("<-", frame, "  (late)");
      ++statistics_.late_replies;
      tell(node.signs.on_stray_reply(heard.what == What::second_reply, now));
      return;
    case What::mine:
      log_frame("<-", frame);
      // Last: the bus may send its next request from inside this call.
      events_->on_reply(heard.result);
      return;
  }
}

/// Last in whatever calls it: the bus may send from inside.
void KeyaCanWire::tell(const CanSigns::News& news) {
  if (news.bad) ++statistics_.bad_frames;
  for (const bus::UnsolicitedEvent& unsolicited : news.unsolicited_events) events_->on_unsolicited(unsolicited);
}

void KeyaCanWire::log_frame(std::string_view direction, const can::CanFrame& frame, std::string_view remark) const {
  if (!decode_) return;
  const std::string content = frame.remote ? "remote" : hex_text(frame.bytes());
  log_.write(LogLevel::info, log_source_,
             fmt::format("{} {:08X} {}  {}{}", direction, frame.id, content, describe(frame), remark));
}

}  // namespace

std::unique_ptr<bus::Wire> make_keya_can_wire(KeyaCanSettings settings, std::unique_ptr<can::CanLink> link,
                                              Runtime& runtime, const Log& log) {
  return std::make_unique<KeyaCanWire>(std::move(settings), std::move(link), runtime, log);
}

}  // namespace axisgate::keya
