// SPDX-License-Identifier: Apache-2.0
#include "adapters/canopen/canopen_wire.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bitset>
#include <cassert>
#include <optional>
#include <utility>

#include "adapters/can/can_line.hpp"
#include "adapters/canopen/canopen_text.hpp"
#include "adapters/canopen/heartbeat_plan.hpp"
#include "adapters/canopen/nmt.hpp"
#include "adapters/canopen/node_events.hpp"
#include "adapters/canopen/sdo_client.hpp"

namespace axisgate::canopen {

namespace {

/// A timer that comes so late has been kept waiting by the loop; so have frames that may say that all is well.
constexpr Duration kStalled = std::chrono::milliseconds(20);

class CanopenWire final : public bus::Wire, private can::CanLinkEvents {
 public:
  CanopenWire(CanopenSettings settings, std::unique_ptr<can::CanLink> link, Runtime& runtime, const Log& log);

  void start(bus::WireEvents& events) override;
  void send(const bus::Exchange& exchange) override;
  void abandon() override;
  void map_process_data(std::uint8_t node, std::uint8_t number, const bus::ProcessMap& objects) override;
  [[nodiscard]] bool call(std::uint8_t node) override;
  [[nodiscard]] const bus::Statistics& statistics() const override { return line_.statistics(); }
  [[nodiscard]] std::optional<std::uint64_t> bits_carried() const override { return line_.bits(); }
  void set_decode(bool on) override { line_.set_decode(on); }

 private:
  /// A drive that answers another object than it is asked is told so often at most.
  static constexpr Duration kTellInsteadAgain = std::chrono::minutes(1);
  struct Node {
    std::uint8_t number = 0;
    NodeEvents events;
    Instant tell_instead_at = kLongAgo;
    std::uint32_t instead_untold = 0;
  };

  void on_link_up() override;
  void on_link_down(std::string_view why) override;
  void on_frame(const can::CanFrame& frame, Instant received) override;

  void on_timer();
  void arm();
  void send_command(const bus::Exchange& exchange);
  void send_step(std::uint8_t node, const SdoStep& step);
  void send_heartbeat(Instant now);
  void transmit(std::uint8_t node, const SdoFrames& frames);
  void on_reply_frame(Node& node, Bytes bytes, Instant now);
  void tell(Node& node, const NodeEvents::News& news);
  void tell_instead(Node& node, const SdoClient::Instead& instead);
  void meet_stranger(const CobId& id, Bytes bytes);
  void watch_nodes(Instant now);
  [[nodiscard]] Node* find(std::uint8_t number);

