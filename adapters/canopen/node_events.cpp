// SPDX-License-Identifier: Apache-2.0
#include "adapters/canopen/node_events.hpp"

#include <algorithm>
#include <utility>

#include "adapters/canopen/process_data.hpp"

namespace axisgate::canopen {

using UnsolicitedKind = bus::UnsolicitedEvent::Kind;

NodeEvents::NodeEvents(const NodeWatch::Settings& settings)
    : node_(settings.node),
      watch_(settings),
      duplicates_(settings.heartbeat),
      process_data_{can::BabbleWatch(can::kMaxProcessDataPerSecond), can::BabbleWatch(can::kMaxProcessDataPerSecond),
                    can::BabbleWatch(can::kMaxProcessDataPerSecond), can::BabbleWatch(can::kMaxProcessDataPerSecond)} {}

bool NodeEvents::News::restarted() const {
  return std::ranges::any_of(unsolicited_events,
                             [](const bus::UnsolicitedEvent& n) { return n.kind == UnsolicitedKind::started; });
}

void NodeEvents::link_up(Instant now) {
  watch_.link_up(now);
  duplicates_.forget();
}

void NodeEvents::link_down() {
  watch_.link_down();
  duplicates_.forget();
  emergencies_ = {};
}

NodeEvents::News NodeEvents::on_frame(const CobId& id, Bytes bytes, Instant now) {
  News news;
  switch (id.service) {
    case Service::error_control:
      if (passes(error_control_, error_control_id(node_), now, news)) {
        on_error_control(bytes, now, news);
      } else {
        watch_.on_flood(now);
      }
      break;
    case Service::emergency:
      if (passes(emergency_, emergency_id(node_), now, news)) on_emergency(bytes, now, news);
      break;
    case Service::tpdo:
      if (passes(process_data_.at(id.number - 1U), tpdo_id(id.number, node_), now, news)) {
        on_process_data(id.number, bytes, news);
      }
      break;
    default:
      break;  // of another master: no fault of ours, and nothing the node said
  }
  return news;
}

NodeEvents::News NodeEvents::on_stray_reply(bool duplicate, Instant now) {
  News news;
  if (passes(stray_replies_, sdo_reply_id(node_), now, news) && duplicate) tell_duplicate_node(now, news);
  news.bad = false;  // whoever found it stray has counted it
  return news;
}

bool NodeEvents::passes(can::BabbleWatch& watch, std::uint32_t id, Instant now, News& news) {
  const can::BabbleWatch::Verdict verdict = watch.on_frame(now);
  if (verdict.tell) {
    news.unsolicited_events.push_back(
        {.kind = UnsolicitedKind::babbling, .node = node_, .code = static_cast<std::uint16_t>(id)});
  }
  news.bad = !verdict.pass;
  return verdict.pass;
}

void NodeEvents::on_error_control(Bytes bytes, Instant now, News& news) {
  const auto heard = decode_error_control(bytes);
  const auto told = heard ? watch_.on_error_control(*heard, now) : std::nullopt;
  news.bad = !told;
  if (!told) return;
  news.unsolicited_events.insert(news.unsolicited_events.end(), told->begin(), told->end());
  if (heard->boot_up) {
    maps_ = {};  // what its process data carry now is not what it was told
    duplicates_.on_boot_up(now);
  } else if (duplicates_.on_heartbeat(heard->state, now)) {
    tell_duplicate_node(now, news);
  }
}

void NodeEvents::on_emergency(Bytes bytes, Instant now, News& news) {
  const auto emergency = decode_emergency(node_, bytes);
  news.bad = !emergency;
  if (!emergency) return;
  if (const auto told = emergencies_.pass(*emergency, now)) news.unsolicited_events.push_back(*told);
}

void NodeEvents::on_process_data(std::uint8_t number, Bytes bytes, News& news) {
  const bus::ProcessMap& map = maps_.at(number - 1U);
  if (map.empty()) return;
  const auto fields = decode_process_data(map, bytes);
  news.bad = !fields;
  if (fields) news.unsolicited_events.push_back({.kind = UnsolicitedKind::values, .node = node_, .fields = *fields});
}

void NodeEvents::tell_duplicate_node(Instant now, News& news) {
  if (now < tell_duplicate_node_at_) return;
  tell_duplicate_node_at_ = now + kTellDuplicateNodeAgain;
  news.unsolicited_events.push_back({.kind = UnsolicitedKind::duplicate_node, .node = node_});
}

NodeEvents::News NodeEvents::on_deadline(Instant now) {
  News news;
  if (const auto held = emergencies_.take_held(now)) news.unsolicited_events.push_back(*held);
  const NodeWatch::Due due = watch_.on_deadline(now);
  news.guard = due.guard;
  if (due.gone) {
    duplicates_.forget();
    news.unsolicited_events.push_back({.kind = UnsolicitedKind::gone, .node = node_});
  }
  return news;
}

Instant NodeEvents::next_deadline() const { return std::min(watch_.next_deadline(), emergencies_.next_deadline()); }

}  // namespace axisgate::canopen
