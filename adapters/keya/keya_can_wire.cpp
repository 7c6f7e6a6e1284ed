// SPDX-License-Identifier: Apache-2.0
#include "adapters/keya/keya_can_wire.hpp"

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "adapters/can/can_line.hpp"
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
  [[nodiscard]] const bus::Statistics& statistics() const override { return line_.statistics(); }
  [[nodiscard]] std::optional<std::uint64_t> bits_carried() const override { return line_.bits(); }
  void set_decode(bool on) override { line_.set_decode(on); }

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

  KeyaCanSettings settings_;
  Runtime& runtime_;
  bus::WireEvents* events_ = nullptr;
  std::vector<Node> nodes_;
  CanClient client_;
  /// What was refused ends with the next turn of the loop, never inside send().
  std::optional<bus::ExchangeResult> owed_;
  // Last, so that they go first: neither may call into a wire that is half gone.
  std::unique_ptr<Timer> timer_;
  can::CanLine line_;
};

KeyaCanWire::KeyaCanWire(KeyaCanSettings settings, std::unique_ptr<can::CanLink> link, Runtime& runtime, const Log& log)
    : settings_(std::move(settings)),
      runtime_(runtime),
      client_(settings_.timeout),
      timer_(runtime.make_timer([this] { end_refused(); })),
      line_(settings_.name, std::move(link), log, describe) {
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
  line_.start(*this, filters_for(settings_.nodes));
}

// --- What we send ---------------------------------------------------------------------------------------------------

void KeyaCanWire::send(const bus::Exchange& exchange) {
  assert(line_.up() && !owed_ && exchange.node != 0);
  owed_ = refusal_of(exchange);
  if (owed_) {
    timer_->expires_at(runtime_.now());
    return;
  }
  line_.send(request_frame(exchange.node, client_.begin(exchange)));
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
  line_.on_up();
  client_.reset();
  for (Node& node : nodes_) node.signs.reset();
  events_->on_wire_up();
}

void KeyaCanWire::on_link_down(std::string_view why) {
  if (!line_.on_down()) return;
  client_.reset();
  owed_.reset();
  events_->on_wire_down(why);
}

void KeyaCanWire::on_frame(const can::CanFrame& frame, Instant received) {
  line_.count(frame);
  const auto origin = origin_of(frame);
  Node* node = line_.up() && origin ? find(origin->node) : nullptr;
  // A drive nobody configured, another protocol on the same cable: not ours to judge.
  if (node == nullptr) return;
  const Instant now = std::min(received, runtime_.now());
  if (origin->kind == CanOrigin::Kind::reply) return on_reply_frame(*node, frame, now);
  const CanSigns::News news = node->signs.on_heartbeat(frame.bytes(), now);
  line_.tell(frame, news.bad ? "  (bad)" : "");
  tell(news);
}

void KeyaCanWire::on_reply_frame(Node& node, const can::CanFrame& frame, Instant now) {
  using What = CanClient::Heard::What;
  const CanClient::Heard heard = client_.take(node.number, frame.bytes(), now);
  switch (heard.what) {
    case What::bad:
      line_.tell(frame, "  (bad)");
      line_.count_bad_frame();
      tell(node.signs.on_stray_reply(false, now));
      return;
    case What::late:
    case What::second_reply:
      line_.tell(frame, "  (late)");
      line_.count_late_reply();
      tell(node.signs.on_stray_reply(heard.what == What::second_reply, now));
      return;
    case What::mine:
      line_.tell(frame);
      // Last: the bus may send its next request from inside this call.
      events_->on_reply(heard.result);
      return;
  }
}

/// Last in whatever calls it: the bus may send from inside.
void KeyaCanWire::tell(const CanSigns::News& news) {
  if (news.bad) line_.count_bad_frame();
  for (const bus::UnsolicitedEvent& unsolicited : news.unsolicited_events) events_->on_unsolicited(unsolicited);
}

}  // namespace

std::unique_ptr<bus::Wire> make_keya_can_wire(KeyaCanSettings settings, std::unique_ptr<can::CanLink> link,
                                              Runtime& runtime, const Log& log) {
  return std::make_unique<KeyaCanWire>(std::move(settings), std::move(link), runtime, log);
}

}  // namespace axisgate::keya
