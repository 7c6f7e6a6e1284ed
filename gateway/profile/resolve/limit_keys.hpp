// SPDX-License-Identifier: Apache-2.0
// Which key of the configuration's `limits` bounds a quantity. Promises one answer for who applies the limits and for
// who tells of them. Never knows a drive.
#pragma once

#include <string_view>

#include "gateway/model/model.hpp"

namespace axisgate::profile {

/// Empty: none does.
[[nodiscard]] std::string_view limit_key(Quantity quantity);

}  // namespace axisgate::profile
