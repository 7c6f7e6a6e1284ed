// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>

#include "gateway/core/name_table.hpp"
#include "gateway/core/numbers.hpp"
#include "gateway/manual/generate.hpp"
#include "gateway/upstream/link/exit_codes.hpp"
#include "gateway/upstream/web_process/values/value_names.hpp"

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
  constexpr std::uint32_t kMostConnections = 10000, kMostStreams = 1000, kLeastMemory = 32, kMostMemory = 4096,
                          kLeastHistory = 4, kMostHistory = 1024;
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
  out.history_mb = number_in(section, "history_mb", kLeastHistory, kMostHistory, out.history_mb);
  out.memory_limit_mb = number_in(section, "memory_limit_mb", kLeastMemory, kMostMemory, out.memory_limit_mb);
  return out;
}

double decimal_in(const nlohmann::json& section, const char* key, double least, double most, double without) {
  if (!section.contains(key)) return without;
  const nlohmann::json& given = section[key];
  if (!given.is_number() || given < least || given > most)
    throw SettingsFault{fmt::format("{}: a number from {} to {}", key, least, most)};
  return given.get<double>();
}

SteadyNs seconds_in(const nlohmann::json& section, const char* key, SteadyNs without) {
  constexpr double kMost = 60;
  constexpr auto kOne = static_cast<double>(kSecond);
  return static_cast<SteadyNs>(decimal_in(section, key, 0, kMost, static_cast<double>(without) / kOne) * kOne);
}

constexpr auto kTriggersAre = names_of<TriggerIs>({{TriggerIs::above, "above"},
                                                   {TriggerIs::below, "below"},
                                                   {TriggerIs::outside, "outside"},
                                                   {TriggerIs::bit_set, "bit_set"},
                                                   {TriggerIs::bit_clear, "bit_clear"},
                                                   {TriggerIs::changes, "changes"}});
static_assert(kTriggersAre.has_all_to(TriggerIs::changes));

std::string text_in(const nlohmann::json& section, const char* key) {
  const auto found = section.is_object() ? section.find(key) : section.end();
  if (found == section.end() || !found->is_string()) throw SettingsFault{std::string(key) + ": a text"};
  return found->get<std::string>();
}

Trigger trigger_of(const nlohmann::json& given) {
  constexpr double kAny = std::numeric_limits<double>::max();
  constexpr std::uint32_t kLastBit = 31;
  Trigger out;
  out.name = text_in(given, "name");
  out.axis = static_cast<std::uint16_t>(number_in(given, "axis", 1, kMaxAxisNumber, 0));
  const auto quantity = value_named(text_in(given, "quantity"));
  const auto is = kTriggersAre.named(text_in(given, "is"));
  if (out.axis == 0 || !quantity || !is) throw SettingsFault{"triggers: '" + out.name + "' is none"};
  out.quantity = *quantity;
  out.is = *is;
  const bool of_bits = out.is == TriggerIs::bit_set || out.is == TriggerIs::bit_clear;
  if (of_bits) out.bit = number_in(given, "value", 0, kLastBit, 0);
  const double value = of_bits ? 0 : decimal_in(given, "value", -kAny, kAny, 0);
  out.min = decimal_in(given, "min", -kAny, kAny, value);
  out.max = decimal_in(given, "max", -kAny, kAny, value);
  return out;
}

CaptureSettings captures_of(const nlohmann::json& section) {
  constexpr std::uint32_t kMostKept = 200;
  if (!section.is_object()) throw SettingsFault{"no object"};
  const nlohmann::json given = section.value("captures", nlohmann::json::object());
  const nlohmann::json triggers = section.value("triggers", nlohmann::json::array());
  if (!given.is_object() || !triggers.is_array()) throw SettingsFault{"captures, triggers: an object, a list"};
  CaptureSettings out;
  out.before = seconds_in(given, "before_s", out.before);
  out.after = seconds_in(given, "after_s", out.after);
  out.keep = number_in(given, "keep", 1, kMostKept, static_cast<std::uint32_t>(out.keep));
  if (given.contains("folder") && !given["folder"].is_null()) out.folder = text_in(given, "folder");
  for (const nlohmann::json& each : triggers) out.triggers.push_back(trigger_of(each));
  return out;
}

template <typename Of>
auto parsed(std::string_view json, Of of) -> std::variant<decltype(of(nlohmann::json())), std::string> {
  try {
    return of(nlohmann::json::parse(json, nullptr, false));
  } catch (const SettingsFault& fault) {
    return fault.text;
  }
}

}  // namespace

std::variant<Settings, std::string> parse_settings(std::string_view json) { return parsed(json, settings_of); }

std::variant<CaptureSettings, std::string> parse_captures(std::string_view json) { return parsed(json, captures_of); }

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
        const auto served = parse_settings(text);
        const auto captured = parse_captures(text);
        if (const auto* fault = std::get_if<std::string>(&served)) return *fault;
        if (const auto* fault = std::get_if<std::string>(&captured)) return *fault;
        serve.settings = std::get<Settings>(served);
        serve.captures = std::get<CaptureSettings>(captured);
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
