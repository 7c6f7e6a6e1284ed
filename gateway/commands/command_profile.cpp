// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/command_profile.hpp"

#include "gateway/commands/common/profile_folders.hpp"
#include "gateway/commands/profile/node_reader.hpp"
#include "gateway/profile/make/profile_text.hpp"

namespace axisgate::commands {
namespace {

class Commands {
 public:
  Commands(CLI::App& group, std::string& profiles, std::function<int()>& chosen)
      : group_(group), profiles_(profiles), chosen_(chosen) {}

  void add_check(ProfileCheckOptions& options) {
    CLI::App* command = add("check", "Validate a profile and say what it gives on each protocol", options,
                            "folder where profiles that it extends may lie, beside its own");
    command->add_option("FILE", options.file, "profile (JSON)")->required();
    command->add_option("--eds", options.eds, "compare its CANopen objects with the maker's EDS or DCF file")
        ->type_name("FILE");
    command->footer(
        "Exit code 1: mistakes, or something in which profile and EDS cannot both be right.\n"
        "Example: axisgate profile check schemas/drives/kinco-jd.json");
  }

  void add_from_eds(ProfileFromEdsOptions& options) {
    CLI::App* command =
        add_making("from-eds", "Make a profile from a maker's EDS or DCF file", options, "by the product's name");
    command->add_option("FILE", options.file, "EDS or DCF of a CiA 402 drive")->required();
    command->add_option("--node", options.node, "ask this drive as well, by reads alone: CAN interface and node-ID")
        ->check(CLI::Validator(node_place_mistake, ""))
        ->type_name("DEVICE:N");
    command->add_option("--bitrate", options.bitrate, "bits per second; a serial adapter is opened with it")
        ->type_name("N")
        ->capture_default_str();
    command->footer(
        "The file extends cia402-generic and says what this drive has otherwise. What no EDS says stands in it under\n"
        "\"ask\", and is printed. A file that is there already is not written over.\n"
        "With --node the drive says who it is, how it counts and which modes it has (1018h, 6502h, 608Fh to 60AAh); "
        "stop\n"
        "a gateway that runs on this bus first. Nothing is written to the drive.\n"
        "Exit code 1: no profile can be made of it, or the drive does not answer.\n"
        "Example: axisgate profile from-eds EPOS4.eds --name my-epos4 -o /etc/axisgate/profiles");
  }

  void add_new(ProfileNewOptions& options) {
    CLI::App* command = add_making("new", "Make the form of a profile from a table of registers or objects", options,
                                   "by the table's file name");
    CLI::Option* modbus = command->add_option("--modbus", options.modbus, "table of Modbus registers (CSV)");
    modbus->type_name("FILE");
    CLI::Option* canopen = command->add_option("--canopen", options.canopen, "table of CANopen objects (CSV)");
    canopen->type_name("FILE")->excludes(modbus);
    command->add_option("--like", options.like, "take commands and state of this profile, a sibling of the drive")
        ->type_name("PROFILE");
    command->footer(
        "Columns: name,address,type,access,unit,range, as \"target_velocity,0x2000,i16,rw,0.1 rpm,-30000..30000\".\n"
        "A row named as a quantity of the register map becomes it. On Modbus \"control\" is what is written to "
        "enable,\n"
        "start and stop, \"status\" tells what the motor does, \"fault\" is 0 without a fault. Which number of them "
        "means\n"
        "what, the manual has to say: it is asked for, and until it is answered nothing is enabled.\n"
        "Exit code 1: no profile can be made of it.\n"
        "Example: axisgate profile new --modbus registers.csv --name my-drive -o /etc/axisgate/profiles");
  }

  void add_upgrade(ProfileUpgradeOptions& options) {
    CLI::App* command = add("upgrade", "Carry a profile over that was written for an earlier axisgate", options,
                            "folder where profiles that it extends may lie, before the shipped ones");
    command->add_option("FILE", options.file, "profile (JSON)")->required();
    add_folder(*command, options.folder);
    command->footer(
        "Writes a new file, named by the profile, and names each change; comments and the layout are not kept.\n"
        "A file that is there already is not written over. Exit code 1: something is left that a person has to "
        "change.\n"
        "Example: axisgate profile upgrade old/my-drive.json -o /etc/axisgate/profiles");
  }

