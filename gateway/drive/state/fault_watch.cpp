// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/state/fault_watch.hpp"

#include <algorithm>

namespace axisgate::drive {

CauseObjects cause_objects(const model::AxisModel& model) {
  CauseObjects out;
  const auto add = [&](model::ObjectId id) {
    const bool has = std::ranges::find(out, id) != out.end();
    if (id != model::kNoObject && !has && out.size() < out.capacity()) out.push_back(id);
  };
  for (const model::ObjectId word : model.fault_words) add(word);
  for (const Quantity quantity : {Quantity::error_code, Quantity::vendor_error})
    if (const model::Binding* binding = model.binding(quantity)) {
      add(binding->object);
      for (const model::BitField& field : binding->bits) add(field.object);
    }
  return out;
}

void FaultWatch::observe(const Seen& seen) {
  if (!seen.known) {
    // What is known begins anew; an emergency code may be all that a drive says while it comes up.
    const Emergency sent = emergency_;
    *this = {};
    emergency_ = sent;
    return;
  }
  seen_ = seen.at;
  if (seen.faulted && !fault_) begin_fault(seen);
  if (!seen.faulted && fault_) {
    fault_ = false;
    over_ = true;
    emergency_ = {};  // it was this fault's, and names none that comes after
  }
  fresh_ =
      std::ranges::all_of(seen.words, [this](const Word& w) { return w.refused || counts(w.tells_state, w.exchange); });
  // No fault came of it.
  const bool after = seen.statusword_exchange > emergency_.exchange && seen.at - emergency_.at >= kCauseTime;
  if (!fault_ && emergency_.code != 0 && after) emergency_ = {};
}

void FaultWatch::begin_fault(const Seen& seen) {
  fault_ = true;
  code_ = 0;
  since_ = seen.at;
  risen_ = seen.statusword_exchange;
  round_.clear();
  for (const Word& word : seen.words)
    if (!word.refused && !word.tells_state) round_.push_back(word.object);
  round_at_ = 0;
  round_due_ = kLongAgo;
}

// A word alone may send its reader to the next one.
void FaultWatch::name(std::uint16_t code) {
  if (fault_ && code != 0 && (fresh_ || late())) code_ = code;
}

std::uint16_t FaultWatch::code() const {
  if (!fault_) return 0;
  return code_ != 0 ? code_ : emergency_.code;
}

std::optional<model::ObjectId> FaultWatch::next(Instant now) const {
  if (!asks() || round_.empty() || now < round_due_) return std::nullopt;
  return round_[round_at_];
}

void FaultWatch::asked(Instant now) {
  if (++round_at_ < round_.size()) return;
  round_at_ = 0;
  round_due_ = now + kCausePause;
}

Instant FaultWatch::deadline() const {
  if (!asks()) return kNever;
  const Instant over = since_ + kCauseTime;
  return round_due_ > seen_ ? std::min(over, round_due_) : over;
}

}  // namespace axisgate::drive
