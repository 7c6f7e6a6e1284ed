// SPDX-License-Identifier: Apache-2.0
// The lines of the report that `axisgate check` prints: a label and what is said under it.
// Promises labels that line up.
// Never decides what is said.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/core/clock.hpp"

namespace axisgate::check {

/// Label and line, in their order; an empty label goes on with the one before.
using ReportLines = std::vector<std::pair<std::string, std::string>>;

[[nodiscard]] inline double in_ms(Duration duration) { return static_cast<double>(duration.count()) / 1e6; }

inline void add_line(std::string& out, std::string_view label, std::string_view line) {
  out += fmt::format("  {:<16}{}\n", label, line);
}

inline void add_lines(std::string& out, const ReportLines& lines) {
  for (const auto& [label, line] : lines) add_line(out, label, line);
}

}  // namespace axisgate::check
