// SPDX-License-Identifier: Apache-2.0
// What the section "web" says of captures where it says nothing: axisgate-web goes by these values, and `axisgate
// check` prints them. Promises the defaults of the schema (keys before_s, after_s, keep of "captures"). Never read for
// a key that is given.
#pragma once

#include <cstddef>

namespace axisgate::web {

inline constexpr int kCaptureBeforeS = 10;  ///< seconds before the cause
inline constexpr int kCaptureAfterS = 5;    ///< seconds behind it
inline constexpr std::size_t kCapturesKept = 20;

}  // namespace axisgate::web
