// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/state/fault_watch.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::drive {

CauseObjects cause_objects(const model::AxisModel& model) {
  CauseObjects out;
  const auto add = [&](model::ObjectId id) {
    const bool has = std::find(out.begin(), out.end(), id) != out.end();
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
    missed_ = missed_ || !named_;
    fault_ = named_ = false;
    over_ = true;
    emergency_ = {};  // it was this fault's, and names none that comes after
  }
  if (fault_) {
    fresh_ = std::all_of(seen.words.begin(), seen.words.end(),
                         [this](const Word& w) { return w.refused || counts(w.tells_state, w.exchange); });
  } else {
    look_ahead(seen);
    // No fault came of it.
    const bool after = seen.statusword_exchange > emergency_.exchange && seen.at - emergency_.at >= kCauseTime;
    if (emergency_.code != 0 && after) emergency_ = {};
  }
}

void FaultWatch::begin_fault(const Seen& seen) {
  fault_ = true;
  named_ = false;
  code_ = 0;
  since_ = seen.at;
  risen_ = seen.statusword_exchange;
  ahead_since_ = kLongAgo;
  settled_.clear();
  CauseObjects unread;
  for (const Word& word : seen.words)
    if (!word.refused && !word.tells_state) unread.push_back(word.object);
  begin_round(std::move(unread));
}

// A warning is shown once the statusword was read after it; a fault is told by its fault bit alone.
void FaultWatch::look_ahead(const Seen& seen) {
  settled_.resize(seen.words.size(), 0);
  bool ahead = false;
  for (std::size_t i = 0; i < seen.words.size(); ++i) {
    const Word& word = seen.words[i];
    const bool judged = word.tells_state || word.refused || seen.statusword_exchange > word.exchange;
    const bool late = words_ahead() && seen.at - ahead_since_ >= kCauseTime;
    if (word.number == 0 || judged || late) settled_[i] = word.number;
    ahead = ahead || word.number != settled_[i];
  }
  if (ahead && !words_ahead()) {
    ahead_since_ = seen.at;
    begin_round({seen.statusword});
  }
  if (!ahead) ahead_since_ = kLongAgo;
}

void FaultWatch::begin_round(CauseObjects objects) {
  round_ = std::move(objects);
  round_at_ = 0;
  round_due_ = kLongAgo;
}

void FaultWatch::name(std::uint16_t code) {
  if (!fault_) return;
  if (code != 0) code_ = code;
  if (named_) return;
  named_ = (fresh_ && this->code() != 0) || seen_ - since_ >= kCauseTime;
  if (named_) code_ = this->code();
}

std::uint16_t FaultWatch::code() const {
  if (!fault_) return 0;
  return code_ != 0 ? code_ : emergency_.code;
}

bool FaultWatch::take_missed() { return std::exchange(missed_, false); }

bool FaultWatch::take_over() { return std::exchange(over_, false); }

std::optional<model::ObjectId> FaultWatch::next(Instant now) const {
  const bool wanted = withheld() || words_ahead();
  if (!wanted || round_.empty() || now < round_due_) return std::nullopt;
  return round_[round_at_];
}

void FaultWatch::asked(Instant now) {
  if (++round_at_ < round_.size()) return;
  round_at_ = 0;
  round_due_ = now + kCausePause;
}

Instant FaultWatch::deadline() const {
  if (!withheld() && !words_ahead()) return kNever;
  const Instant over = (withheld() ? since_ : ahead_since_) + kCauseTime;
  return round_due_ > seen_ ? std::min(over, round_due_) : over;
}

}  // namespace axisgate::drive
