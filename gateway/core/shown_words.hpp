// SPDX-License-Identifier: Apache-2.0
// How the tables of `top` and `topics` tell a mode and an error: the words of words.hpp, and the number where there is
// none. Promises that both programs show the same. Never says whether a value is good now: that is for the caller to
// mark.
#pragma once

#include <cstdint>
#include <string>

namespace axisgate {

/// mode_display: "velocity"; of the maker's own "own -3", without a name "mode 11".
[[nodiscard]] std::string shown_mode(std::int16_t mode);
/// error_code: "none", "0x3210 overvoltage", and behind it what the drive says itself where that is not 0: "0x3210
/// overvoltage (0x8)". Of a fault whose cause is being read "not known yet"; without a fault "?".
[[nodiscard]] std::string shown_error(std::uint16_t code, std::uint32_t vendor, bool faulted);

}  // namespace axisgate
