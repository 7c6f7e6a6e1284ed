// SPDX-License-Identifier: Apache-2.0
#include "adapters/keya/keya_can_signs.hpp"

#include <utility>

namespace axisgate::keya {

using Kind = bus::UnsolicitedEvent::Kind;

void CanSigns::reset() { last_heartbeat_ = kLongAgo; }

CanSigns::News CanSigns::on_heartbeat(Bytes bytes, Instant now) {
  News news;
  if (!passes(heartbeats_, kHeartbeatId, now, news)) return news;
  news.bad = bytes.size() != kHeartbeatBytes;
  if (news.bad) return news;
  const Instant before = std::exchange(last_heartbeat_, now);
  if (before == kLongAgo || now - before > kHeartbeatSilence) {
    news.unsolicited_events.push_back({.kind = Kind::present, .node = node_, .state = bus::NodeState::operational});
  }
  news.unsolicited_events.push_back({.kind = Kind::values, .node = node_, .fields = heartbeat_fields(bytes)});
  return news;
}

CanSigns::News CanSigns::on_stray_reply(bool duplicate, Instant now) {
  News news;
  const bool passed = passes(stray_replies_, kReplyId, now, news);
  news.bad = false;  // whoever found it stray has counted it
  if (!passed || !duplicate || now < tell_duplicate_node_at_) return news;
  tell_duplicate_node_at_ = now + kTellDuplicateNodeAgain;
  news.unsolicited_events.push_back({.kind = Kind::duplicate_node, .node = node_});
  return news;
}

/// An unsolicited event holds half an id: the upper one, which says whether replies or heartbeats flood; the node
/// stands beside it.
bool CanSigns::passes(can::BabbleWatch& watch, std::uint32_t id, Instant now, News& news) const {
  const can::BabbleWatch::Verdict verdict = watch.on_frame(now);
  if (verdict.tell) {
    news.unsolicited_events.push_back(
        {.kind = Kind::babbling, .node = node_, .code = static_cast<std::uint16_t>(id >> 16)});
  }
  news.bad = !verdict.pass;
  return verdict.pass;
}

}  // namespace axisgate::keya
