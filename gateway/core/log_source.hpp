// SPDX-License-Identifier: Apache-2.0
// Who speaks in a line of the log: in words, and in the facts that a journal can be asked for.
// Promises that the facts are those of whoever writes the line. Never takes one out of the words.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace axisgate {

struct LogSource {
  std::string words;         ///< what a line begins with: "bus lift-serial", "axis 1 lift", "modbus"
  std::uint16_t axis = 0;    ///< 0: of no axis
  std::string bus{};         ///< its name; empty: of no bus
  std::string_view event{};  ///< text() of an EventKind; empty: no event

  /// For a log that has nothing but words.
  operator std::string_view() const { return words; }
};

[[nodiscard]] inline LogSource bus_source(std::string name) { return {.words = "bus " + name, .bus = std::move(name)}; }

}  // namespace axisgate
