// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/support/device_facts.hpp"

#include <fmt/format.h>
#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace axisgate::commands::support {
namespace {

namespace fs = std::filesystem;

/// Processes that are shown by name; of more, their number.
constexpr std::size_t kMostHolders = 20;

/// The first line of a file of /sys or /proc; empty: there is none.
std::string line_of(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

std::string user_name(uid_t number) {
  const passwd* const found = ::getpwuid(number);
  return found == nullptr ? std::to_string(number) : found->pw_name;
}
std::string group_name(gid_t number) {
  const group* const found = ::getgrgid(number);
  return found == nullptr ? std::to_string(number) : found->gr_name;
}

/// Of one process; `all`: false where this user may not see.
bool has_open(const fs::path& process, const fs::path& device, bool& all) {
  std::error_code failed;
  for (fs::directory_iterator each(process / "fd", failed), end; !failed && each != end; each.increment(failed)) {
    std::error_code gone;
    if (fs::read_symlink(*each, gone) == device) return true;
  }
  if (failed == std::errc::permission_denied) all = false;
  return false;
}

/// Without its command line, which may hold anything.
std::string holders(const fs::path& device) {
  std::string out;
  std::size_t count = 0;
  bool all = true;
  std::error_code failed;
  for (fs::directory_iterator each("/proc", failed), end; !failed && each != end; each.increment(failed)) {
    const std::string pid = each->path().filename().string();
    if (pid.find_first_not_of("0123456789") != std::string::npos || !has_open(each->path(), device, all)) continue;
    if (++count > kMostHolders) continue;
    struct stat own {};
    const bool known = ::stat(each->path().c_str(), &own) == 0;
    out += fmt::format("  open in {} (pid {}, user {})\n", line_of(each->path() / "comm"), pid,
                       known ? user_name(own.st_uid) : "?");
  }
  if (count > kMostHolders) out += fmt::format("  and in {} more\n", count - kMostHolders);
  if (count == 0) out += "  open in no process that can be seen\n";
  if (!all) out += "  processes of other users could not be looked at: root can\n";
  return out;
}

/// What udev has behind it, as far as the drivers of USB adapters tell.
std::string adapter_facts(const fs::path& device) {
  const fs::path tty = fs::path("/sys/class/tty") / device.filename();
  std::error_code failed;
  const fs::path driver = fs::read_symlink(tty / "device/driver", failed);
  std::string out;
  if (!failed) out += fmt::format("  driver {}\n", driver.filename().string());
  if (const std::string timer = line_of(tty / "device/latency_timer"); !timer.empty())
    out += fmt::format("  latency_timer {} ms\n", timer);
  return out;
}

std::string port_facts(const Device& device) {
  std::string out = fmt::format("{} (bus \"{}\")\n", device.path, device.bus);
  struct stat found {};
  if (::stat(device.path.c_str(), &found) != 0) return out + fmt::format("  {}\n", std::strerror(errno));
  std::error_code failed;
  const fs::path real = fs::canonical(device.path, failed);
  if (!failed && real != fs::path(device.path)) out += fmt::format("  is {}\n", real.string());
  out += S_ISCHR(found.st_mode) ? fmt::format("  character device {}:{}\n", major(found.st_rdev), minor(found.st_rdev))
                                : std::string("  is no character device\n");
  constexpr unsigned kRights = 07777;
  out += fmt::format("  owner {}, group {}, mode {:04o}\n", user_name(found.st_uid), group_name(found.st_gid),
                     found.st_mode & kRights);
  return out + adapter_facts(real) + holders(real);
}

std::string interface_facts(const Device& device) {
  std::string out = fmt::format("{} (bus \"{}\")\n", device.interface, device.bus);
  const fs::path here = fs::path("/sys/class/net") / device.interface;
  std::error_code failed;
  // A name with a '/' in it is a path to somewhere else.
  if (device.interface.find('/') != std::string::npos || !fs::exists(here, failed))
    return out + "  there is no such interface\n";
  for (const char* const fact : {"type", "operstate", "flags", "mtu", "tx_queue_len", "statistics/rx_packets",
                                 "statistics/tx_packets", "statistics/rx_errors", "statistics/tx_errors",
                                 "statistics/rx_dropped", "statistics/tx_dropped", "statistics/rx_over_errors"})
    out += fmt::format("  {} {}\n", fact, line_of(here / fact));
  return out;
}

}  // namespace

std::string device_facts(const Device& device) {
  return device.path.empty() ? interface_facts(device) : port_facts(device);
}

}  // namespace axisgate::commands::support
