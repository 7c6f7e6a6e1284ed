// SPDX-License-Identifier: Apache-2.0
// The iD286pro's registers (iD286pro 4 and 8): the 49 rows of its manual and the multi-segment area, with what a write
// of each costs the EEPROM. Promises that a request is checked whole before any of it acts, and one counter of writes
// per row that is stored. Never gives a register a meaning: that is the drive's part.
#pragma once

#include <array>
#include <map>
#include <span>
#include <variant>

#include "tests/simulated/rtu_frame.hpp"

namespace axisgate::simulated {

// The manual stores every parameter at once, all but those it highlights; for some the highlighting is lost.
enum class Saved : std::uint8_t { read_only, yes, no, unknown };

struct Id286proRow {
  std::uint16_t number;
  int words;
  bool is_signed;
  Saved saved;
  std::int64_t initial = 0;
  std::int64_t minimum = 0;
  std::int64_t maximum = 65535;
};

std::span<const Id286proRow> id286pro_rows();

class Id286proRegisters {
 public:
  static constexpr std::uint16_t area_begin = 1024;  // multi-segment programs: 256 entries of two words
  static constexpr std::uint16_t area_end = 1536;

  struct Change {
    const Id286proRow* row;  // none: a word of the area
    std::uint16_t number;
    std::int64_t value;
  };
  using Changes = std::vector<Change>;

  Id286proRegisters();

  const Id286proRow* row_at(std::uint16_t number) const;  // also by its second word
  std::int64_t get(std::uint16_t row) const { return cells_.at(row).running; }
  // As the drive itself writes: no check, no count.
  void set(std::uint16_t row, std::int64_t value) { cells_.at(row).running = value; }
  void set_stored(std::uint16_t row, std::int64_t value) { cells_.at(row).running = cells_.at(row).stored = value; }

  // The words from `start` on; nothing where one is in a hole, unless holes read as zeros.
  std::optional<std::vector<std::uint16_t>> words(std::uint16_t start, std::uint16_t count, bool holes_are_zero) const;
  // What a write would change, in ascending order, or why it is refused. Changes nothing.
  std::variant<Changes, RtuException> check(std::uint16_t start, std::span<const std::uint16_t> values) const;
  void apply(const Change& change);

  std::uint64_t writes(std::uint16_t row) const;  // accepted over the bus
  // EEPROM writes of each row that was ever written: those the manual stores, and those of which it is not known.
  const std::map<std::uint16_t, std::uint64_t>& stored_writes() const { return stored_writes_; }
  const std::map<std::uint16_t, std::uint64_t>& unknown_writes() const { return unknown_writes_; }
  std::uint64_t area_saves() const { return area_saves_; }

  void save_area();         // command 15
  void restore_defaults();  // 0206 = 1
  void power_up(bool unknown_are_stored);

 private:
  struct Cell {
    const Id286proRow* row = nullptr;
    std::int64_t running = 0;
    std::int64_t stored = 0;
    std::uint64_t writes = 0;
  };
  using Area = std::array<std::uint16_t, area_end - area_begin>;
  static bool in_area(std::uint16_t number) { return number >= area_begin && number < area_end; }
  std::optional<std::uint16_t> word(std::uint16_t number) const;
  void count_eeprom(const Id286proRow& row);

  std::map<std::uint16_t, Cell> cells_;  // by the row's first register
  Area area_{};
  Area stored_area_{};
  std::map<std::uint16_t, std::uint64_t> stored_writes_;
  std::map<std::uint16_t, std::uint64_t> unknown_writes_;
  std::uint64_t area_saves_ = 0;
};

}  // namespace axisgate::simulated
