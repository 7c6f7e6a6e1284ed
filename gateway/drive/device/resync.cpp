// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/resync.hpp"

#include <algorithm>

namespace axisgate::drive {
namespace {

std::uint8_t registers_of(std::uint8_t bytes) { return bytes > 2 ? 2 : 1; }

// A reply names what was asked for; which of the values in it was meant (Keya: by their bytes) it does not tell.
ObjectAddress named_by_reply(ObjectAddress object) {
  object.byte = 0;
  return object;
}

}  // namespace

std::uint8_t registers_of(const bus::Exchange& exchange) {
  if (exchange.more.empty()) return registers_of(exchange.size);
  const bus::Neighbour& last = exchange.more.back();
  return static_cast<std::uint8_t>(last.object.index - exchange.object.index + registers_of(last.size));
}

Resync::Likeness Resync::of(const bus::Exchange& exchange) const {
  if (!facts_.by_length) return {named_by_reply(exchange.object), 0};
  // The reply to a write has a function code of its own: no read's reply is like it.
  return {{}, exchange.access == bus::Access::write ? std::uint8_t{0} : registers_of(exchange)};
}

Resync::Likeness Resync::of(const model::ResyncRead& read) const {
  const model::ObjectDef& object = objects_[read.object];
  if (!facts_.by_length) return {named_by_reply(object.address), 0};
  return {{}, read.registers != 0 ? read.registers : registers_of(object.size)};
}

void Resync::lost(const bus::Exchange& exchange, Instant now) {
  suspect_ = true;
  last_lost_ = now;
  const Likeness like = of(exchange);
  // Another read was lost meanwhile: its reply is as old as those that were counted out. A write's reply is no read's.
  if (counting_ && exchange.access != bus::Access::write && !(counting_->like == like)) counting_.reset();
  const auto known = std::ranges::find_if(lost_, [&](const Lost& lost) { return lost.like == like; });
  if (known != lost_.end())
    known->times = std::min(known->times + 1, kMaxOwed);
  else if (lost_.size() < kMaxLost)
    lost_.push_back({like});
}

void Resync::refused(const bus::Exchange& exchange, Instant now) {
  lost(exchange, now);
  const Likeness like = of(exchange);
  if (!is_refused(like) && refused_.size() < kMaxLost) refused_.push_back(like);
  counting_.reset();
}

int Resync::owed(const Likeness& like) const {
  const auto known = std::ranges::find_if(lost_, [&](const Lost& lost) { return lost.like == like; });
  return known == lost_.end() ? 0 : known->times;
}

bool Resync::is_refused(const Likeness& like) const { return std::ranges::find(refused_, like) != refused_.end(); }

std::optional<model::ResyncRead> Resync::candidate() const {
  std::optional<model::ResyncRead> unanswered;
  for (std::size_t i = 0; i < facts_.candidates.size(); ++i) {
    const model::ResyncRead& read = facts_.candidates[i];
    if (owed(of(read)) != 0 || is_refused(of(read))) continue;
    if (!unanswered_.contains(i)) return read;
    if (!unanswered) unanswered = read;
  }
  return unanswered;
}

void Resync::resync_sent(const model::ResyncRead& read) {
  ++resyncs_;
  const auto same = [&](const auto& r) { return r.object == read.object && r.registers == read.registers; };
  const auto at = std::ranges::find_if(facts_.candidates, same) - facts_.candidates.begin();
  if (sent_.size() < sent_.capacity()) sent_.push_back(static_cast<std::size_t>(at));
}

void Resync::answered() {
  if (!sent_.empty()) {
    unanswered_.insert(sent_.begin(), sent_.end());
    unanswered_.erase(sent_.back());
  }
  forget();
}

void Resync::forget() {
  suspect_ = false;
  lost_.clear();
  refused_.clear();
  counting_.reset();
  sent_.clear();
  resyncs_ = 0;
}

bool Resync::counts_out() const {
  if (!facts_.by_length) return false;
  if (candidate()) return true;
  std::optional<Likeness> one;
  for (const model::ResyncRead& read : facts_.candidates) {
    const Likeness like = of(read);
    if (is_refused(like)) continue;
    if (one && !(*one == like)) return true;
    one = like;
  }
  return false;
}

model::ResyncRead Resync::counted() {
  const model::ResyncRead* least = nullptr;
  for (const model::ResyncRead& read : facts_.candidates) {
    const Likeness like = of(read);
    if (counting_ && counting_->like == like) return read;
    if (is_refused(like)) continue;
    if (least == nullptr || owed(like) < owed(of(*least))) least = &read;
  }
  counting_ = {of(*least), owed(of(*least)) + 1};
  return *least;
}

// What is still owed then is of the counted length alone: a reply to each counted read may have been an older one.
void Resync::counted_one() {
  if (!counting_ || --counting_->left > 0) return;
  const Lost still{counting_->like, std::max(owed(counting_->like), 1)};
  lost_.clear();
  lost_.push_back(still);
  counting_.reset();
}

}  // namespace axisgate::drive
