// SPDX-License-Identifier: Apache-2.0
// The rows themselves, block by block, as design 3.1 prints them. Promises to be read beside that page, top to bottom.
// Never used but by register_map.cpp.
#pragma once

#include <vector>

#include "gateway/image/register_map.hpp"

namespace axisgate {

[[nodiscard]] std::vector<RegisterRow> axis_register_rows();
[[nodiscard]] std::vector<RegisterRow> overview_register_rows();
[[nodiscard]] std::vector<RegisterRow> gateway_register_rows();
[[nodiscard]] std::vector<RegisterRow> bus_register_rows();

}  // namespace axisgate
