// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/command_manual.hpp"

#include <algorithm>

namespace axisgate::commands {
namespace {

constexpr const char* kManualEnd =
    "Ctrl-C, a signal and a terminal that is closed stop the axis before the command ends. Where the network or this\n"
    "computer fails, the gateway does what the axis's lease says (\"lease\": null: nothing). WHERE THE GATEWAY DIES,\n"
    "MANY DRIVES GO ON: register 98 (loss_stop_ms) and axisgate check say what this one does, and the command does.\n"
    "No function of axisgate is a safety function: keep the wired stop in reach.\n"
    "Without HOST:PORT it is the gateway of this computer, and AXIS is held against the names that this gateway "
    "tells:\n"
    "one that could be two axes, or that the configuration gives to another, is refused.\n";

std::string mistake_of_turns(const ManualOptions& options) {
  return options.arguments.task == ManualTask::move ? turns_mistake(options.turns) : std::string();
}

CLI::App* add_manual(CLI::App& app, ManualOptions& options, std::function<int()>& chosen, ManualTask task,
                     const std::string& what) {
  options.arguments.task = task;
  CLI::App* command = app.add_subcommand(std::string(text(task)), what);
  CLI::Option* const endpoint = add_endpoint(*command, options.typed.endpoint);
  command->add_option("AXIS", options.typed.axis, "axis number, or its name as the gateway has it")->required();
  command
      ->add_option("--config", options.typed.config, "the configuration of this computer's gateway: where it listens")
      ->excludes(endpoint)
      ->type_name("CONFIG")
      ->default_str(kServiceConfig);
  command->callback([&options, &chosen] {
    // Not as validators of CLI11: a place whose word is wrong would be passed over.
    const std::string& at = options.typed.endpoint;
    const bool unreadable = !at.empty() && !parse_host_port(at);
    for (const std::string& mistake : {unreadable ? host_port_mistake(at) : std::string(),
                                       axis_mistake(options.typed.axis), mistake_of_turns(options)})
      if (!mistake.empty()) throw CLI::ValidationError(mistake);
    chosen = [&options] { return run(options); };
  });
  return command;
}

void add_speed(CLI::App* command, ManualOptions& options, const std::string& what) {
  command->add_option("--velocity", options.rpm, what)->check(CLI::Validator(rpm_mistake, ""))->type_name("RPM");
}

void add_enable_flag(CLI::App* command, ManualOptions& options) {
  command->add_flag("--enable", options.arguments.enable,
                    "enable the axis before, and disable it after; without it the axis must be enabled already");
}

}  // namespace

CLI::Option* add_endpoint(CLI::App& command, std::string& endpoint) {
  const auto no_endpoint = [](const std::string& word) {
    return word.find(':') == std::string::npos ? host_port_mistake(word) : std::string();
  };
  command.validate_positionals();
  return command
      .add_option("HOST:PORT", endpoint, "the gateway's Modbus-TCP listener; without it the gateway of this computer")
      ->check(CLI::Validator(no_endpoint, ""));
}

std::string meant_as_endpoint(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().front();
  const CLI::Option* const endpoint = at->get_option_no_throw("HOST:PORT");
  const CLI::Option* const axis = at->get_option_no_throw("AXIS");
  const auto is_option = [](const std::string& word) { return word.starts_with("--"); };
  const bool too_many = endpoint != nullptr && endpoint->count() == 0 && axis != nullptr && axis->count() == 1 &&
                        at->remaining_size() != 0 && !std::ranges::any_of(at->remaining(), is_option);
  return too_many ? host_port_mistake(axis->results().front()) + "\n" : std::string();
}

void add_manual_commands(CLI::App& app, ManualCommands& commands, std::function<int()>& chosen) {
  CLI::App* enable = add_manual(app, commands.enable, chosen, ManualTask::enable,
                                "Enable an axis and hold it, showing its position, until Ctrl-C disables it");
  enable->footer(std::string("Nothing moves. An axis that was enabled before is held, and left enabled.\n") +
                 kManualEnd +
                 "Exit code 1: it was not enabled, or something else ended it.\n"
                 "Example: axisgate enable lift; axisgate enable 127.0.0.1:1502 1");

  CLI::App* move = add_manual(app, commands.move, chosen, ManualTask::move,
                              "Move an axis to a position, showing it live, until it is reached");
  move->add_option("TURNS", commands.move.turns, "target position in turns of the motor, such as 12.5 or -3")
      ->required();
  move->add_flag("--relative", commands.move.arguments.relative, "by so many turns from where it stands");
  add_speed(
      move, commands.move,
      "profile velocity in rpm of the motor, set back at the end; without it 60, or the axis's limit if that is less");
  add_enable_flag(move, commands.move);
  move->footer(
      std::string("A turn is units_per_rev position units of the register map; the target is rounded to one.\n") +
      kManualEnd +
      "Exit code 1: the target was not reached.\n"
      "Example: axisgate move lift 2.5 --enable; axisgate move 127.0.0.1:1502 1 2.5 --velocity 60 --enable");

  CLI::App* jog =
      add_manual(app, commands.jog, chosen, ManualTask::jog, "Turn an axis while a key is held, showing its position");
  add_speed(
      jog, commands.jog,
      "jog velocity in rpm of the motor, set back at the end; without it 60, or the axis's limit if that is less");
  add_enable_flag(jog, commands.jog);
  jog->footer(
      std::string("Right, up and + turn it forward, left, down and - in reverse; q ends, any other key lets go.\n"
                  "The button is pressed by the key and its repeats alone: 300 ms without one lets it go, so a\n"
                  "terminal that repeats late turns the axis a little, and goes on when the repeats come.\n") +
      kManualEnd +
      "Exit code 1: it ended otherwise than by q.\n"
      "Example: axisgate jog lift --enable; axisgate jog 127.0.0.1:1502 1 --velocity 30 --enable");

  CLI::App* stop = add_manual(app, commands.stop, chosen, ManualTask::stop,
                              "Stop an axis with a quick stop, whoever owns it, and wait until it stands");
  stop->footer(
      "The stop is latched: the next enable clears it. It needs no lease, and takes none.\n"
      "Exit code 1: it was refused, or the axis was not seen to stand.\n"
      "Example: axisgate stop lift; axisgate stop 127.0.0.1:1502 1");
}

}  // namespace axisgate::commands