  CanopenSettings settings_;
  LogSource log_source_;
  const Log& log_;
  Runtime& runtime_;
  bus::WireEvents* events_ = nullptr;
  std::vector<Node> nodes_;
  std::bitset<kLastNode + 1> strangers_;  ///< nodes of no drive that were heard
  SdoClient sdo_;
  HeartbeatPlan heartbeat_;
  PeriodPlan sync_;
  bool tells_to_listen_ = false;  ///< the outstanding request sets a drive's time for our heartbeat
  /// What ends without an answer ends with the next turn of the loop, never inside send().
  std::optional<bus::ExchangeResult> owed_;
  Instant watch_again_ = kLongAgo;
  // Last, so that they go first: neither may call into a wire that is half gone.
  std::unique_ptr<Timer> timer_;
  can::CanLine line_;
};

CanopenWire::CanopenWire(CanopenSettings settings, std::unique_ptr<can::CanLink> link, Runtime& runtime, const Log& log)
    : settings_(std::move(settings)),
      log_source_(bus_source(settings_.name)),
      log_(log),
      runtime_(runtime),
      sdo_(settings_.timeout),
      heartbeat_(settings_.own_heartbeat),
      sync_(settings_.sync),
      timer_(runtime.make_timer([this] { on_timer(); })),
      line_(settings_.name, std::move(link), log, describe) {
  nodes_.reserve(settings_.nodes.size());
  for (const CanopenNode& node : settings_.nodes) {
    assert(node.node >= kFirstNode && node.node <= kLastNode && find(node.node) == nullptr);
    nodes_.push_back({.number = node.node,
                      .events = NodeEvents({.node = node.node,
                                            .heartbeat = node.heartbeat,
                                            .guard_time = node.guard_time,
                                            .life_factor = node.life_factor})});
    if (node.sdo_block) sdo_.offer_block(node.node);
  }
}

CanopenWire::Node* CanopenWire::find(std::uint8_t number) {
  const auto found = std::ranges::find(nodes_, number, &Node::number);
  return found == nodes_.end() ? nullptr : &*found;
}

void CanopenWire::start(bus::WireEvents& events) {
  events_ = &events;
  std::vector<std::uint8_t> numbers;
  for (const Node& node : nodes_) numbers.push_back(node.number);
  line_.start(*this, filters_for(numbers));
}

// --- What we send ---------------------------------------------------------------------------------------------------

void CanopenWire::send(const bus::Exchange& exchange) {
  assert(line_.up() && !owed_ && !sdo_.outstanding_node() && exchange.node <= kLastNode);
  if (exchange.access == bus::Access::command) return send_command(exchange);
  assert(exchange.node >= kFirstNode);
  // A new heartbeat period is a new rhythm, not a second device.
  constexpr std::uint16_t kProducerHeartbeatTime = 0x1017;
  if (exchange.access == bus::Access::write && exchange.object.index == kProducerHeartbeatTime) {
    if (Node* node = find(exchange.node)) node->events.on_changed_by_us();
  }
  constexpr std::uint16_t kConsumerHeartbeatTime = 0x1016;
  tells_to_listen_ = exchange.access == bus::Access::write && exchange.object.index == kConsumerHeartbeatTime;
  send_step(exchange.node, sdo_.begin(exchange));
}

void CanopenWire::send_step(std::uint8_t node, const SdoStep& step) {
  transmit(node, step.frames);
  if (!step.over) return;
  owed_ = step.over;
  arm();
}

void CanopenWire::send_command(const bus::Exchange& exchange) {
  const auto command = nmt_command(exchange.raw);
  assert(command);
  for (Node& node : nodes_) {
    if (exchange.node != 0 && exchange.node != node.number) continue;
    transmit(node.number, sdo_.interrupt(node.number));
    node.events.on_changed_by_us();
  }
  line_.send(nmt_frame(*command, exchange.node), true);
  owed_ = bus::ExchangeResult{};
  arm();
}

void CanopenWire::abandon() {
  owed_.reset();
  const auto node = sdo_.outstanding_node();
  if (!node) return;
  const SdoClient::Abandoned abandoned = sdo_.abandon();
  if (line_.up()) transmit(*node, abandoned.frames);
  Node* found = find(*node);
  if (found != nullptr && abandoned.instead) tell_instead(*found, *abandoned.instead);
}

void CanopenWire::map_process_data(std::uint8_t node, std::uint8_t number, const bus::ProcessMap& objects) {
  assert(number >= 1 && number <= kTpdos);
  if (Node* found = find(node)) found->events.map(number, objects);
}

bool CanopenWire::call(std::uint8_t node) {
  Node* found = find(node);
  if (line_.up() && found != nullptr) {
    found->events.call();
    line_.send(guard_frame(node));
  }
  return true;
}

void CanopenWire::transmit(std::uint8_t node, const SdoFrames& frames) {
  for (const SdoFrame& frame : frames) line_.send(can::data_frame(sdo_request_id(node), frame));
}

void CanopenWire::send_heartbeat(Instant now) {
  for (const can::CanFrame& frame : heartbeat_.due(now, settings_.own_node)) line_.send(frame);
}

// --- What we hear ---------------------------------------------------------------------------------------------------

void CanopenWire::on_link_up() {
  const Instant now = runtime_.now();
  line_.on_up();
  sdo_.reset();
  for (Node& node : nodes_) node.events.link_up(now);
  heartbeat_.begin(now);
  sync_.begin(now);
  timer_->expires_at(now);  // our first heartbeat goes out before anything else is due
  events_->on_wire_up();
}

void CanopenWire::on_link_down(std::string_view why) {
  if (!line_.on_down()) return;
  sdo_.reset();
  owed_.reset();
  for (Node& node : nodes_) node.events.link_down();
  timer_->expires_at(kNever);
  events_->on_wire_down(why);
}

void CanopenWire::on_frame(const can::CanFrame& frame, Instant received) {
  line_.count(frame);
  const auto id = frame.extended || frame.remote ? std::nullopt : cob_id(frame.id);
  if (!line_.up() || !id) return;  // another master's guarding is not ours to judge
  Node* node = find(id->node);
  if (node == nullptr) {
    if (!strangers_.test(id->node)) meet_stranger(*id, frame.bytes());
    return;
  }
  const Instant now = std::min(received, runtime_.now());
  if (id->service == Service::sdo_reply) {
    line_.tell(frame);
    on_reply_frame(*node, frame.bytes(), now);
    return;
  }
  const NodeEvents::News news = node->events.on_frame(*id, frame.bytes(), now);
  line_.tell(frame, news.bad ? "  (bad)" : "");
  if (news.restarted()) sdo_.restarted(node->number);
  if (id->service != Service::tpdo) arm();
  tell(*node, news);
}

void CanopenWire::on_reply_frame(Node& node, Bytes bytes, Instant now) {
  const SdoClient::Heard heard = sdo_.take(node.number, bytes, now);
  switch (heard.what) {
    case SdoClient::Heard::What::bad:
      line_.count_bad_frame();
      tell(node, node.events.on_stray_reply(false, now));
      return;
    case SdoClient::Heard::What::late:
    case SdoClient::Heard::What::second_reply:
      line_.count_late_reply();
      tell(node, node.events.on_stray_reply(heard.what == SdoClient::Heard::What::second_reply, now));
      if (heard.acknowledges_write)
        events_->on_unsolicited({.kind = bus::UnsolicitedEvent::Kind::foreign_write, .node = node.number});
      return;
    case SdoClient::Heard::What::mine:
      transmit(node.number, heard.step.frames);
      // A consumer watches from the first heartbeat on (CiA 301 7.2.8.2.2): until then our death would go unnoticed.
      if (heard.step.over && std::exchange(tells_to_listen_, false)) {
        heartbeat_.begin(now);
        send_heartbeat(now);
        arm();
      }
      // Last: the bus may send its next request from inside this call.
      if (heard.step.over) events_->on_reply(*heard.step.over);
      return;
  }
}

/// Last in whatever calls it: the bus may send from inside.
void CanopenWire::tell(Node& node, const NodeEvents::News& news) {
  if (news.bad) line_.count_bad_frame();
  if (news.guard) line_.send(guard_frame(node.number));
  for (const bus::UnsolicitedEvent& unsolicited : news.unsolicited_events) events_->on_unsolicited(unsolicited);
}

void CanopenWire::tell_instead(Node& node, const SdoClient::Instead& instead) {
  const Instant now = runtime_.now();
  if (now < node.tell_instead_at) {
    ++node.instead_untold;
    return;
  }
  node.tell_instead_at = now + kTellInsteadAgain;
  std::string more;
  if (const std::uint32_t times = std::exchange(node.instead_untold, 0); times > 0)
    more = fmt::format(" ({} more like it were left out)", times);
  log_.write(LogLevel::warning, log_source_,
             fmt::format("node {} was asked for {} and answered {}: its answer is not taken{}", node.number,
                         object_text(instead.asked), object_text(instead.answered), more));
}

/// It may be a drive whose number is not the one in the configuration; it may as well be another master's.
void CanopenWire::meet_stranger(const CobId& id, Bytes bytes) {
  const bool lives = id.service == Service::error_control && decode_error_control(bytes);
  const bool complains = id.service == Service::emergency && bytes.size() == can::kMaxFrameBytes;
  if (!lives && !complains) return;
  strangers_.set(id.node);
  log_.write(LogLevel::info, log_source_,
             fmt::format("node {} is heard on this bus, and no drive of the configuration has this number", id.node));
  for (const Node& node : nodes_)
    events_->on_unsolicited({.kind = bus::UnsolicitedEvent::Kind::stranger, .node = node.number, .code = id.node});
}

void CanopenWire::on_timer() {
  if (!line_.up()) return;
  const Instant now = runtime_.now();
  send_heartbeat(now);
  if (sync_.due(now)) line_.send(can::data_frame(kSyncId, {}));
  watch_nodes(now);
  const auto owed = std::exchange(owed_, std::nullopt);
  arm();
  if (owed) events_->on_reply(*owed);
}

/// What the loop kept waiting gets one more turn to come in, before anybody is said to be gone.
void CanopenWire::watch_nodes(Instant now) {
  for (Node& node : nodes_) {
    const Instant due = node.events.next_deadline();
    if (due > now || !line_.up()) continue;
    if (now - due > kStalled && watch_again_ < due) {
      watch_again_ = now;
      return;
    }
    tell(node, node.events.on_deadline(now));
  }
}

void CanopenWire::arm() {
  if (!line_.up()) return;
  Instant next = owed_ ? runtime_.now() : std::min(heartbeat_.next_deadline(), sync_.next_deadline());
  for (const Node& node : nodes_) next = std::min(next, node.events.next_deadline());
  timer_->expires_at(next);
}

}  // namespace

std::unique_ptr<bus::Wire> make_canopen_wire(CanopenSettings settings, std::unique_ptr<can::CanLink> link,
                                             Runtime& runtime, const Log& log) {
  return std::make_unique<CanopenWire>(std::move(settings), std::move(link), runtime, log);
}

}  // namespace axisgate::canopen
