// SPDX-License-Identifier: Apache-2.0
// The resynchronisation read against late replies (design 7, point 4): after a timeout a drive is suspect until a read
// was answered whose reply cannot be the reply to anything lost. Promises that no candidate is used whose reply a lost
// one could pass for: by its object where replies name it, by its length on Modbus RTU, where they name nothing else.
// Where every length was lost, and on RTU also after the silence, replies are counted out: a drive answers in order, so
// one more reply of a length than it may owe is one to a read that was sent since, and all that was owed before is out.
// Where a profile has but one length, or the drive refuses the others, silence for worst_reply stands alone.
// Never sends: it says what to read, or how long to keep silent.
#pragma once

#include <boost/container/static_vector.hpp>
#include <optional>
#include <set>

#include "adapters/bus/exchange.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::drive {

class Resync {
 public:
  /// Two resynchronisation reads at most, each distinguishable; then the drive is offline.
  static constexpr int kMaxResyncs = 2;
  /// Lost replies of one length that are counted. More in one length is a drive that is gone, whose replies are counted
  /// out in the length that was lost least.
  static constexpr int kMaxOwed = 64;

  Resync(const model::ResyncProperties& facts, const std::vector<model::ObjectDef>& objects)
      : facts_(facts), objects_(objects) {}

  /// This exchange was given up.
  void lost(const bus::Exchange& exchange, Instant now);
  /// The resynchronisation read was answered: a drive answers in order, so nothing older is left. Of those that were
  /// sent since the loss the last one has answered, and what the others read may be unresponsive.
  void answered();
  /// Nothing counts as owed any more, for another reason.
  void forget();
  [[nodiscard]] bool suspect() const { return suspect_; }
  /// All resynchronisation reads are used up.
  [[nodiscard]] bool exhausted() const { return resyncs_ >= kMaxResyncs; }
  /// The read that is the next resynchronisation read; none: no distinguishable one is left.
  [[nodiscard]] std::optional<model::ResyncRead> candidate() const;
  void resync_sent(const model::ResyncRead& read);
  /// From then on every reply still owed by the drive would break its worst_reply: a plain read is safe.
  [[nodiscard]] Instant silent_until() const {
    return last_lost_ == kLongAgo ? kLongAgo : last_lost_ + facts_.worst_reply;
  }
  /// Silence was kept until silent_until(), and nothing else tells replies apart: nothing counts as owed any more.
  void waited_out() { forget(); }

  /// After the silence replies are distinguished still: by counting, or by a length that is owed no more.
  [[nodiscard]] bool counts_out() const;
  /// The read whose reply counts for nothing but its number; only where there is no candidate and counts_out().
  [[nodiscard]] model::ResyncRead counted();
  /// A read from counted() was answered.
  void counted_one();
  /// The drive refuses this read: its length is of no use.
  void refused(const bus::Exchange& exchange, Instant now);

 private:
  /// All by which the reply of a read can be distinguished from others.
  struct Likeness {
    ObjectAddress object;        ///< where replies name it
    std::uint8_t registers = 0;  ///< where they do not
    friend bool operator==(const Likeness&, const Likeness&) = default;
  };
  struct Lost {
    Likeness like;
    int times = 1;  ///< since all was last proven to be out; an answer does not lessen it: whose it was is not known
  };
  struct Counting {
    Likeness like;
    int left = 0;  ///< replies until one of them must be to a read that was sent since
  };
  [[nodiscard]] Likeness of(const bus::Exchange& exchange) const;
  [[nodiscard]] Likeness of(const model::ResyncRead& read) const;
  [[nodiscard]] int owed(const Likeness& like) const;
  [[nodiscard]] bool is_refused(const Likeness& like) const;

  const model::ResyncProperties& facts_;
  const std::vector<model::ObjectDef>& objects_;
  // One lost exchange, its resynchronisation reads and the stops sent meanwhile (three repeats); more cannot be before
  // it is offline.
  static constexpr std::size_t kMaxLost = 16;
  boost::container::static_vector<Lost, kMaxLost> lost_;
  boost::container::static_vector<Likeness, kMaxLost> refused_;
  std::optional<Counting> counting_{};
  /// Candidates, by their position, that did not answer although the drive did: those that do come first.
  std::set<std::size_t> unanswered_;
  boost::container::static_vector<std::size_t, kMaxResyncs> sent_;  ///< candidates asked since the loss
  Instant last_lost_ = kLongAgo;
  int resyncs_ = 0;
  bool suspect_ = false;
};

/// Registers from the first of the exchange's objects to the last.
[[nodiscard]] std::uint8_t registers_of(const bus::Exchange& exchange);

}  // namespace axisgate::drive
