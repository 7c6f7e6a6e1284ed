// SPDX-License-Identifier: Apache-2.0
// openapi.json, as it was when the program was built.
// Promises the file's own bytes; a test holds it against the answers.
// Never made by the program.
#pragma once

#include <string_view>

namespace axisgate::web {

[[nodiscard]] std::string_view openapi_text();

}  // namespace axisgate::web
