// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/commands.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <variant>

#include "gateway/commands/common/config_faults.hpp"
#include "gateway/config/config_loader.hpp"
#include "gateway/upstream/dds_host/dds_program.hpp"

namespace axisgate::commands {
namespace {

/// The network of the configuration, or the defaults; an exit code where there is none.
std::variant<dds::DdsSettings, int> settings_of(const TopicsOptions& options) {
  if (options.config.empty()) return dds::DdsSettings{};
  config::LoadResult result = config::load_config(options.config, options.profile_folders, profile::Pipes::allowed);
  if (const auto* faults = std::get_if<std::vector<config::ConfigFault>>(&result)) return tell(*faults);
  const config::Config& config = std::get<config::LoadedConfig>(result).config;
  if (config.dds) return *config.dds;
  fmt::print(stderr, "{}: there is no key \"dds\", so this gateway publishes no topics: add \"dds\": {{}}\n",
             options.config);
  return 1;
}

std::vector<std::string> arguments_of(dds::DdsSettings settings, const TopicsOptions& options) {
  if (options.domain) settings.domain = *options.domain;
  if (!options.interfaces.empty()) settings.interfaces = options.interfaces;
  std::vector<std::string> words{"axisgate-dds", "topics"};
  for (auto& word : dds::participant_arguments(settings)) words.push_back(std::move(word));
  if (options.all) {
    words.emplace_back("--all");
  } else if (!options.config.empty()) {
    words.push_back("--gateway=" + settings.gateway.name);
  }
  if (options.once) words.emplace_back("--once");
  if (options.json) words.emplace_back("--json");
  return words;
}

}  // namespace

int run(const TopicsOptions& options) {
  const auto settings = settings_of(options);
  if (const int* const code = std::get_if<int>(&settings)) return *code;
  const host::FoundProgram program = host::find_program(dds::kProgram);
  if (program.path.empty()) {
    fmt::print(stderr, "axisgate-dds is not installed: {}\n", program.why_not);
    return 1;
  }
  auto words = arguments_of(std::get<dds::DdsSettings>(settings), options);
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  ::execv(program.path.c_str(), argv.data());
  fmt::print(stderr, "{} cannot be run: {}\n", program.path, std::strerror(errno));
  return 1;
}

}  // namespace axisgate::commands
