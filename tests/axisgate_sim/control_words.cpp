// SPDX-License-Identifier: Apache-2.0
#include "tests/axisgate_sim/control_words.hpp"

#include <charconv>
#include <cstdio>
#include <stdexcept>
#include <string_view>

namespace axisgate::simulated {
namespace {

double rate_in(const std::string& text) {
  std::size_t used = 0;
  double value = -1;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used != text.size() || used == 0 || value < 0 || value > 1) {
    refuse_word("'" + text + "' is none of on, off, next and a rate from 0 to 1");
  }
  return value;
}

}  // namespace

void refuse_word(const std::string& why) { throw std::invalid_argument(why); }

std::int64_t number_in(const std::string& text) {
  const bool negative = text.starts_with('-');
  std::string_view digits = std::string_view(text).substr(negative ? 1 : 0);
  const bool hex = digits.starts_with("0x");
  if (hex) digits.remove_prefix(2);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, hex ? 16 : 10);
  if (digits.empty() || error != std::errc() || end != digits.data() + digits.size()) {
    refuse_word("'" + text + "' is no number: write 123, -123 or 0x7B");
  }
  return negative ? -value : value;
}

bool is_whole_number(const std::string& text) { return text.find_first_not_of("0123456789") == std::string::npos; }

bool on_or_off(const std::string& text) {
  if (text != "on" && text != "off") refuse_word("'" + text + "' is neither on nor off");
  return text == "on";
}

ObjectKey object_in(const std::string& text) {
  unsigned index = 0;
  unsigned sub = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%4x.%2x%c", &index, &sub, &rest) != 2) {
    refuse_word("'" + text + "' is no object: write INDEX.SUB in hex, for example 6041.00");
  }
  return {static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(sub)};
}

std::uint16_t register_in(const std::string& text) {
  const std::int64_t number = number_in(text);
  if (number < 0 || number > 0xFFFF) refuse_word("'" + text + "' is no register");
  return static_cast<std::uint16_t>(number);
}

int error_word_in(const std::string& text) {
  if (text != "2601" && text != "2602") refuse_word("'" + text + "' is no error word: write 2601 or 2602");
  return text == "2601" ? 1 : 2;
}

std::string in_hex(std::int64_t value) {
  char text[24];
  (void)std::snprintf(text, sizeof text, "0x%08X", static_cast<unsigned>(static_cast<std::uint32_t>(value)));
  return text;
}

void need_words(const ControlWords& words, std::size_t count, const char* form) {
  if (words.size() != count) refuse_word(std::string("write ") + form);
}

Strikes strikes_in(const ControlWords& words, std::size_t at) {
  const std::string how = words.size() > at ? words[at] : "on";
  if (how == "next") return {0, words.size() > at + 1 ? static_cast<std::uint64_t>(number_in(words[at + 1])) : 1};
  if (how == "off" || how == "on") return {how == "on" ? 1.0 : 0.0, std::nullopt};
  return {rate_in(how), std::nullopt};
}

void set_fault_switch(DriveFaults& faults, DriveFault fault, const ControlWords& words, std::size_t at) {
  const Strikes strikes = strikes_in(words, at);
  if (strikes.next) {
    faults.next(fault, *strikes.next);
    return;
  }
  faults.set_rate(fault, strikes.rate);
  if (strikes.rate == 0) faults.next(fault, 0);
}

}  // namespace axisgate::simulated
