// SPDX-License-Identifier: Apache-2.0
#include "tests/stage/profile_once.hpp"

#include <map>
#include <stdexcept>

#include "tests/places.hpp"

namespace axisgate::test {

const profile::LoadedProfile& profile_once(const std::string& path) {
  static std::map<std::string, profile::LoadedProfile> known;
  if (!path.starts_with(source_path(""))) throw std::invalid_argument(path + " is no file of the source folder");
  auto found = known.find(path);
  if (found == known.end())
    found = known.emplace(path, profile::load_profile(path, {source_path("schemas/drives")})).first;
  return found->second;
}

const profile::LoadedProfile& shipped_profile(const std::string& name) {
  return profile_once(source_path("schemas/drives/") + name + ".json");
}

}  // namespace axisgate::test
