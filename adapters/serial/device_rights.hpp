// SPDX-License-Identifier: Apache-2.0
// Why a process may not open a device, and what gives it the right: the group that the device belongs to.
// Promises words with the names that this system has, so that they can be typed as they stand. Never changes a right,
// and never asks anybody but the system's own files of users and groups.
#pragma once

#include <string>

namespace axisgate::serial {

/// What is known of a device that was refused.
struct DeviceRights {
  std::string group;           ///< of the device; a number where it has no name
  bool group_may = false;      ///< reading and writing is open to that group
  std::string user;            ///< who asks
  bool user_in_group = false;  ///< by the system's files: this process may have begun before
};

/// `: it belongs to group dialout ...`: the end of a message that says that it was not allowed. Pure.
[[nodiscard]] std::string rights_remedy(const DeviceRights& rights);

/// The same for this process and the device at `path`; empty where nothing can be found out about it.
[[nodiscard]] std::string rights_remedy_of(const std::string& path);

}  // namespace axisgate::serial
