// SPDX-License-Identifier: Apache-2.0
// What the makers' sheets leave open of a drive, and how fast it and its line are: drawn from a number. Promises the
// same for the same number. Never changes what a sheet says.
#pragma once

#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test::obey {

/// Of all drives of the line alike.
void draw_open_points(GatewayStage::Line& line, std::uint64_t number);

}  // namespace axisgate::test::obey
