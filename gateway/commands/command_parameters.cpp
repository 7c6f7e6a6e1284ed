// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/command_parameters.hpp"

#include "gateway/commands/common/profile_folders.hpp"

namespace axisgate::commands {
namespace {

struct CommandText {
  ParametersOptions::Action action;
  const char *name, *what, *file, *footer;
};

constexpr CommandText kTexts[] = {
    {ParametersOptions::Action::save, "save", "Save the settings of a drive to a file",
     "the file that is written (JSON); one that is there is not written over",
     "It reads every object that the profile, or the EDS, says can be written, and writes none. What could not be read "
     "is in the\nfile with the reason. The gateway must not be running: the command needs the bus for itself.\n"
     "Exit code 1: there is no file.\n"
     "Example: axisgate parameters save /etc/axisgate/gateway.json 1 axis-1.json"},
    {ParametersOptions::Action::compare, "compare", "Say in which settings a drive differs from a file",
     "the file that was saved (JSON)",
     "It only reads. What is commanded in operation, or set by the gateway at each start, is shown and does not "
     "count.\n"
     "The gateway must not be running: the command needs the bus for itself.\n"
     "Exit code 1: something differs, or the two cannot be compared.\n"
     "Example: axisgate parameters compare /etc/axisgate/gateway.json 1 axis-1.json"},
    {ParametersOptions::Action::restore, "restore", "Write the settings of a file to the drive that takes its place",
     "the file that was saved (JSON)",
     "It shows what differs, what it would write, and what not and why; only 'yes' writes, the end of the input is a "
     "no.\nA drive of another type is refused, and one with torque; each value is read back, and the drive stores all "
     "of them once.\nNever written: what commands, starts, enables or moves, and what could lose the drive on its "
     "line. "
     "It never enables or\nmoves an axis. The gateway must not be running: the command needs the bus for itself.\n"
     "Exit code 1: the drive is not as the file has it.\n"
     "Example: axisgate parameters restore /etc/axisgate/gateway.json 1 axis-1.json"},
};

}  // namespace

void add_parameters_commands(CLI::App& app, ParametersCommands& commands, std::string& profiles,
                             std::function<int()>& chosen) {
  CLI::App* group = app.add_subcommand("parameters", "Save the settings of a drive, compare and restore them");
  group->require_subcommand(1);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    ParametersOptions& options = commands[i];
    options.action = kTexts[i].action;
    CLI::App* command = group->add_subcommand(kTexts[i].name, kTexts[i].what);
    command->add_option("CONFIG", options.config, "configuration file (JSON)")->required();
    command->add_option("AXIS", options.axis, "axis number, or name")->required();
    command->add_option("FILE", options.file, kTexts[i].file)->required();
    command->add_option("--eds", options.eds, "the maker's EDS or DCF: its objects as well")->type_name("FILE");
    command->add_option("--profiles", profiles, "folder of drive profiles, searched before the shipped ones")
        ->check(CLI::Validator(no_folder, ""))
        ->type_name("DIR");
    command->footer(kTexts[i].footer);
    command->callback([&profiles, &chosen, &options] {
      chosen = [&profiles, &options] {
        options.profile_folders = profile_folders(profiles);
        return run(options);
      };
    });
  }
}

}  // namespace axisgate::commands
