// SPDX-License-Identifier: Apache-2.0
// Which axis a person means on the command line: a number, or a name as the running gateway has it. Pure.
// Promises that what two axes could be called is refused, as is a configuration that calls them otherwise than the
// gateway does, with what to write instead. Never takes a part of a name, or a similar one, for the name.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "gateway/core/numbers.hpp"

namespace axisgate::commands {

using AxisNames = std::map<AxisNumber, std::string>;

/// 1..499, written in digits alone; none: it is a name.
[[nodiscard]] std::optional<AxisNumber> axis_number_in(std::string_view typed);
/// "500" and "-1" are neither a number of an axis nor what anybody would call one. Empty: it can be meant.
[[nodiscard]] std::string axis_mistake(const std::string& typed);

/// Adds the lines "3 lift" of one object of the device identification; lines that are none are left out.
void add_names(AxisNames& names, std::string_view object);

/// What a configuration calls the axes, and where it is.
struct ConfiguredNames {
  std::string file;
  AxisNames names;
};
/// The axis that is meant, or why none is.
/// @param reported what the gateway calls its axes
/// @param configured the configuration by which the gateway was found, which must call them the same; null: none was
[[nodiscard]] std::variant<AxisNumber, std::string> axis_meant(const std::string& typed, const AxisNames& reported,
                                                               const ConfiguredNames* configured);

}  // namespace axisgate::commands
