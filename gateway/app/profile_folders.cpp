#include "gateway/app/profile_folders.hpp"

#include <filesystem>

namespace axisgate::app {

namespace fs = std::filesystem;

std::vector<std::string> profile_folders(const std::string& given) {
  std::vector<std::string> folders;
  if (!given.empty()) folders.push_back(given);

  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const auto add = [&](const fs::path& folder) {
    if (fs::is_directory(folder, error)) folders.push_back(folder.string());
  };
  const fs::path bin = program.parent_path();
  add(bin.parent_path() / "share/axisgate/schemas/drives");
  // SOURCE/build/PRESET/bin/axisgate
  add(bin.parent_path().parent_path().parent_path() / "schemas/drives");
  add("/usr/share/axisgate/schemas/drives");
  return folders;
}

}  // namespace axisgate::app
