// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/options.hpp"

#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "gateway/manual/generate.hpp"
#include "gateway/upstream/link/exit_codes.hpp"

namespace axisgate::web {
namespace {

struct SettingsFault {
  std::string text;
};

std::uint32_t number_in(const nlohmann::json& section, const char* key, std::uint32_t least, std::uint32_t most,
                        std::uint32_t without) {
  if (!section.contains(key)) return without;
  const nlohmann::json& given = section[key];
  if (!given.is_number_integer() || given < least || given > most)
    throw SettingsFault{std::string(key) + ": a whole number from " + std::to_string(least) + " to " +
                        std::to_string(most)};
  return given.get<std::uint32_t>();
}

std::vector<std::string> texts_in(const nlohmann::json& section, const char* key, std::vector<std::string> without) {
  if (!section.contains(key)) return without;
  std::vector<std::string> out;
  for (const nlohmann::json& each : section[key]) {
    if (!each.is_string()) throw SettingsFault{std::string(key) + ": a list of texts"};
    out.push_back(each.get<std::string>());
  }
  return out;
}

Settings settings_of(const nlohmann::json& section) {
  constexpr std::uint32_t kMostConnections = 10000, kMostStreams = 1000, kLeastMemory = 32, kMostMemory = 4096;
  if (!section.is_object()) throw SettingsFault{"no object"};
  Settings out;
  out.listen = texts_in(section, "listen", out.listen);
  if (out.listen.empty()) throw SettingsFault{"listen: one address at least"};
  out.hosts = texts_in(section, "hosts", {});
  if (section.contains("insecure")) {
    if (!section["insecure"].is_boolean()) throw SettingsFault{"insecure: true or false"};
    out.insecure = section["insecure"].get<bool>();
  }
  for (const std::string& each : texts_in(section, "allow", {})) {
    const auto network = parse_network(each);
    if (!network) throw SettingsFault{"allow: '" + each + "' is no network: 192.168.1.0/24, fd00::/8"};
    out.allow.push_back(*network);
  }
  out.max_connections =
      number_in(section, "max_connections", 1, kMostConnections, static_cast<std::uint32_t>(out.max_connections));
  out.max_streams = number_in(section, "max_streams", 1, kMostStreams, static_cast<std::uint32_t>(out.max_streams));
  out.memory_limit_mb = number_in(section, "memory_limit_mb", kLeastMemory, kMostMemory, out.memory_limit_mb);
  return out;
}

}  // namespace

std::variant<Settings, std::string> parse_settings(std::string_view json) {
  const nlohmann::json section = nlohmann::json::parse(json, nullptr, false);
  try {
    return settings_of(section);
  } catch (const SettingsFault& fault) {
    return fault.text;
  }
}

std::variant<int, ServeOptions> parse_command_line(int argc, char** argv) {
  ServeOptions serve;
  std::string settings = "{}";
  CLI::App app{"The page and the API of axisgate", "axisgate-web"};
  app.set_version_flag("--version", AXISGATE_VERSION);
  app.set_help_all_flag("--help-all", "Help of all commands");
  app.require_subcommand(1);
  CLI::App* command =
      app.add_subcommand("serve", "Show the axes of the gateway that started this program (not for people)");
  command->add_option("--link-fd", serve.link_fd, "descriptor of the gateway's socket")
      ->required()
      ->check(CLI::NonNegativeNumber)
      ->type_name("N");
  command->add_option("--settings", settings, "the section \"web\" of the configuration, resolved")
      ->check([&serve](const std::string& text) {
        const auto parsed = parse_settings(text);
        if (const auto* fault = std::get_if<std::string>(&parsed)) return *fault;
        serve.settings = std::get<Settings>(parsed);
        return std::string();
      })
      ->type_name("JSON");
  if (const auto text = manual::generated(app, argc, argv)) {
    std::cout << *text;
    return 0;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error, std::cout, std::cerr) == 0 ? 0 : link::kExitUsage;
  }
  return serve;
}

}  // namespace axisgate::web
