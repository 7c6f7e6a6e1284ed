// SPDX-License-Identifier: Apache-2.0
// What a command ends with, beside 0 where it was done and 1 where it says no.
// Promises one number for one reason, whichever command it is.
// Never says anything.
#pragma once

namespace axisgate::commands {

/// An option or its value is wrong.
inline constexpr int kWrongCommandLine = 2;

}  // namespace axisgate::commands
