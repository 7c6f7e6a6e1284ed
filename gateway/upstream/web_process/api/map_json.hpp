// SPDX-License-Identifier: Apache-2.0
// The register map of this gateway as it runs: `axisgate map` prints the same of a file.
// Promises the rows that the Modbus server answers from. Never more of it than an answer may have.
#pragma once

#include <optional>
#include <string>

#include "gateway/upstream/web_process/picture/picture.hpp"

namespace axisgate::web {

/// {rows: [...]}. @param axis its rows alone; none: all of the gateway
[[nodiscard]] std::string map_json(const Picture& picture, std::optional<std::uint16_t> axis);
/// The same as RFC 4180 has it.
[[nodiscard]] std::string map_csv(const Picture& picture, std::optional<std::uint16_t> axis);

}  // namespace axisgate::web
