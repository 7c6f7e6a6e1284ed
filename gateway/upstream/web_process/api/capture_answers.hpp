// SPDX-License-Identifier: Apache-2.0
// /captures and what is below it: the list, one capture, one as a table.
// Promises that an id which is not there is refused by name. Never changes or removes a capture.
#pragma once

#include "gateway/upstream/web_process/api/asked.hpp"

namespace axisgate::web {

/// Slices of a line, where nobody says otherwise: all lines of an axis together stay below kMaxJson.
inline constexpr std::uint64_t kCapturePoints = 400;

[[nodiscard]] Answer captures_answer(const Asked& asked, Query& query);
/// "42.1700", "42.1700.csv"
[[nodiscard]] Answer capture_answer(const Asked& asked, Query& query);

}  // namespace axisgate::web
