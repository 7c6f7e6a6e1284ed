// SPDX-License-Identifier: Apache-2.0
// A plant of 30 axes: every kind of drive on every protocol it speaks, on ten lines. Promises axes 1 to kAxes without
// a gap. Never has a drive that is not commissioned.
#pragma once

#include <vector>

#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test::long_day {

inline constexpr AxisNumber kAxes = 30;

[[nodiscard]] std::vector<GatewayStage::Line> plant();
[[nodiscard]] std::size_t drives_on(const GatewayStage::Line& line);

}  // namespace axisgate::test::long_day
