// SPDX-License-Identifier: Apache-2.0
// What `axisgate check` says of an axis's `watch`: what of it is watched, and what is done then.
// Promises to say so where a drive shows nothing that could be watched.
// Never refuses.
#pragma once

#include "gateway/check/check_lines.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::check {

[[nodiscard]] ReportLines watch_lines(const model::AxisModel& axis);

}  // namespace axisgate::check
