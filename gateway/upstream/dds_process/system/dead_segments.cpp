// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/system/dead_segments.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace axisgate::dds {
namespace {

/// A file is made before it is locked.
constexpr std::time_t kYoungest = 2;
constexpr int kMostFiles = 10'000;

/// fastrtps_0123456789abcdef_el is the lock of the segment fastrtps_0123456789abcdef.
bool is_lock_of_a_segment(std::string_view name) {
  constexpr std::string_view kBefore = "fastrtps_", kAfter = "_el", kDigits = "0123456789abcdef";
  constexpr std::size_t kLength = 16;
  return name.size() == kBefore.size() + kLength + kAfter.size() && name.starts_with(kBefore) &&
         name.ends_with(kAfter) &&
         name.substr(kBefore.size(), kLength).find_first_not_of(kDigits) == std::string_view::npos;
}

void remove_if_dead(const std::filesystem::path& lock) {
  const int fd = ::open(lock.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (fd < 0) return;
  struct stat is {};
  const bool old_and_ours =
      ::fstat(fd, &is) == 0 && is.st_uid == ::geteuid() && std::time(nullptr) - is.st_ctime >= kYoungest;
  if (old_and_ours && ::flock(fd, LOCK_EX | LOCK_NB) == 0) {
    std::string segment = lock.string();
    segment.resize(segment.size() - std::string_view("_el").size());
    ::unlink(segment.c_str());
    ::unlink(lock.c_str());
  }
  ::close(fd);
}

}  // namespace

void remove_dead_segments(const std::string& folder) {
  std::error_code error;
  int left = kMostFiles;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end && left > 0;
       at.increment(error)) {
    if (is_lock_of_a_segment(at->path().filename().string())) remove_if_dead(at->path());
    --left;
  }
}

}  // namespace axisgate::dds
