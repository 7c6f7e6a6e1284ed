// SPDX-License-Identifier: Apache-2.0
// When a fault of an axis is shown, and what must be read before (the fault bit, error_code and vendor_error come in
// one step). Promises that a fault is shown as soon as all that names its cause was read after it, at the latest
// after kCauseTime, and that nothing read before the fault ever names its cause. Never reads anything, knows no clock
// but the instants it is given, and holds nothing back from the motion rules.
#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>

#include "gateway/model/model.hpp"

namespace axisgate::drive {

/// A drive that has named no cause by then is shown with the generic one.
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
    bool tells_state = false;  ///< the statusword is made from it: the sample that shows the fault names its cause
    std::int64_t number = 0;
    std::uint64_t exchange = 0;  ///< that gave its number; 0: none yet
  };
  struct Seen {
    Instant at = kLongAgo;  ///< now
    bool known = false;     ///< the statusword was read since bring-up began
    bool faulted = false;
    model::ObjectId statusword = model::kNoObject;
    std::uint64_t statusword_exchange = 0;
    boost::container::static_vector<Word, kMaxCauseObjects> words;
  };

  /// New samples, or time has passed.
  void observe(const Seen& seen);
  /// What the words that count name after observe(); 0: nothing.
  void name(std::uint16_t code);
  /// The drive has sent an emergency code; 0: the reported emergency is over. `exchange`: the newest one on the bus
  /// then.
  void emergency(std::uint16_t code, Instant now, std::uint64_t exchange) { emergency_ = {code, now, exchange}; }
  void forget_emergency() { emergency_ = {}; }

  /// A fault whose cause is not known yet: what tells of it is shown as it was.
  [[nodiscard]] bool withheld() const { return fault_ && !named_; }
  /// A word names something, and the statusword was not read after it: whether it is a fault is not known yet.
  [[nodiscard]] bool words_ahead() const { return !fault_ && ahead_since_ != kLongAgo; }
  /// A sample of this exchange says something of what the statusword shows now.
  [[nodiscard]] bool counts(bool tells_state, std::uint64_t exchange) const {
    return !fault_ || tells_state || exchange > risen_;
  }
  /// What this fault was named by its words, or else by what the drive has sent; 0: nothing, or there is no fault.
  [[nodiscard]] std::uint16_t code() const;
  /// A fault came and went before its cause was known; reported once.
  [[nodiscard]] bool take_missed();
  /// A fault is over: what its words hold now is worth a look; reported once.
  [[nodiscard]] bool take_over();

  /// What is to be read next, before anything but stops; none: nothing now.
  [[nodiscard]] std::optional<model::ObjectId> next(Instant now) const;
  /// It goes on the wire.
  void asked(Instant now);
  /// When observe() and next() must be looked at again even without samples.
  [[nodiscard]] Instant deadline() const;

 private:
  void begin_fault(const Seen& seen);
  void look_ahead(const Seen& seen);
  void begin_round(CauseObjects objects);

  bool fault_ = false;
  bool named_ = false;
  bool fresh_ = false;  ///< all that names causes was read after the fault was seen
  bool missed_ = false;
  bool over_ = false;
  Instant seen_ = kLongAgo;   ///< the newest instant of observe()
  Instant since_ = kLongAgo;  ///< of the fault
  std::uint64_t risen_ = 0;   ///< the exchange whose statusword has shown it first
  std::uint16_t code_ = 0;    ///< what it was named
  Instant ahead_since_ = kLongAgo;
  boost::container::static_vector<std::int64_t, kMaxCauseObjects> settled_;  ///< words that are no fault's, as known
  struct Emergency {
    std::uint16_t code = 0;
    Instant at = kLongAgo;
    std::uint64_t exchange = 0;
  } emergency_;
  CauseObjects round_;  ///< what is read, in this order, again and again until it is no longer wanted
  std::size_t round_at_ = 0;
  Instant round_due_ = kLongAgo;
};

}  // namespace axisgate::drive
