// SPDX-License-Identifier: Apache-2.0
// One mistake in a JSON file, a configuration or a profile: where it is and what to change.
// Promises the same form everywhere: "FILE:LINE:COLUMN: /json/pointer: message", as compilers write it and editors
// follow it. Never stands for a mistake of the program itself.
#pragma once

#include <string>
#include <vector>

#include "gateway/profile/json/json_places.hpp"
#include "gateway/profile/json/json_schema.hpp"

namespace axisgate::profile {

struct Fault {
  std::string file;
  std::string pointer;  ///< RFC 6901; empty: the whole file
  std::string message;  ///< what is wrong, and what to change
  JsonPlace place{};    ///< none: it is not known, or the whole file
  friend bool operator==(const Fault&, const Fault&) = default;
};
[[nodiscard]] std::string text(const Fault& fault);

/// Gives those that have no place theirs, in the text of their file as it is among `read`.
void locate(std::vector<Fault>& faults, const std::vector<FileRead>& read);

}  // namespace axisgate::profile
