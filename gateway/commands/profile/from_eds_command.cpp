// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "gateway/commands/common/config_faults.hpp"
#include "gateway/commands/profile/base_profile.hpp"
#include "gateway/commands/profile/eds_file.hpp"
#include "gateway/commands/profile/made_file.hpp"
#include "gateway/commands/profile/making_commands.hpp"
#include "gateway/commands/profile/node_reader.hpp"
#include "gateway/profile/make/from_eds.hpp"
#include "gateway/profile/make/profile_text.hpp"

namespace axisgate::commands {
namespace {

std::string name_of(const ProfileFromEdsOptions& options, const profile::Eds& eds) {
  if (!options.name.empty()) return options.name;
  const std::string product = profile::plain_text(eds.product_name);
  return profile::profile_name(product.empty() ? std::filesystem::path(options.file).stem().string() : product);
}

/// What the drive itself says goes before its EDS; false: it said nothing.
bool ask_node(const ProfileFromEdsOptions& options, profile::Eds& eds) {
  const NodePlace place = node_place(options.node);
  const NodeReading reading = read_node(place, options.bitrate, profile::asked_of_node(eds));
  for (const profile::NodeAnswer& answer : reading.answers)
    fmt::print("  {:<14}{}\n", "answer", profile::take_answer(eds, answer, place.node));
  if (!reading.why.empty()) fmt::print(stderr, "{}\n", reading.why);
  return reading.why.empty();
}

}  // namespace

int run(const ProfileFromEdsOptions& options) {
  auto loaded = load_eds(options.file);
  if (const auto* faults = std::get_if<std::vector<config::ConfigFault>>(&loaded)) return tell(*faults);
  auto& eds = std::get<profile::Eds>(loaded);
  const std::string base_name = "cia402-generic";
  const BaseProfile base = base_profile(base_name, options.profile_folders);
  if (!base.faults.empty()) return tell(base.faults);
  const std::string name = name_of(options, eds);
  fmt::print("{}: {}, {} objects\n", options.file, identity_text(eds), eds.objects.size());
  print_remarks(eds);
  if (!options.node.empty() && !ask_node(options, eds)) return 1;
  const std::string file = std::filesystem::path(options.file).filename().string();
  return write_made(profile::profile_from_eds(eds, *base.document, {name, base_name, file}),
                    {options.file, options.folder, name, options.profile_folders, &eds});
}

}  // namespace axisgate::commands