  void add_try(TryOptions& options) {
    CLI::App* command = add("try", "Try a new profile on its drive, step by step", options,
                            "folder of drive profiles, searched before the shipped ones");
    command->add_option("CONFIG", options.config, "configuration file (JSON)")->required();
    command->add_option("AXIS", options.axis, "axis number")->required()->check(CLI::Range(1, 499).description(""));
    command->add_flag("--dry", options.dry, "read and compare only: nothing is written, nothing moves");
    command->add_option("--report", options.report, "write what was tried, seen and found to this file (JSON)")
        ->type_name("FILE");
    command->add_option("--home", options.home, "try homing as well, by this method")->type_name("METHOD");
    command->footer(
        "The gateway must not be running, and the other drives of the bus must have no torque. Steps: read, setup, "
        "turn\n"
        "(by hand), torque, moves, stops, loss, home. Before torque and before each kind of motion the axis number and "
        "the\n"
        "step's name are typed; any other answer ends it. It moves by a twentieth of a turn, a turn and back at 10 "
        "rpm,\n"
        "then at 30 rpm, and stops and disables after each; position, velocity and what was asked must agree within 20 "
        "%.\n"
        "Ctrl-C, a terminal that is closed and five minutes without an answer stop and disable the axis.\n"
        "No function of axisgate is a safety function: keep the wired stop in reach.\n"
        "Exit code 1: a step is wrong, or it ended before its end.\n"
        "Example: axisgate profile try machine.json 1 --report mydrive.json");
  }

 private:
  template <typename Options>
  CLI::App* add(const std::string& name, const std::string& what, Options& options, const std::string& folder) {
    CLI::App* command = group_.add_subcommand(name, what);
    command->add_option("--profiles", profiles_, folder)->check(CLI::Validator(no_folder, ""))->type_name("DIR");
    command->callback([this_profiles = &profiles_, this_chosen = &chosen_, &options] {
      *this_chosen = [this_profiles, &options] {
        options.profile_folders = profile_folders(*this_profiles);
        return run(options);
      };
    });
    return command;
  }

  /// One that writes a profile as a new file.
  template <typename Options>
  CLI::App* add_making(const std::string& name, const std::string& what, Options& options,
                       const std::string& otherwise) {
    CLI::App* command =
        add(name, what, options, "folder where profiles that it extends may lie, before the shipped ones");
    command->add_option("--name", options.name, "name of the profile; without it " + otherwise)
        ->check(CLI::Validator(name_mistake, ""))
        ->type_name("NAME");
    add_folder(*command, options.folder);
    return command;
  }

  static void add_folder(CLI::App& command, std::string& folder) {
    command.add_option("-o,--folder", folder, "folder that the file is written to")
        ->check(CLI::Validator(no_folder, ""))
        ->type_name("DIR")
        ->capture_default_str();
  }

  static std::string name_mistake(const std::string& name) {
    return name == profile::profile_name(name)
               ? ""
               : "'" + name + "' is no name of a profile: small letters, digits and '-', such as '" +
                     profile::profile_name(name) + "'";
  }

  CLI::App& group_;
  std::string& profiles_;
  std::function<int()>& chosen_;
};

}  // namespace

void add_profile_commands(CLI::App& app, ProfileCommands& options, std::string& profiles,
                          std::function<int()>& chosen) {
  CLI::App* group = app.add_subcommand("profile", "Check drive profiles, make new ones and try them");
  group->require_subcommand(1);
  Commands commands(*group, profiles, chosen);
  commands.add_check(options.check);
  commands.add_from_eds(options.from_eds);
  commands.add_new(options.make);
  commands.add_upgrade(options.upgrade);
  commands.add_try(options.trial);
}

}  // namespace axisgate::commands
