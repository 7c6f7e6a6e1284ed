// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/id286pro_registers.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::int64_t far = 2'000'000'000;  // pulses
constexpr std::int64_t most_negative = -2'147'483'648;
constexpr std::int64_t most_positive = 2'147'483'647;

// Defaults the sheet leaves open (0201 to 0245, 0305, 0429 and its like): a plausible figure, never relied upon.
constexpr Id286proRow register_rows[] = {
    // status (class 01)
    {100, 1, false, Saved::read_only},                                  // motor current, 0.001 A
    {101, 1, false, Saved::read_only},                                  // input voltage, 0.01 V
    {104, 2, false, Saved::read_only, 0, 0, 0xFFFFFFFF},                // microstep setting in effect
    {106, 1, false, Saved::read_only},                                  // pulse mode in effect
    {108, 1, false, Saved::read_only},                                  // fault code
    {109, 1, false, Saved::read_only},                                  // run state
    {110, 1, false, Saved::read_only, 1},                               // hardware version
    {111, 1, false, Saved::read_only, 100},                             // software version
    {117, 2, true, Saved::read_only, 0, most_negative, most_positive},  // current position
    {119, 1, true, Saved::read_only, 0, -32768, 32767},                 // actual speed, 0.01 rev/s
    // basic settings (class 02)
    {201, 1, false, Saved::yes, 0, 0, 1},              // motor direction
    {206, 1, false, Saved::yes, 0, 0, 5},              // user command
    {213, 1, false, Saved::yes, 50, 10, 120},          // standstill current ratio
    {224, 1, false, Saved::yes, 100, 1, 700},          // angle filter
    {234, 1, false, Saved::yes, 5, 1, 15},             // digital input filter
    {241, 1, false, Saved::yes, 3000, 100, 6500},      // motor current setting
    {242, 2, false, Saved::yes, 10000, 200, 102400},   // microstep
    {244, 1, false, Saved::yes, 1, 1, 2},              // pulse mode
    {245, 1, false, Saved::yes, 500, 1, 32767},        // standstill current delay
    {296, 1, false, Saved::yes, 0, 0, 1},              // run mode
    {298, 1, false, Saved::yes, 1, 1, 255},            // Modbus address
    {299, 2, false, Saved::yes, 19200, 1600, 115200},  // baud rate
    // control (printed as class 05)
    {301, 1, false, Saved::yes, 100, 1, 2000},       // start frequency
    {302, 1, false, Saved::yes, 100, 1, 2000},       // stop frequency
    {303, 1, false, Saved::no, 500, 5, 10000},       // acceleration
    {304, 1, false, Saved::no, 500, 5, 10000},       // deceleration
    {305, 1, false, Saved::yes, 0, 0, 3},            // homing mode: 0..1 printed, four described
    {306, 1, false, Saved::no, 1000, 1, 5000},       // positioning speed
    {307, 1, true, Saved::no, 1000, -5000, 5000},    // speed-mode speed
    {308, 1, false, Saved::unknown, 1000, 1, 5000},  // jog speed
    {309, 1, false, Saved::unknown, 1000, 1, 5000},  // name lost: homing speed, likely
    {310, 1, false, Saved::unknown, 1000, 1, 5000},  // name lost: second homing speed, likely
    {311, 2, true, Saved::unknown, 0, -far, far},    // name lost: homing offset, likely
    {313, 2, true, Saved::unknown, 0, -far, far},    // target or travel
    {315, 2, true, Saved::unknown, 0, -far, far},    // name lost
    {317, 2, true, Saved::yes, far, -far, far},      // positive soft limit
    {319, 2, true, Saved::yes, -far, -far, far},     // negative soft limit
    {321, 2, true, Saved::no, 0, -far, far},         // value for set-current-position
    {323, 1, false, Saved::no, 0, 0, 29},            // control command
    // inputs (printed as class 06)
    {400, 1, false, Saved::yes, 0, 0, 30},  // IN1 function
    {401, 1, false, Saved::yes, 0, 0, 30},  // IN2 function
    {402, 1, false, Saved::yes, 0, 0, 30},  // IN3 function
    {410, 1, false, Saved::yes, 0, 0, 1},   // simulated input IN1
    {411, 1, false, Saved::yes, 0, 0, 1},   // simulated input IN2
    {412, 1, false, Saved::yes, 0, 0, 1},   // simulated input IN3
    {429, 1, false, Saved::yes},            // general input logic
    // outputs (printed as class 07)
    {420, 1, false, Saved::yes, 101, 100, 104},  // OUT1 function
    {428, 1, false, Saved::yes},                 // general output control
    {430, 1, false, Saved::yes},                 // general output logic
};

