// SPDX-License-Identifier: Apache-2.0
// Which object of a drive is read next, and when: classes fast, normal, slow and once (design section 5).
// Promises that the object longest overdue goes first, and that one the drive refuses spoils none of the others.
// Never reads anything, and knows no clock but the instants it is given.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "gateway/model/model.hpp"

namespace axisgate::drive {

struct PollItem {
  model::ObjectId object = model::kNoObject;
  model::PollClass poll_class = model::PollClass::normal;
  bool mapped = false;  ///< planned to come by TPDO: then read only where it was silent for CanopenProperties::confirm
};

/// Every object that must be read to keep the image of these axes true, each once, in its fastest class. What the drive
/// sends by itself in a beat of its own is not asked for, but for the state: it is never slower than class fast.
[[nodiscard]] std::vector<PollItem> poll_items(const model::DriveModel& model);

class PollPlan {
 public:
  explicit PollPlan(const model::DriveModel& model);

  /// All objects are due at once (the drive came online), those of class once included; none comes by itself.
  void restart(Instant now);
  /// It comes by TPDO from now on: with an event timer, it is read in its own beat where three of them were missed;
  /// without, once in `confirm` where it was silent.
  void map(model::ObjectId object, std::optional<Duration> event, Duration confirm);
  /// Nothing comes by TPDO any more: what did is read in its own beat again.
  void unmap_all(Instant now);
  /// It came by TPDO.
  void received(model::ObjectId object, Instant now);
  /// What comes by TPDO is read after so long without one at the latest, from now on; none: as it was mapped.
  void confirm_within(model::ObjectId object, std::optional<Duration> limit, Instant now);
  /// It is read as soon as its turn comes: something was heard that it will tell of. `now`: kLongAgo: before all that
  /// is overdue, an answer waits for it.
  void hurry(model::ObjectId object, Instant now);
  /// The object to read now: the one longest overdue. None before next_due().
  [[nodiscard]] std::optional<model::ObjectId> next(Instant now) const;
  [[nodiscard]] bool due(model::ObjectId object, Instant now) const;
  /// kNever where nothing is polled.
  [[nodiscard]] Instant next_due() const;
  /// It was read (by whomever) or refused: due again one period after its due time, never more than once to catch up.
  void done(model::ObjectId object, Instant now);
  /// The drive does not have it: never due again until restart().
  void drop(model::ObjectId object);
  /// It is asked in vain: due then and, whatever wants it sooner, not before.
  void rest(model::ObjectId object, Instant until);
  /// Whatever rests is due at once.
  void wake(Instant now);
  /// A write of it was acknowledged: if it is of class once, it is read once more as soon as its turn comes.
  void written(model::ObjectId object, Instant now);
  /// What the drive holds was invalidated: those of class once are read again, one by one, so that the others keep
  /// their beat.
  void refresh(Instant now);

 private:
  struct Entry {
    model::ObjectId object;
    Duration period;  ///< 0: once
    Instant due;
    bool dropped = false;
    Duration beat;                     ///< its period where it does not come by TPDO
    Duration silence{};                ///< it comes by TPDO, and is read after so long without one; 0: it does not
    Duration limit = Duration::max();  ///< of that silence, and of the time between two such reads
    Instant rests = kLongAgo;          ///< until then it is not asked, whenever it is due

    [[nodiscard]] Instant asked_at() const { return std::max(due, rests); }
  };
  static constexpr Duration kRefreshPause = std::chrono::milliseconds(20);
  [[nodiscard]] const Entry* earliest() const;
  /// Null where it is none of the plan, or the drive does not have it.
  [[nodiscard]] Entry* entry(model::ObjectId object);
  std::vector<Entry> entries_;
};

}  // namespace axisgate::drive
