// SPDX-License-Identifier: Apache-2.0
// The little of roff that a manual page needs: text as it stands, bold and slanted.
// Promises that no character of the text is taken for a request.
// Never lays anything out.
#pragma once

#include <string>

namespace axisgate::manual {

/// Text that roff prints as it stands.
[[nodiscard]] std::string plain(const std::string& text);
[[nodiscard]] std::string bold(const std::string& text);
[[nodiscard]] std::string slanted(const std::string& text);

}  // namespace axisgate::manual
