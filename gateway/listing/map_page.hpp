// SPDX-License-Identifier: Apache-2.0
// The page schemas/register-map.md: the register map as documentation, the same for every configuration.
// Promises to be made from the one table, so that it cannot say anything else than the server does (a test compares).
// Never lists what a configuration adds: that is `axisgate map CONFIG`.
#pragma once

#include <string>

namespace axisgate::listing {

[[nodiscard]] std::string register_map_page();

}  // namespace axisgate::listing
