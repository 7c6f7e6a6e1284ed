// SPDX-License-Identifier: Apache-2.0
// What names the fault of an axis, and what must be read for it. Promises that what is read before the fault never
// names it, that an emergency code names it at once and its words as soon as all were read after it, and that the
// drive is asked for kCauseTime at most. Never hides the fault, never reads anything, knows no clock but the instants
// it is given.
#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>
#include <utility>

#include "gateway/model/model.hpp"

namespace axisgate::drive {

/// A drive that has named no cause by then has the generic one.
inline constexpr Duration kCauseTime = std::chrono::milliseconds(500);
/// What gave no answer, or no cause, is asked again after so long.
inline constexpr Duration kCausePause = std::chrono::milliseconds(100);
/// Two fault words, the error code, and what else vendor_error is made of.
inline constexpr std::size_t kMaxCauseObjects = 6;

/// What names the causes of an axis's faults, each object once.
using CauseObjects = boost::container::static_vector<model::ObjectId, kMaxCauseObjects>;
[[nodiscard]] CauseObjects cause_objects(const model::AxisModel& model);

class FaultWatch {
 public:
  struct Word {
    model::ObjectId object = model::kNoObject;
    bool refused = false;
    bool tells_state = false;    ///< the statusword is made from it: the sample that shows the fault names its cause
    std::uint64_t exchange = 0;  ///< that gave its number; 0: none yet
  };
  struct Seen {
    Instant at = kLongAgo;  ///< now
    bool known = false;     ///< the statusword was read since bring-up began
    bool faulted = false;
    std::uint64_t statusword_exchange = 0;
    boost::container::static_vector<Word, kMaxCauseObjects> words;
  };

  /// New samples, or time has passed.
  void observe(const Seen& seen);
  /// What the words that count name after observe(); 0: nothing.
  void name(std::uint16_t code);
  /// The drive has sent an emergency code; 0: the reported emergency is over, and a fault that is there still keeps its
  /// cause. `exchange`: the newest one on the bus then.
  void emergency(std::uint16_t code, Instant now, std::uint64_t exchange) {
    if (code != 0 || !fault_) emergency_ = {code, now, exchange};
  }
  void forget_emergency() { emergency_ = {}; }

  /// What this fault was named by its words, or else by what the drive has sent; 0: nothing, or there is no fault.
  [[nodiscard]] std::uint16_t code() const;
  /// What the fault is called is known, or the time for it is over.
  [[nodiscard]] bool cause_known() const { return fault_ && (code() != 0 || late()); }
  /// All that names it was read, too, or the time for it is over: it can be logged.
  [[nodiscard]] bool settled() const { return cause_known() && (fresh_ || late()); }
  /// A sample of this exchange says something of what the statusword shows now.
  [[nodiscard]] bool counts(bool tells_state, std::uint64_t exchange) const {
    return !fault_ || tells_state || exchange > risen_;
  }
  /// A fault is over: what its words hold now is worth a look; reported once.
  [[nodiscard]] bool take_over() { return std::exchange(over_, false); }

  /// What is to be read next, before anything but stops; none: nothing now.
  [[nodiscard]] std::optional<model::ObjectId> next(Instant now) const;
  /// It goes on the wire.
  void asked(Instant now);
  /// When observe() and next() must be looked at again even without samples.
  [[nodiscard]] Instant deadline() const;

 private:
  void begin_fault(const Seen& seen);
  [[nodiscard]] bool late() const { return seen_ - since_ >= kCauseTime; }
  [[nodiscard]] bool asks() const { return fault_ && !settled(); }

  bool fault_ = false;
  bool fresh_ = false;  ///< all that names causes was read after the fault was seen
  bool over_ = false;
  Instant seen_ = kLongAgo;   ///< the newest instant of observe()
  Instant since_ = kLongAgo;  ///< of the fault
  std::uint64_t risen_ = 0;   ///< the exchange whose statusword has shown it first
  std::uint16_t code_ = 0;    ///< what its words have named
  struct Emergency {
    std::uint16_t code = 0;
    Instant at = kLongAgo;
    std::uint64_t exchange = 0;
  } emergency_;
  CauseObjects round_;  ///< what is read, in this order, again and again until it is settled
  std::size_t round_at_ = 0;
  Instant round_due_ = kLongAgo;
};

}  // namespace axisgate::drive
