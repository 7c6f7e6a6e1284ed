// SPDX-License-Identifier: Apache-2.0
// The values behind a drive's objects: the running ones and those the EEPROM would bring back.
// Promises CiA 301 refusals (no such object, read-only, wrong width), the sheet's clamping, and a count of every write.
// Never gives a value a meaning: that is the drive's part.
#pragma once

#include <boost/unordered/unordered_flat_map.hpp>
#include <cstdint>
#include <optional>
#include <span>

#include "tests/simulated/object_entry.hpp"

namespace axisgate::simulated {

// The sheets say that an error reply carries a code, but list none (JD 10.1, MD 12.3): these are CiA 301's.
enum class Refusal : std::uint32_t {
  none = 0,
  no_such_object = 0x06020000,
  read_only = 0x06010002,
  wrong_width = 0x06070010,
  value_range = 0x06090030,
  device_state = 0x08000022,
  local_control = 0x08000021,
};

// A value above an object's maximum is clamped by the JD (S10 note 4) and refused by the MD (MD 3.2 names it a
// failure).
enum class OutOfRange : std::uint8_t { clamp, refuse };

class ObjectDictionary {
 public:
  ObjectDictionary(std::span<const ObjectEntry> motion, std::span<const ObjectEntry> setup, OutOfRange out_of_range);

  const ObjectEntry* find(ObjectKey key) const;
  bool has_index(std::uint16_t index) const;  // with any sub-index
  std::int64_t get(ObjectKey key) const;
  // As the drive itself writes: no check, no count.
  void set(ObjectKey key, std::int64_t value);
  // As it is delivered or was stored before the world began.
  void set_stored(ObjectKey key, std::int64_t value);

  // What a write of `width` bytes would store, or why it is refused. Changes nothing.
  Refusal check_write(ObjectKey key, int width, std::uint32_t raw, std::int64_t& value) const;
  void count_write(ObjectKey key);
  std::uint64_t writes(ObjectKey key) const;

  void store(Keep what);
  void restore_defaults();  // 2FF0:01 = 10: the running values only; a store must follow (JD 4.19, MD K)
  void power_up();          // running values become stored ones, the rest their defaults

 private:
  struct Cell {
    const ObjectEntry* entry = nullptr;
    std::int64_t running = 0;
    std::int64_t stored = 0;
    std::uint64_t writes = 0;
  };
  Cell& cell(ObjectKey key);

  // A simulated drive looks its objects up more often than it does anything else.
  boost::unordered_flat_map<ObjectKey, Cell, ObjectKey::Hash> cells_;
  OutOfRange out_of_range_;
};

}  // namespace axisgate::simulated
