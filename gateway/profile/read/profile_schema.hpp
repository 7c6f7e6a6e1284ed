// SPDX-License-Identifier: Apache-2.0
// The JSON Schema of drive profiles, as text inside the program.
// Promises that it is schemas/drive-profile.schema.json, word for word.
// Never reads a file.
#pragma once

#include <string_view>

namespace axisgate::profile {

[[nodiscard]] std::string_view profile_schema_text();

}  // namespace axisgate::profile
