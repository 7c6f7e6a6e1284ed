// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "gateway/commands/command_manual.hpp"
#include "gateway/commands/command_parameters.hpp"
#include "gateway/commands/command_profile.hpp"
#include "gateway/commands/command_support.hpp"
#include "gateway/commands/command_words.hpp"
#include "gateway/commands/commands.hpp"
#include "gateway/commands/commission/commission_command.hpp"
#include "gateway/commands/common/exit_codes.hpp"
#include "gateway/commands/common/profile_folders.hpp"
#include "gateway/commands/record/plan/request.hpp"
#include "gateway/commands/record/record_command.hpp"
#include "gateway/commands/run_command.hpp"
#include "gateway/commands/scan/scan_command.hpp"
#include "gateway/commands/top/top_command.hpp"
#include "gateway/config/config_schema.hpp"
#include "gateway/manual/configuration_page.hpp"
#include "gateway/manual/generate.hpp"

namespace axisgate::commands {
namespace {

/// Everything that options are read into; commands copy from it when they run.
struct Parsed {
  std::string profiles;
  RunOptions run;
  CheckOptions check;
  MapOptions map;
  TopOptions top;
  RecordOptions record;
  TopicsOptions topics;
  ProfileCommands profile;
  CommissionOptions commission;
  ParametersCommands parameters;
  ScanOptions scan;
  ExplainOptions explain;
  ReloadOptions reload;
  SupportOptions support;
  ManualCommands manual;
  std::string scan_nodes;
  std::string scan_stations;
  std::function<int()> chosen;
};

void add_profiles(CLI::App& command, Parsed& parsed) {
  command.add_option("--profiles", parsed.profiles, "folder of drive profiles, searched before the shipped ones")
      ->check(CLI::Validator(no_folder, ""))
      ->type_name("DIR");
}

/// An option whose value is a whole number; what it has at the beginning is its default.
CLI::Option* add_number(CLI::App& command, const std::string& name, auto& value, int least, int most,
                        const std::string& what) {
  return command.add_option(name, value, what)
      ->check(CLI::Range(least, most).description(""))
      ->type_name("N")
      ->capture_default_str();
}

/// A command that reads a configuration.
CLI::App* add_config_command(CLI::App& app, Parsed& parsed, const std::string& name, const std::string& what,
                             std::string& config) {
  CLI::App* command = app.add_subcommand(name, what);
  command->add_option("CONFIG", config, "configuration file (JSON)")->required();
  add_profiles(*command, parsed);
  return command;
}

template <typename Options>
void choose_with_folders(Parsed& parsed, Options& options) {
  parsed.chosen = [&parsed, &options] {
    options.profile_folders = profile_folders(parsed.profiles);
    return run(options);
  };
}

void add_run(CLI::App& app, Parsed& parsed) {
  CLI::App* command = add_config_command(app, parsed, "run", "Run the gateway", parsed.run.config);
  const auto number = [](LogLevel level) { return static_cast<int>(level); };
  command->add_option("--log-level", parsed.run.log_level, "error, warning, info or debug")
      ->transform(number_of_one({{"error", number(LogLevel::error)},
                                 {"warning", number(LogLevel::warning)},
                                 {"info", number(LogLevel::info)},
                                 {"debug", number(LogLevel::debug)}}))
      ->type_name("LEVEL")
      ->default_str("info");
  command->add_option("--decode", parsed.run.decode, "log every frame of this bus; may be given more than once")
      ->type_name("BUS");
  command->footer("Example: axisgate run /etc/axisgate/gateway.json --decode lift-serial");
  command->callback([&parsed] { choose_with_folders(parsed, parsed.run); });
}

void add_check(CLI::App& app, Parsed& parsed) {
  CLI::App* command = add_config_command(
      app, parsed, "check", "Validate a configuration and print the plan of each bus", parsed.check.config);
  command->footer(
      "Exit code 1: mistakes (each with file, line, column and JSON pointer), or a bus planned over 100 %.\n"
      "Example: axisgate check /etc/axisgate/gateway.json");
  command->callback([&parsed] { choose_with_folders(parsed, parsed.check); });
}

void add_map(CLI::App& app, Parsed& parsed) {
  CLI::App* command = add_config_command(app, parsed, "map", "Print every register, coil and input", parsed.map.config);
  command->add_option("--format", parsed.map.format, "table, md, csv, json or st (IEC 61131-3)")
      ->check(one_of({"table", "md", "csv", "json", "st"}))
      ->type_name("FORMAT")
      ->capture_default_str();
  command
      ->add_option("--listener", parsed.map.listener,
                   "as this listener shows it, by its \"listen\"; without it the first one")
      ->type_name("HOST:PORT");
  command->footer("Example: axisgate map /etc/axisgate/gateway.json --format csv > registers.csv");
  command->callback([&parsed] { choose_with_folders(parsed, parsed.map); });
}

void add_top(CLI::App& app, Parsed& parsed) {
  CLI::App* command = app.add_subcommand("top", "Live table of all axes of a running gateway");
  add_endpoint(*command, parsed.top.endpoint);
  command->add_option(
      "CONFIG", parsed.top.config,
      "its configuration file: axes are shown with their names, and in turns; without HOST:PORT it says "
      "where the gateway listens");
  add_profiles(*command, parsed);
  add_number(*command, "--interval", parsed.top.interval_ms, 50, 60000, "milliseconds between two tables")
      ->type_name("MS");
  add_number(*command, "--seconds", parsed.top.seconds, 0, 86400, "end after so long; 0: until Ctrl-C");
  add_number(*command, "--count", parsed.top.count, 0, 1000000, "end after so many tables; 0: no such end");
  command->add_flag("--plain", parsed.top.plain, "print one table after the other, for pipes and logs");
  command->add_flag_callback(
      "--once", [&parsed] { parsed.top.count = 1; },
      "one table, then the end; exit code 1: the gateway does not answer (for health checks)");
  command->add_option("--note", parsed.top.notes, "a line to show below the table, on a terminal; once for each line")
      ->allow_extra_args(false)
      ->type_name("TEXT");
  command->footer(
      "A terminal of 80 columns is enough. Red is what fails, yellow what one should know; NO_COLOR=1 leaves colours "
      "out.\n"
      "What an axis did before is in the history of the page: axisgate record AXIS --before 30.\n"
      "Example: axisgate top 127.0.0.1:1502; axisgate top");
  command->callback([&parsed] { choose_with_folders(parsed, parsed.top); });
}

void add_record(CLI::App& app, Parsed& parsed) {
  CLI::App* command =
      app.add_subcommand("record", "Record what axes do, as CSV, from the history of a running gateway's page");
  command->add_option("AXIS", parsed.record.axes, "axis numbers, or names")
      ->required()
      ->check(CLI::Validator(axis_mistake, ""));
  CLI::Option* const seconds = add_number(*command, "--seconds", parsed.record.seconds, 1, 3600, "record for so long");
  add_number(*command, "--before", parsed.record.before, 1, 3600, "instead: the seconds before now, at once")
      ->excludes(seconds)
      ->default_str("");
  command
      ->add_option("--series", parsed.record.series,
                   "values by their names in the API, with commas between, such as velocity_rpm,following_error_rev; "
                   "without it position_rev, velocity_rpm, torque_percent, current_a, axis_state, or of many axes the "
                   "first of them")
      ->check(CLI::Validator(record::series_mistake, ""))
      ->type_name("NAME,...");
  // The one form there is; named, it stays what it is where another comes.
  command->add_flag_callback(
      "--csv", [] {}, "as CSV (RFC 4180), as without it");
  command->add_option("--output", parsed.record.output, "write to this file instead of standard output")
      ->type_name("FILE");
  CLI::Option* const url = command->add_option("--url", parsed.record.url, "the page")
                               ->check(CLI::Validator(record::page_url_mistake, ""))
                               ->type_name("URL")
                               ->capture_default_str();
  command->add_option("--config", parsed.record.config, "the gateway's configuration file: where its page is")
      ->excludes(url)
      ->type_name("CONFIG");
  add_profiles(*command, parsed);
  command->footer(
      "It needs the page (\"web\" in the configuration), which keeps the last minute or more of every axis, and causes "
      "no "
      "exchange on\na bus. At most 16 series at once. A row is an instant: its time in UTC, the values, and what "
      "happened "
      "then; what is not\nknown is empty. Ctrl-C ends it with what there is by then.\n"
      "Exit code 1: there is no page or no such axis, or the history did not hold all of it, which is said.\n"
      "Example: axisgate record lift table --seconds 20 --output lift.csv; axisgate record 1 --before 30 > "
      "stopped.csv");
  command->callback([&parsed] { choose_with_folders(parsed, parsed.record); });
}

void add_topics(CLI::App& app, Parsed& parsed) {
  CLI::App* command = app.add_subcommand("topics", "Show all axes live, as DDS subscribers see them");
  command->add_option("CONFIG", parsed.topics.config, "the gateway's configuration file: where it publishes");
  add_profiles(*command, parsed);
  command->add_option("--domain", parsed.topics.domain, "DDS domain; goes before that of CONFIG")
      ->check(CLI::Range(0, 232).description(""))
      ->type_name("N");
  command
      ->add_option("--interface", parsed.topics.interfaces,
                   "network interface, by name or IPv4 address; may be given more than once")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_flag("--all", parsed.topics.all,
                    "every gateway of the domain, with a table of them; else that of CONFIG alone");
  command->add_flag("--once", parsed.topics.once, "print what is there and end");
  command->add_flag("--json", parsed.topics.json, "one JSON object a line for each sample");
  command->footer("Example: axisgate topics /etc/axisgate/gateway.json");
  command->callback([&parsed] { choose_with_folders(parsed, parsed.topics); });
}

void add_commission(CLI::App& app, Parsed& parsed) {
  CLI::App* command =
      add_config_command(app, parsed, "commission",
                         "Show settings of a drive that a person must decide, ask about each, and apply its remedy",
                         parsed.commission.config);
  command->add_option("AXIS", parsed.commission.axis, "axis number, or name")->required();
  command->add_flag("--yes", parsed.commission.yes,
                    "answer yes to every question, also to those that take the limit inputs away");
  command->footer(
      "The gateway must not be running: the command needs the bus for itself. It never enables or moves an axis.\n"
      "One question for each setting that is bad: only 'yes' writes what the question names, the end of the input is a "
      "no.\nBefore a write the drive is read again: what changed since the question, or has torque, is not written.\n"
      "Exit code 1: something was left as it is, or the drive cannot be reached.\n"
      "Example: axisgate commission /etc/axisgate/gateway.json 1; axisgate commission gateway.json lift");
  command->callback([&parsed] { choose_with_folders(parsed, parsed.commission); });
}

std::string station_range_mistake(const std::string& text) {
  return parse_scan_range(text, kLastRtuStation)
             ? ""
             : "'" + text + "' is no station and no range of them: 1 to 247, such as 5 or 1-32";
}

std::string scan_range_mistake(const std::string& text) {
  return parse_scan_range(text) ? "" : "'" + text + "' is no node-ID and no range of them: 1 to 127, such as 5 or 1-10";
}

void add_scan(CLI::App& app, Parsed& parsed) {
  CLI::App* command =
      app.add_subcommand("scan", "Ask a CANopen bus or a serial line which drives are there and what they are");
  command
      ->add_option("DEVICE", parsed.scan.device,
                   "CAN interface (can0), slcan:PATH for a serial CAN adapter, or a serial port (/dev/ttyUSB0)")
      ->required();
  command
      ->add_option("--bitrate", parsed.scan.bitrate,
                   "bits per second, as set in the drives; a serial adapter is opened with it")
      ->type_name("N")
      ->capture_default_str();
  add_profiles(*command, parsed);
  add_number(*command, "--timeout-ms", parsed.scan.timeout_ms, 2, 10000, "how long each answer is waited for");
  command->add_option("--nodes", parsed.scan_nodes, "node-IDs to ask")
      ->check(CLI::Validator(scan_range_mistake, ""))
      ->type_name("A-B")
      ->default_str("1-127");
  command
      ->add_option("--baud", parsed.scan.serial.bauds, "serial port: rates to try, one after the other, as 38400,19200")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1200, 1000000).description(""))
      ->type_name("N,...")
      ->default_str("38400,19200,9600,115200");
  command->add_option("--stations", parsed.scan_stations, "serial port: stations to ask")
      ->check(CLI::Validator(station_range_mistake, ""))
      ->type_name("A-B")
      ->default_str("1-32");
  command->add_option("--protocol", parsed.scan.serial.protocols, "serial port: kinco-serial, modbus-rtu, or both")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(one_of({"kinco-serial", "modbus-rtu"}))
      ->type_name("P,...")
      ->default_str("kinco-serial,modbus-rtu");
  command->add_option("--parity", parsed.scan.parity, "serial port: none, even or odd")
      ->check(one_of({"none", "even", "odd"}))
      ->type_name("P")
      ->capture_default_str();
  command->footer(
      "On CAN CANopen alone: drives that speak another protocol, Keya's own on CAN among them, are not found by it.\n"
      "On a serial port Kinco's own protocol and Modbus RTU; Keya's drives are not asked there: what they answer is no "
      "reply\nto a station. How long it takes at most is said before. A line that is in use, at another rate than the "
      "one tried, hears\nnoise: scan one whose motors stand without torque. A port that a gateway has is refused.\n"
      "It reads (SDO, Kinco's read frame, function 3), and writes, starts and resets nothing. Exit code 1: nobody "
      "answered, or the bus cannot be "
      "used.\n"
      "A gateway that runs on the same bus is another SDO client: the drives answer both under one number, so stop it\n"
      "first. A serial adapter opened with a wrong bit rate disturbs a bus that is in use.\n"
      "Makers do not print their identity numbers: a profile fits as far as the node has the profile's objects.\n"
      "Example: axisgate scan can0; axisgate scan /dev/ttyUSB0 --baud 38400 --stations 1-8");
  command->callback([&parsed] {
    if (const auto range = parse_scan_range(parsed.scan_nodes)) parsed.scan.nodes = *range;
    if (const auto range = parse_scan_range(parsed.scan_stations, kLastRtuStation))
      parsed.scan.serial.stations = *range;
    choose_with_folders(parsed, parsed.scan);
  });
}

