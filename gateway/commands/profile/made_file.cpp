// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/profile/made_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>

#include "gateway/commands/common/config_faults.hpp"
#include "gateway/commands/common/new_file.hpp"
#include "gateway/commands/profile/eds_file.hpp"
#include "gateway/profile/eds/eds_compare.hpp"
#include "gateway/profile/read/profile_loader.hpp"

namespace axisgate::commands {
namespace {

/// Why it could not be written; none: it is.
std::optional<std::string> write_new(const std::string& path, const std::string& text) {
  const int error = write_new_file(path, text);
  if (error == 0) return std::nullopt;
  return error == EEXIST ? std::string("is there already, and is not written over: move it away, or give --name or -o")
                         : std::string("cannot be written: ") + std::strerror(error);
}

/// What stands against the file as it is now.
std::vector<config::ConfigFault> judged(const profile::LoadedProfile& loaded, const MadeFile& file) {
  std::vector<config::ConfigFault> out = loaded.faults;
  if (!out.empty() || file.eds == nullptr) return out;
  for (const profile::EdsContradiction& found : profile::contradictions(loaded.profile, *file.eds)) {
    const profile::Written written = profile::written_at(loaded.written, found.pointer);
    out.push_back({written.file, written.pointer,
                   fmt::format("{} [{}]: {}", file.source, printable(found.section), printable(found.message))});
  }
  return out;
}

void print_all(const char* what, const std::vector<std::string>& lines) {
  for (const std::string& line : lines) fmt::print("  {:<14}{}\n", what, printable(line));
}

}  // namespace

int write_made(const profile::MadeProfile& made, const MadeFile& file) {
  std::vector<config::ConfigFault> faults;
  for (const std::string& fault : made.faults) faults.push_back({file.source, "", printable(fault)});
  if (!faults.empty()) return tell(faults);
  const std::string path = (std::filesystem::path(file.folder) / (file.name + ".json")).string();
  if (const auto why = write_new(path, made.text)) return tell({{path, "", *why}});
  const profile::LoadedProfile loaded = profile::load_profile(path, file.profile_folders);
  fmt::print("{} is written\n", path);
  print_all("note", made.notes);
  print_all("question", made.questions);
  if (!made.questions.empty())
    fmt::print("  {:<14}answer them in the file: write what they ask for and delete the entry of \"ask\"\n", "");
  std::fflush(stdout);
  return tell(judged(loaded, file));
}

}  // namespace axisgate::commands
