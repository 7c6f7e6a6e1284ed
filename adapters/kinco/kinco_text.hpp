// SPDX-License-Identifier: Apache-2.0
// A Kinco frame in words, for the decode log: "write 6040.00 = 0x000F".
// Promises one short line for any frame, in the notation of the maker's tools (index.sub, hexadecimal).
// Never decides anything.
#pragma once

#include <string>

#include "adapters/kinco/kinco_codec.hpp"

namespace axisgate::kinco {

[[nodiscard]] std::string describe(const Frame& frame);

}  // namespace axisgate::kinco
