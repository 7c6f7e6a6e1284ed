// SPDX-License-Identifier: Apache-2.0
#include "adapters/serial/device_rights.hpp"

#include <fmt/format.h>
#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

namespace axisgate::serial {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// The local file, not the name service: that may ask a network, and this is called on the loop.
template <class Entry, class Wanted>
const Entry* entry_of(const File& file, Entry* (*next)(std::FILE*), const Wanted& wanted) {
  if (!file) return nullptr;
  while (const Entry* entry = next(file.get()))
    if (wanted(*entry)) return entry;
  return nullptr;
}

bool names(const group& of, const std::string& user) {
  for (char** member = of.gr_mem; *member != nullptr; ++member)
    if (user == *member) return true;
  return false;
}

}  // namespace

std::string rights_remedy(const DeviceRights& rights) {
  if (!rights.group_may)
    return fmt::format(
        ": it belongs to group {}, which may not read and write it either: a udev rule with GROUP=\"dialout\", "
        "MODE=\"0660\" opens it",
        rights.group);
  if (rights.user_in_group)
    return fmt::format(
        ": it belongs to group {}, and user {} is in it, but this process began before that: log in again, or restart "
        "the service",
        rights.group, rights.user);
  return fmt::format(
      ": it belongs to group {0}, and user {1} is not in it: usermod -aG {0} {1}, then log in again, or restart the "
      "service",
      rights.group, rights.user);
}

std::string rights_remedy_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  DeviceRights rights;
  const uid_t uid = ::geteuid();
  rights.user = std::to_string(uid);
  rights.group = std::to_string(status.st_gid);
  constexpr mode_t kReadAndWrite = S_IRGRP | S_IWGRP;
  rights.group_may = (status.st_mode & kReadAndWrite) == kReadAndWrite;
  const File users(std::fopen("/etc/passwd", "re"), &std::fclose);
  const File groups(std::fopen("/etc/group", "re"), &std::fclose);
  const passwd* user = entry_of(users, &::fgetpwent, [&](const passwd& each) { return each.pw_uid == uid; });
  const group* owner = entry_of(groups, &::fgetgrent, [&](const group& each) { return each.gr_gid == status.st_gid; });
  if (user != nullptr) rights.user = user->pw_name;
  if (owner != nullptr) rights.group = owner->gr_name;
  const bool first_group = user != nullptr && user->pw_gid == status.st_gid;
  rights.user_in_group = first_group || (owner != nullptr && names(*owner, rights.user));
  return rights_remedy(rights);
}

}  // namespace axisgate::serial
