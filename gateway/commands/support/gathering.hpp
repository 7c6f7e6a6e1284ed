// SPDX-License-Identifier: Apache-2.0
// Fetches what `axisgate support` gives away, one file after the other.
// Promises to end within kLongest and one patience more, whatever hangs: a page, a gateway, a disk, a drive. Only
// reads: it takes no lease and writes no register, so it never owns an axis. What could not be had has its reason.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "gateway/commands/support/plan/manifest.hpp"
#include "gateway/commands/support/plan/places.hpp"

namespace axisgate::commands::support {

/// What is asked for after that is not asked any more.
inline constexpr std::chrono::seconds kLongest{60};
/// Of one program, and of one answer of the page.
inline constexpr std::chrono::seconds kPatienceWithOne{10};

struct Asked {
  std::string config;                        ///< its path
  std::vector<std::string> profile_folders;  ///< the first is that of --profiles, where there is one
  std::string axisgate;                      ///< the program that says what `check` and `top` say
  std::chrono::milliseconds patience{kPatienceWithOne};
};

/// In the order of the list. @param redaction of the configuration, which is not read again
[[nodiscard]] std::vector<Gathered> gather(const Asked& asked, const Redaction& redaction);

}  // namespace axisgate::commands::support
