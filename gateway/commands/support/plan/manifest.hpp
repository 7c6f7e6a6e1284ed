// SPDX-License-Identifier: Apache-2.0
// The files of the archive of `axisgate support`, and the list that is shown before it is written. Pure.
// Promises that no file and no archive is larger than it may be, that what was cut off says so, and that what could not
// be had stands in the list with the reason. Never leaves a file out in silence.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/commands/support/plan/redaction.hpp"

namespace axisgate::commands::support {

inline constexpr std::size_t kMostOfFile = 4U << 20U;
/// Of all files together, before they are compressed.
inline constexpr std::size_t kMostOfAll = 16U << 20U;

struct Gathered {
  std::string file{};  ///< "log.txt": its name in the archive
  std::string what{};  ///< in a few words
  std::string text{};
  std::string why_not{};        ///< there is none, or not all of it; in words
  bool newest_is_last = false;  ///< what is too much is cut off at the beginning
};

/// The same without what must stay here, and cut to what may go: everything that is written comes through here.
[[nodiscard]] std::vector<Gathered> fit(std::vector<Gathered> files, const Redaction& redaction);

/// The list, README.txt of the archive. @param files as fit() gives them @param made the instant,
/// "2026-11-29T07:20:00Z"
[[nodiscard]] std::string manifest(const std::vector<Gathered>& files, const Redaction& redaction,
                                   const std::string& made, const std::string& version);

}  // namespace axisgate::commands::support
