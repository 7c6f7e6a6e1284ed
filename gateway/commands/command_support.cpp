// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/command_support.hpp"

#include "gateway/commands/common/profile_folders.hpp"

namespace axisgate::commands {

void add_support_command(CLI::App& app, SupportOptions& options, std::string& profiles, std::function<int()>& chosen) {
  CLI::App* command = app.add_subcommand("support", "Write one archive with all that whoever helps needs to know");
  command->add_option("CONFIG", options.config, "the gateway's configuration file (JSON); it may be wrong")->required();
  command->add_option("--profiles", profiles, "folder of drive profiles, searched before the shipped ones")
      ->check(CLI::Validator(no_folder, ""))
      ->type_name("DIR");
  command
      ->add_option("--output", options.output,
                   "the archive; without it axisgate-support-TIME.tar.gz in this folder. A file that is there is not "
                   "written over")
      ->type_name("FILE");
  command->add_flag("--yes", options.yes, "write it without a question");
  command->footer(
      "In it: versions, the configuration without comments and secrets, what check says of it, the service's log of "
      "the\n"
      "last day, the state of the unit, SHA-256 sums of profiles, what is known of the devices, a table of top, and "
      "the\n"
      "page's answers. The list is shown before anything is written, with what was taken out and what could not be "
      "had.\n"
      "It sends nothing anywhere. It reads from a running gateway as top does, and never owns an axis. As root it "
      "sees\n"
      "more: the log, and who has a device open.\n"
      "Exit code 1: it was not written.\n"
      "Example: axisgate support /etc/axisgate/gateway.json");
  command->callback([&options, &profiles, &chosen] {
    chosen = [&options, &profiles] {
      options.profile_folders = profile_folders(profiles);
      return run(options);
    };
  });
}

}  // namespace axisgate::commands
