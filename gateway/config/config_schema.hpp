// SPDX-License-Identifier: Apache-2.0
// The JSON Schema of the gateway's configuration, as text inside the program.
// Promises that it is schemas/gateway.schema.json, word for word.
// Never reads a file.
#pragma once

#include <string_view>

namespace axisgate::config {

[[nodiscard]] std::string_view gateway_schema_text();

}  // namespace axisgate::config
