// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/commands/common/config_faults.hpp"
#include "gateway/commands/profile/made_file.hpp"
#include "gateway/commands/profile/making_commands.hpp"
#include "gateway/profile/json/json_schema.hpp"
#include "gateway/profile/make/upgrade.hpp"

namespace axisgate::commands {

int run(const ProfileUpgradeOptions& options) {
  std::vector<profile::FileRead> read;
  const auto loaded = profile::load_json(options.file, read, profile::Pipes::allowed);
  if (const auto* fault = std::get_if<profile::SchemaFault>(&loaded))
    return tell({{options.file, fault->pointer, fault->message, fault->place}});
  const profile::Upgraded upgraded = profile::upgraded(std::get<nlohmann::json>(loaded));
  if (!upgraded.fault.empty()) return tell({{options.file, "", upgraded.fault}});
  if (upgraded.changes.empty()) {
    fmt::print("{}: nothing in it is of an earlier axisgate\n", options.file);
    return 0;
  }
  profile::MadeProfile made;
  made.text = upgraded.text;
  made.notes = upgraded.changes;
  return write_made(made, {options.file, options.folder, upgraded.name, options.profile_folders});
}

}  // namespace axisgate::commands
