// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/common/profile_folders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>

#include "gateway/profile/read/profile_loader.hpp"

namespace axisgate::commands {

namespace fs = std::filesystem;

std::string no_folder(const std::string& given) {
  std::error_code error;
  return fs::is_directory(given, error) ? std::string() : fmt::format("'{}' is no folder", given);
}

std::vector<std::string> profile_folders(const std::string& given) {
  std::vector<std::string> folders;
  if (!given.empty()) folders.push_back(given);

  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const auto add = [&](const fs::path& folder) {
    const auto same = [&](const std::string& known) { return fs::equivalent(known, folder, error); };
    if (fs::is_directory(folder, error) && std::ranges::none_of(folders, same)) folders.push_back(folder.string());
  };
  const fs::path bin = program.parent_path();
  add(bin.parent_path() / "share/axisgate/schemas/drives");
  // SOURCE/build/PRESET/bin/axisgate
  add(bin.parent_path().parent_path().parent_path() / "schemas/drives");
  add("/usr/share/axisgate/schemas/drives");
  return folders;
}

std::vector<profile::Profile> profiles_in(const std::vector<std::string>& folders) {
  std::vector<profile::Profile> out;
  std::set<std::string> names;
  for (const std::string& folder : folders) {
    std::set<fs::path> files;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (entry.path().extension() == ".json") files.insert(entry.path());
    if (error) fmt::print(stderr, "{}: {}\n", folder, error.message());
    for (const fs::path& file : files) {
      if (!names.insert(file.stem().string()).second) continue;
      const profile::LoadedProfile loaded = profile::load_profile(file.string(), folders);
      if (loaded.base_only) continue;
      if (!loaded.faults.empty()) fmt::print(stderr, "left out: {}\n", text(loaded.faults.front()));
      if (loaded.faults.empty()) out.push_back(loaded.profile);
    }
  }
  return out;
}

}  // namespace axisgate::commands
