#include "adapters/serial/device_rights.hpp"

#include <fmt/format.h>
#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

namespace axisgate::serial {
namespace {

constexpr int kMostGroups = 1024;  // of one user; who has more is told to join once more

bool belongs(const passwd& user, gid_t group) {
  std::vector<gid_t> groups(kMostGroups);
  int count = kMostGroups;
  if (::getgrouplist(user.pw_name, user.pw_gid, groups.data(), &count) < 0) return false;
  groups.resize(static_cast<std::size_t>(count));
  return std::find(groups.begin(), groups.end(), group) != groups.end();
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
  const group* owner = ::getgrgid(status.st_gid);
  rights.group = owner == nullptr ? std::to_string(status.st_gid) : owner->gr_name;
  constexpr mode_t kReadAndWrite = S_IRGRP | S_IWGRP;
  rights.group_may = (status.st_mode & kReadAndWrite) == kReadAndWrite;
  const passwd* user = ::getpwuid(::geteuid());
  rights.user = user == nullptr ? std::to_string(::geteuid()) : user->pw_name;
  rights.user_in_group = user != nullptr && belongs(*user, status.st_gid);
  return rights_remedy(rights);
}

}  // namespace axisgate::serial
