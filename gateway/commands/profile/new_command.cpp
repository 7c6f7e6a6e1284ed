// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "gateway/commands/common/config_faults.hpp"
#include "gateway/commands/common/exit_codes.hpp"
#include "gateway/commands/profile/base_profile.hpp"
#include "gateway/commands/profile/eds_file.hpp"
#include "gateway/commands/profile/made_file.hpp"
#include "gateway/commands/profile/making_commands.hpp"
#include "gateway/profile/make/from_form.hpp"
#include "gateway/profile/make/profile_text.hpp"

namespace axisgate::commands {
namespace {

profile::MadeProfile made(const profile::Form& form, const profile::FromEds& what, const BaseProfile& base,
                          bool canopen) {
  if (canopen) return profile::profile_from_eds(profile::eds_of(form), *base.document, what);
  return base.document ? profile::profile_like(form, *base.document, what) : profile::profile_from_form(form, what);
}

}  // namespace

int run(const ProfileNewOptions& options) {
  if (options.modbus.empty() && options.canopen.empty()) {
    fmt::print(stderr, "axisgate profile new: needs --modbus FILE or --canopen FILE\n");
    return kWrongCommandLine;
  }
  const bool canopen = !options.canopen.empty();
  const std::string& table = canopen ? options.canopen : options.modbus;
  const auto text = content_of(table, profile::kMaxFormBytes);
  if (const auto* fault = std::get_if<config::ConfigFault>(&text)) return tell({*fault});
  const profile::Form form =
      profile::parse_form(std::get<std::string>(text), canopen ? profile::FormOf::canopen : profile::FormOf::modbus);
  if (!form.faults.empty()) return tell(faults_of(table, form.faults));
  const std::filesystem::path file(table);
  const std::string name = options.name.empty() ? profile::profile_name(file.stem().string()) : options.name;
  const std::string like = options.like.empty() && canopen ? "cia402-generic" : options.like;
  BaseProfile base;
  if (!like.empty()) base = base_profile(like, options.profile_folders);
  if (!base.faults.empty()) return tell(base.faults);
  fmt::print("{}: {} rows\n", table, form.rows.size());
  return write_made(made(form, {name, like, file.filename().string()}, base, canopen),
                    {table, options.folder, name, options.profile_folders});
}

}  // namespace axisgate::commands