void add_reload(CLI::App& app, Parsed& parsed) {
  CLI::App* command = app.add_subcommand("reload", "Have the running gateway read its configuration anew");
  command->add_option("CONFIG", parsed.reload.config, "the file that the gateway was started with")->required();
  command->footer(
      "Only buses and listeners that change are restarted, and only while the axes of these buses are online and "
      "disabled; else\n"
      "nothing is changed and the reasons are told (exit code 1).\n"
      "Example: axisgate check /etc/axisgate/gateway.json && axisgate reload /etc/axisgate/gateway.json");
  command->callback([&parsed] { parsed.chosen = [&parsed] { return run(parsed.reload); }; });
}

void add_explain(CLI::App& app, Parsed& parsed) {
  CLI::App* command =
      app.add_subcommand("explain", "Say what a state, alarm, result, exception or fault code means, and what to do");
  command->add_option(
      "WORD", parsed.explain.words,
      "a name, a kind and a number, a code, an ErrorID of the blocks for PLCs, or a word of the glossary; "
      "none: everything");
  add_profiles(*command, parsed);
  CLI::Option* const page = command->add_flag("--page", parsed.explain.page, "print docs/troubleshooting.md");
  command->add_flag("--glossary", parsed.explain.glossary, "print docs/glossary.md")->excludes(page);
  command->footer(
      "Exit code 1: nothing is called so.\n"
      "Example: axisgate explain stop_latched; axisgate explain result 9; axisgate explain 0x3130; axisgate explain "
      "16#0208");
  command->callback([&parsed] { choose_with_folders(parsed, parsed.explain); });
}

