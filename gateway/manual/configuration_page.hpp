// SPDX-License-Identifier: Apache-2.0
// The manual page gateway.json(5), in roff, made from the schema of a configuration.
// Promises each key that the schema has, in its order, with all that it says of it: docs/configuration.md has the same.
// Never asks for the time or the machine: one version of the program has one page.
#pragma once

#include <string>
#include <string_view>

namespace axisgate::manual {

/// @param schema draft-7; every object of it is reached by "properties", "items" and "$ref": "#/definitions/..."
[[nodiscard]] std::string configuration_page(std::string_view schema, const std::string& version);

}  // namespace axisgate::manual
