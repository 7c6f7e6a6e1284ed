// SPDX-License-Identifier: Apache-2.0
// Reads drive profiles.
// Promises every mistake of a profile at once, each with file, line, JSON pointer and what to change.
// Never resolves: what a profile says of one configured drive is gateway/profile/resolve's.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gateway/profile/json/json_fault.hpp"
#include "gateway/profile/read/profile.hpp"

namespace axisgate::profile {

/// Where something was written: a profile may say it in a file that it extends, or once for all its axes.
struct Written {
  std::string file;
  std::string pointer;
};
/// By the JSON pointer into the profile as a whole, with everything that it extends.
using WrittenPlaces = std::map<std::string, Written, std::less<>>;
/// Where `pointer` was written; of what is not there, where it would belong.
[[nodiscard]] Written written_at(const WrittenPlaces& places, const std::string& pointer);

/// How many files may stand behind one another by "extends", the first one not counted.
inline constexpr std::size_t kMaxBases = 4;
/// Entries of one "each".
inline constexpr std::size_t kMaxEach = 32;

/// The document of a profile, put together from its files: without "extends", "each_axis" and "each". Not judged yet.
struct LayeredProfile {
  std::shared_ptr<const nlohmann::json> document;  ///< null: nothing was read
  WrittenPlaces written;                           ///< of every place in `document`
  std::vector<std::string> files;                  ///< the profile's own file first; also where one could not be read
  std::vector<FileRead> read;                      ///< of them, and of where a base was looked for before it was found
  std::vector<Fault> faults;  ///< where there is one, the document lacks more than it is to blame for
};
/// `folders`: where a base is looked for that does not lie beside the file which extends it.
[[nodiscard]] LayeredProfile layered_profile(const std::string& path, const std::vector<std::string>& folders);

/// Its `faults` are empty: the profile is good, and only then may it be resolved.
struct LoadedProfile : LayeredProfile {
  std::string file;
  Profile profile;
  bool base_only = false;  ///< no drive: only others extend it (and a fault says so)
  std::string text;        ///< the whole JSON without spaces: whether two profiles say the same
};

/// schemas/drive-profile.schema.json, word for word: it travels inside the program.
[[nodiscard]] std::string_view profile_schema_text();

/// Never throws for what the file says; a file that cannot be read is a fault as well. A profile that it extends lies
/// beside it, or in the first of `folders` that has it.
[[nodiscard]] LoadedProfile load_profile(const std::string& path, const std::vector<std::string>& folders = {});

/// "kinco-jd" -> the first FOLDER/kinco-jd.json that exists; a name with '/' or ending in ".json" is a path already.
/// No value where there is none. Adds to `missed` where a folder before has none.
[[nodiscard]] std::optional<std::string> find_profile(const std::string& name_or_path,
                                                      const std::vector<std::string>& folders,
                                                      std::vector<FileRead>* missed = nullptr);

}  // namespace axisgate::profile
