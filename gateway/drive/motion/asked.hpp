// SPDX-License-Identifier: Apache-2.0
// What was asked of one axis: for each quantity the newest value, by which client, at which point of the axis's record.
// Pure. Promises that what holds follows from points alone: a target velocity or torque until anything ends motions for
// good (design 3.4 What survives), every other target, speed and ramp until a later one is asked for, the rest until
// the drive comes up from scratch. Never decides what is accepted or sent.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "gateway/image/axis_record.hpp"
#include "gateway/image/command.hpp"

namespace axisgate::drive {

/// A value as it was asked for.
struct Wanted {
  std::int64_t value = 0;               ///< in register units
  std::optional<std::int64_t> exact{};  ///< as the drive counts, where the object mailbox gave it so
  ClientId by = 0;                      ///< 0: the gateway itself
  AxisRecord::Point at = 0;
};

/// Registers 47 to 52, of what a motion goes by: each start goes by what was asked for, also where the drive has
/// restarted since. The rest is what the drive holds (design 3.2), or the start's own.
[[nodiscard]] bool is_speed(Quantity quantity);

class Asked {
 public:
  /// `record`: its axis's.
  explicit Asked(AxisRecord& record) : record_(record) {}

  /// The write batch was accepted: its values are the newest, and may wait for the wire.
  void accept(const WriteBatch& batch);
  /// It has ended before anything of it was begun: nobody knows any more what is wanted.
  void withdraw(const WriteBatch& batch);
  /// As it was accepted last.
  [[nodiscard]] std::optional<std::int64_t> accepted(Quantity quantity) const;

  /// Its turn has come: whatever starts from now on goes by it. `beside_stop`: it came in the request of a stop.
  void take(Quantity quantity, Wanted wanted, bool beside_stop = false);
  /// What a start goes by.
  [[nodiscard]] std::optional<Wanted> taken(Quantity quantity) const;
  /// Nothing goes by it any more: it has failed, or its drive does not hold it.
  void forget(Quantity quantity) { entry(quantity).taken.reset(); }

  /// The gateway has changed this value for a moment, and owes the drive what it has held; until that is put back
  /// (forget), a client asks for another one, or the drive comes up from scratch.
  void owe(Quantity quantity, std::optional<std::int64_t> held);
  [[nodiscard]] std::optional<std::int64_t> owed(Quantity quantity) const;

 private:
  struct Entry {
    std::optional<Wanted> accepted;
    std::optional<Wanted> taken;
  };
  [[nodiscard]] bool holds(Quantity quantity, const Wanted& wanted) const;
  [[nodiscard]] Entry& entry(Quantity quantity) { return entries_[static_cast<std::size_t>(quantity)]; }
  [[nodiscard]] const Entry& entry(Quantity quantity) const { return entries_[static_cast<std::size_t>(quantity)]; }

  AxisRecord& record_;
  std::array<Entry, kQuantityCount> entries_{};
};

}  // namespace axisgate::drive
