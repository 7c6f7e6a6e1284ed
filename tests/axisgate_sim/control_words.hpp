// SPDX-License-Identifier: Apache-2.0
// The words of a control line: numbers, switches, objects.
// Promises that what is wrong is refused with what would be right (std::invalid_argument).
// Never knows a line or a drive.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/simulated/drive_faults.hpp"
#include "tests/simulated/object_entry.hpp"

namespace axisgate::simulated {

using ControlWords = std::vector<std::string>;

[[noreturn]] void refuse_word(const std::string& why);
std::int64_t number_in(const std::string& text);
bool is_whole_number(const std::string& text);
bool on_or_off(const std::string& text);
ObjectKey object_in(const std::string& text);
std::uint16_t register_in(const std::string& text);
int error_word_in(const std::string& text);
std::string in_hex(std::int64_t value);
void need_words(const ControlWords& words, std::size_t count, const char* form);

struct Strikes {
  double rate = 0;
  std::optional<std::uint64_t> next;  // instead of the rate
};
// on, off, next [N] or a rate, from words[at] on.
Strikes strikes_in(const ControlWords& words, std::size_t at);
void set_fault_switch(DriveFaults& faults, DriveFault fault, const ControlWords& words, std::size_t at);

}  // namespace axisgate::simulated