/// What a package ships beside the program, and beside its manual page that of gateway.json(5).
std::optional<std::string> generated(CLI::App& app, int argc, const char* const* argv) {
  const std::vector<std::string_view> words(argv, argv + argc);
  if (words.size() == 3 && words[1] == "--generate" && words[2] == "gateway.json")
    return manual::configuration_page(config::gateway_schema_text(), AXISGATE_VERSION);
  return manual::generated(app, argc, argv);
}

}  // namespace

CommandLine parse_command_line(int argc, const char* const* argv) {
  CLI::App app("axisgate: motor drives on fieldbuses as one Modbus-TCP register map", "axisgate");
  app.set_version_flag("--version", "axisgate " AXISGATE_VERSION);
  app.require_subcommand(1);
  app.footer("Example: axisgate check CONFIG && axisgate run CONFIG\nEvery command has --help.");
  const auto options = std::make_shared<Parsed>();
  Parsed& parsed = *options;
  add_run(app, parsed);
  add_check(app, parsed);
  add_map(app, parsed);
  add_top(app, parsed);
  add_record(app, parsed);
  add_manual_commands(app, parsed.manual, parsed.chosen);
  add_topics(app, parsed);
  add_profile_commands(app, parsed.profile, parsed.profiles, parsed.chosen);
  add_commission(app, parsed);
  add_parameters_commands(app, parsed.parameters, parsed.profiles, parsed.chosen);
  add_scan(app, parsed);
  add_explain(app, parsed);
  add_reload(app, parsed);
  add_support_command(app, parsed.support, parsed.profiles, parsed.chosen);
  if (const auto text = generated(app, argc, argv)) {
    std::cout << *text;
    return {.exit_code = 0, .run = {}};
  }
  // CLI11 says of an unknown word only that a command is missing.
  if (const std::string wrong = wrong_command(app, argc, argv); !wrong.empty()) {
    std::cerr << wrong << "\n";
    return {.exit_code = kWrongCommandLine, .run = {}};
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked_for_help = error.get_exit_code() == 0;
    const std::string meant = asked_for_help ? "" : meant_as_endpoint(app);
    std::cerr << meant;
    if (meant.empty()) app.exit(error);
    if (!asked_for_help) std::cerr << nearest_options(app);
    return {.exit_code = asked_for_help ? 0 : kWrongCommandLine, .run = {}};
  }
  return {.exit_code = 0, .run = [options] { return options->chosen(); }};
}

int run_command_line(int argc, const char* const* argv) {
  const CommandLine line = parse_command_line(argc, argv);
  if (!line.run) return line.exit_code;
  const int code = line.run();
  // What was said counts as said only once it is written.
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  std::cerr << "axisgate: what it had to say could not all be written to standard output\n";
  return std::max(code, 1);
}

}  // namespace axisgate::commands
