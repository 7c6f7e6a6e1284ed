// SPDX-License-Identifier: Apache-2.0
// The resynchronisation read against late replies (design 7, point 4): after a timeout a drive is suspect until a read
// was answered whose reply cannot be the reply to anything lost. Promises that no candidate is used whose reply a lost
// one could pass for: by its object where replies name it, by its length on Modbus RTU, where they name nothing else.
// Never sends: it says what to read, or how long to keep silent.
#pragma once

#include <boost/container/static_vector.hpp>
#include <optional>

#include "gateway/model/model.hpp"

namespace axisgate::drive {

class Resync {
 public:
  /// Two resynchronisation reads at most, each distinguishable; then the drive is offline.
  static constexpr int kMaxResyncs = 2;

  Resync(const ResyncProperties& facts, const std::vector<ObjectDef>& objects) : facts_(facts), objects_(objects) {}

  /// This exchange was given up.
  void lost(const bus::Exchange& exchange, Instant now);
  /// The resynchronisation read was answered: a drive answers in order, so nothing older is left.
  void answered() {
    suspect_ = false;
    lost_.clear();
    resyncs_ = 0;
  }
  [[nodiscard]] bool suspect() const { return suspect_; }
  /// All resynchronisation reads are used up.
  [[nodiscard]] bool exhausted() const { return resyncs_ >= kMaxResyncs; }
  /// The read that is the next resynchronisation read; none: no distinguishable one is left.
  [[nodiscard]] std::optional<ResyncRead> candidate() const;
  void resync_sent() { ++resyncs_; }
  /// From then on every reply still owed by the drive would break its worst_reply: a plain read is safe.
  [[nodiscard]] Instant silent_until() const {
    return last_lost_ == kLongAgo ? kLongAgo : last_lost_ + facts_.worst_reply;
  }
  /// Silence was kept until silent_until(): nothing can be owed any more.
  void waited_out() { answered(); }

 private:
  /// All by which the reply of a read can be told from others.
  struct Likeness {
    bus::ObjectAddress object;   ///< where replies name it
    std::uint8_t registers = 0;  ///< where they do not
    friend bool operator==(const Likeness&, const Likeness&) = default;
  };
  [[nodiscard]] Likeness of(const bus::Exchange& exchange) const;
  [[nodiscard]] Likeness of(const ResyncRead& read) const;

  const ResyncProperties& facts_;
  const std::vector<ObjectDef>& objects_;
  // One lost exchange, its resynchronisation reads and the stops sent meanwhile (three repeats); more cannot be before
  // it is offline.
  static constexpr std::size_t kMaxLost = 16;
  boost::container::static_vector<Likeness, kMaxLost> lost_;
  Instant last_lost_ = kLongAgo;
  int resyncs_ = 0;
  bool suspect_ = false;
};

/// Registers from the first of the exchange's objects to the last.
[[nodiscard]] std::uint8_t registers_of(const bus::Exchange& exchange);

}  // namespace axisgate::drive
