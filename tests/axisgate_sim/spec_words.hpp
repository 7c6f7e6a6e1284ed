// SPDX-License-Identifier: Apache-2.0
// The words of `--line`: numbers, places, drives with their station.
// Promises messages that name the word which is wrong and what would be right (std::invalid_argument).
// Never knows a kind of line.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/simulated/drive_options.hpp"
#include "tests/simulated/object_entry.hpp"

namespace axisgate::simulated {

[[noreturn]] void refuse_spec(std::string_view what, std::string_view wrong, std::string_view right);
std::optional<std::int64_t> whole_number(std::string_view text);
std::optional<ObjectKey> object_named(std::string_view text);  // INDEX.SUB in hex
std::vector<std::string_view> split(std::string_view text, char at);

// The words that every kind of drive takes: home=FROM..TO and limits=FROM..TO.
bool modify_mechanics(Mechanics& mechanics, std::string_view word);

struct Typed {
  std::string_view type;
  std::uint8_t station;
  std::vector<std::string_view> words;
};

// TYPE@STATION and the words behind it. `names` lists the types for people.
Typed typed(std::string_view text, const std::vector<std::string_view>& types, std::string_view names,
            std::int64_t highest);
DriveOptions parse_kinco(const Typed& it, DriveOptions drive);

}  // namespace axisgate::simulated
