// SPDX-License-Identifier: Apache-2.0
// The document of a profile, put together from its files: what it extends, what its motors have alike, its own words.
// Promises one document without "extends", "each_axis" and "each", and of each place in it the file and the JSON
// pointer where it was written. Never judges what the document says: that is up to the schema and the section readers.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "gateway/profile/read/profile_loader.hpp"

namespace axisgate::profile {

/// How many files may stand behind one another by "extends", the first one not counted.
inline constexpr std::size_t kMaxBases = 4;
/// Entries of one "each".
inline constexpr std::size_t kMaxEach = 32;

struct LayeredProfile {
  std::shared_ptr<const nlohmann::json> document;  ///< never null
  WrittenPlaces written;                           ///< of every place in `document`
  std::vector<std::string> files;                  ///< the profile's own file first; also where one could not be read
  std::vector<FileRead> read;                      ///< of them, and of where a base was looked for before
  std::vector<Fault> faults;  ///< where there is one, the document lacks more than it is to blame for
};

/// `folders`: where a base is looked for that does not lie beside the file which extends it.
[[nodiscard]] LayeredProfile layered_profile(const std::string& path, const std::vector<std::string>& folders);

}  // namespace axisgate::profile
