// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/object_dictionary.hpp"

#include <algorithm>
#include <stdexcept>

namespace axisgate::simulated {

ObjectDictionary::ObjectDictionary(std::span<const ObjectEntry> motion, std::span<const ObjectEntry> setup,
                                   OutOfRange out_of_range)
    : out_of_range_(out_of_range) {
  for (const auto table : {motion, setup}) {
    for (const ObjectEntry& entry : table) cells_[entry.key()] = {&entry, entry.initial, entry.initial, 0};
  }
}

const ObjectEntry* ObjectDictionary::find(ObjectKey key) const {
  const auto found = cells_.find(key);
  return found == cells_.end() ? nullptr : found->second.entry;
}

bool ObjectDictionary::has_index(std::uint16_t index) const {
  return std::ranges::any_of(cells_, [index](const auto& cell) { return cell.first.index == index; });
}

ObjectDictionary::Cell& ObjectDictionary::cell(ObjectKey key) {
  const auto found = cells_.find(key);
  if (found == cells_.end()) throw std::out_of_range("the simulated drive has no such object");
  return found->second;
}

std::int64_t ObjectDictionary::get(ObjectKey key) const {
  const auto found = cells_.find(key);
  return found == cells_.end() ? 0 : found->second.running;
}

void ObjectDictionary::set(ObjectKey key, std::int64_t value) { cell(key).running = value; }

void ObjectDictionary::set_stored(ObjectKey key, std::int64_t value) { cell(key).stored = cell(key).running = value; }

Refusal ObjectDictionary::check_write(ObjectKey key, int width, std::uint32_t raw, std::int64_t& value) const {
  const ObjectEntry* entry = find(key);
  if (entry == nullptr) return Refusal::no_such_object;
  if (entry->access == Access::ro) return Refusal::read_only;
  if (width != bytes_of(entry->type)) return Refusal::wrong_width;
  value = value_in(entry->type, raw);
  if (value >= entry->minimum && value <= entry->maximum) return Refusal::none;
  if (out_of_range_ == OutOfRange::refuse) return Refusal::value_range;
  value = std::clamp(value, entry->minimum, entry->maximum);
  return Refusal::none;
}

void ObjectDictionary::count_write(ObjectKey key) { ++cell(key).writes; }

std::uint64_t ObjectDictionary::writes(ObjectKey key) const {
  const auto found = cells_.find(key);
  return found == cells_.end() ? 0 : found->second.writes;
}

void ObjectDictionary::store(Keep what) {
  for (auto& [key, cell] : cells_) {
    if (cell.entry->keep == what) cell.stored = cell.running;
  }
}

void ObjectDictionary::restore_defaults() {
  for (auto& [key, cell] : cells_) {
    if (cell.entry->keep == Keep::eeprom) cell.running = cell.entry->initial;
  }
}

void ObjectDictionary::power_up() {
  for (auto& [key, cell] : cells_) cell.running = cell.entry->keep == Keep::ram ? cell.entry->initial : cell.stored;
}

}  // namespace axisgate::simulated