std::int64_t value_of(const Id286proRow& row, std::uint32_t raw) {
  if (row.words == 2) return row.is_signed ? static_cast<std::int32_t>(raw) : static_cast<std::int64_t>(raw);
  return row.is_signed ? static_cast<std::int16_t>(raw) : static_cast<std::int64_t>(raw & 0xFFFF);
}

}  // namespace

std::span<const Id286proRow> id286pro_rows() { return register_rows; }

Id286proRegisters::Id286proRegisters() {
  for (const Id286proRow& row : register_rows) cells_[row.number] = {&row, row.initial, row.initial, 0};
}

const Id286proRow* Id286proRegisters::row_at(std::uint16_t number) const {
  auto after = cells_.upper_bound(number);
  if (after == cells_.begin()) return nullptr;
  const Id286proRow* row = std::prev(after)->second.row;
  return number < row->number + row->words ? row : nullptr;
}

std::optional<std::uint16_t> Id286proRegisters::word(std::uint16_t number) const {
  if (in_area(number)) return area_[number - area_begin];
  const Id286proRow* row = row_at(number);
  if (row == nullptr) return std::nullopt;
  return static_cast<std::uint16_t>(get(row->number) >> (16 * (number - row->number)));
}

std::optional<std::vector<std::uint16_t>> Id286proRegisters::words(std::uint16_t start, std::uint16_t count,
                                                                   bool holes_are_zero) const {
  std::vector<std::uint16_t> found;
  for (std::uint32_t number = start; number < std::uint32_t{start} + count; ++number) {
    const auto value = number > 0xFFFF ? std::nullopt : word(static_cast<std::uint16_t>(number));
    if (!value && !holes_are_zero) return std::nullopt;
    found.push_back(value.value_or(0));
  }
  return found;
}

std::variant<Id286proRegisters::Changes, RtuException> Id286proRegisters::check(
    std::uint16_t start, std::span<const std::uint16_t> values) const {
  Changes changes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto number = static_cast<std::uint16_t>(start + i);
    if (number < start) return RtuException::address;
    if (in_area(number)) {
      changes.push_back({nullptr, number, values[i]});
      continue;
    }
    const Id286proRow* row = row_at(number);
    if (row == nullptr || row->saved == Saved::read_only) return RtuException::address;
    // A pair is changed word by word: half of one leaves the other half as it is.
    if (changes.empty() || changes.back().row != row) changes.push_back({row, row->number, get(row->number)});
    const int shift = 16 * (number - row->number);
    const auto old = static_cast<std::uint32_t>(changes.back().value);
    const std::uint32_t raw = (old & ~(0xFFFFU << shift)) | (std::uint32_t{values[i]} << shift);
    changes.back().value = value_of(*row, raw);
  }
  for (const Change& change : changes) {
    if (change.row == nullptr) continue;
    if (change.value < change.row->minimum || change.value > change.row->maximum) return RtuException::value;
  }
  return changes;
}

void Id286proRegisters::count_eeprom(const Id286proRow& row) {
  if (row.saved == Saved::yes) ++stored_writes_[row.number];
  if (row.saved == Saved::unknown) ++unknown_writes_[row.number];
}

void Id286proRegisters::apply(const Change& change) {
  if (change.row == nullptr) {
    area_[change.number - area_begin] = static_cast<std::uint16_t>(change.value);
    return;
  }
  Cell& cell = cells_.at(change.number);
  cell.running = change.value;
  ++cell.writes;
  if (change.row->saved != Saved::no) cell.stored = change.value;
  count_eeprom(*change.row);  // stored on each write, whether the value is new or not
}

std::uint64_t Id286proRegisters::writes(std::uint16_t row) const {
  const auto found = cells_.find(row);
  return found == cells_.end() ? 0 : found->second.writes;
}

void Id286proRegisters::save_area() {
  stored_area_ = area_;
  ++area_saves_;
}

void Id286proRegisters::restore_defaults() {
  for (auto& [number, cell] : cells_) {
    if (cell.row->saved == Saved::read_only) continue;
    cell.running = cell.stored = cell.row->initial;
    count_eeprom(*cell.row);
  }
}

void Id286proRegisters::power_up(bool unknown_are_stored) {
  for (auto& [number, cell] : cells_) {
    const bool kept = cell.row->saved == Saved::yes || (cell.row->saved == Saved::unknown && unknown_are_stored);
    if (cell.row->saved != Saved::read_only) cell.running = kept ? cell.stored : cell.row->initial;
  }
  area_ = stored_area_;
}

}  // namespace axisgate::simulated
