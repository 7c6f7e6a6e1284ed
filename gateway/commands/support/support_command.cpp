// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/support/support_command.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <string_view>

#include "gateway/commands/common/new_file.hpp"
#include "gateway/commands/support/archive.hpp"
#include "gateway/commands/support/gathering.hpp"
#include "gateway/commands/support/plan/manifest.hpp"
#include "gateway/commands/support/plan/redaction.hpp"
#include "gateway/profile/json/json_schema.hpp"

namespace axisgate::commands {
namespace {

using namespace support;

constexpr mode_t kOwnerAlone = 0600;
constexpr const char* kIsThere = "is there already, and is not written over";

Redaction redaction_of(const std::string& config) {
  const profile::FileRead read = profile::read_file(config);
  if (read.text) return redact(*read.text);
  Redaction out;
  out.why_none = "it cannot be read: there is no such file, or no right to read it";
  return out;
}

/// The file's name without its endings is the folder in the archive.
std::string folder_of(const std::string& output) {
  std::string name = std::filesystem::path(output).filename().string();
  name = name.substr(0, name.find(".tar"));
  constexpr std::size_t kRoomForFiles = 40;
  return name.substr(0, kLongestName - kRoomForFiles);
}

bool agreed(const SupportOptions& options, const std::string& output) {
  fmt::print("\nWrite this to {}? Only \"yes\" does: ", output);
  if (options.yes) fmt::print("yes (--yes)\n");
  std::fflush(stdout);
  if (options.yes) return true;
  std::string line;
  const bool answered = static_cast<bool>(std::getline(std::cin, line));
  if (!answered || ::isatty(STDIN_FILENO) == 0) fmt::print("{}\n", answered ? line : "no answer");
  return line == "yes";
}

}  // namespace

int run(const SupportOptions& options) {
  const auto now = std::chrono::system_clock::now();
  const auto made = fmt::gmtime(std::chrono::system_clock::to_time_t(now));
  const std::string output =
      options.output.empty() ? fmt::format("axisgate-support-{:%Y%m%dT%H%M%SZ}.tar.gz", made) : options.output;
  const auto refuse = [&](std::string_view why) {
    fmt::print(stderr, "axisgate support: {}: {}\n", output, why);
    return 1;
  };
  struct stat there {};
  if (::lstat(output.c_str(), &there) == 0) return refuse(kIsThere);
  fmt::print(stderr, "axisgate support: gathering, a minute at most\n");
  const Redaction redaction = redaction_of(options.config);
  const std::vector<Gathered> files =
      fit(gather({options.config, options.profile_folders, options.axisgate, options.patience}, redaction), redaction);
  const std::string list = manifest(files, redaction, fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", made), AXISGATE_VERSION);
  fmt::print("{}", list);
  if (!agreed(options, output)) return refuse("not written");
  const std::string folder = folder_of(output);
  std::vector<ArchivedFile> archived{{folder + "/README.txt", list}};
  for (const Gathered& file : files)
    if (!file.text.empty()) archived.push_back({folder + "/" + file.file, file.text});
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(now.time_since_epoch()).count();
  const std::string bytes = gzip_of(tar_of(archived, static_cast<std::uint64_t>(seconds)));
  if (const int error = write_new_file(output, bytes, kOwnerAlone); error != 0)
    return refuse(error == EEXIST ? kIsThere : std::strerror(error));
  fmt::print("{} is written, {} bytes: look into it before you give it away\n", output, bytes.size());
  return 0;
}

}  // namespace axisgate::commands
