// SPDX-License-Identifier: Apache-2.0
// The grammar of a request's header (RFC 9112), by Boost.Beast, which is known here alone. Pure: bytes in, request out.
// Promises that nothing is taken that is no HTTP/1.0 or 1.1 request in origin form. Never looks at bounds:
// RequestReader has done so.
#pragma once

#include <optional>
#include <string_view>

#include "gateway/upstream/web_process/http/request.hpp"

namespace axisgate::web {

/// @param header whole, with the empty line that ends it
[[nodiscard]] std::optional<Request> parse_header(std::string_view header);

}  // namespace axisgate::web
