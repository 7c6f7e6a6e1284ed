// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/options.hpp"

#include <CLI/CLI.hpp>
#include <iostream>

#include "gateway/manual/generate.hpp"
#include "gateway/upstream/dds_link/gateway_name.hpp"
#include "gateway/upstream/dds_link/records.hpp"
#include "gateway/upstream/link/exit_codes.hpp"

namespace axisgate::dds {
namespace {

constexpr std::uint32_t kLeastMemoryMib = 32;  // two participants, with commands
constexpr std::uint32_t kMostMemoryMib = 65536;

constexpr const char* kQosHelp =
    "The file of --qos-file holds Fast DDS XML profiles. A participant profile \"axisgate_participant\" replaces all "
    "that\n"
    "the other options say of the network; a data_writer or data_reader profile replaces the whole QoS of its topic:\n"
    "axisgate_axis_state, axisgate_axis_event, axisgate_gateway_state, axisgate_command_reply, axisgate_object_reply,\n"
    "axisgate_joint_states, axisgate_diagnostics (data_writer), axisgate_object_request, axisgate_heartbeat,\n"
    "axisgate_joint_commands (data_reader). The QoS of axis_command is fixed.\n"
    "Profiles of other names are left alone.";

void add_participant(CLI::App& command, ParticipantOptions& options) {
  command.add_option("--domain", options.domain, "DDS domain, 0 to 232")
      ->check(CLI::Range(0U, kMaxDomain))
      ->type_name("D")
      ->capture_default_str();
  command
      .add_option("--interface", options.interfaces,
                  "network interface or its IPv4 address; may be given more than once. No other is used")
      ->type_name("NAME")
      ->take_all()
      ->expected(1, static_cast<int>(kMaxInterfaces))
      ->default_str("lo");
  command.add_flag("--shared-memory", options.shared_memory, "the shared memory transport beside UDP (needs /dev/shm)");
  command.add_flag("--multicast", options.multicast, "send samples to the multicast addresses that readers name");
  command
      .add_option("--peer", options.peers,
                  "ADDRESS[:PORT] of a participant to look for; may be given more than once. Then nothing is multicast")
      ->type_name("ADDR")
      ->expected(1, static_cast<int>(kMaxPeers));
  command
      .add_option("--discovery-server", options.discovery_servers,
                  "ADDRESS:PORT of a Fast DDS discovery server; the first given has id 0, the next 1, ...")
      ->type_name("ADDR:PORT")
      ->expected(1, static_cast<int>(kMaxDiscoveryServers));
  command.add_option("--qos-file", options.qos_file, "Fast DDS XML profiles, see below")->type_name("FILE");
  command.footer(kQosHelp);
}

}  // namespace

std::variant<int, ServeOptions, TopicsOptions> parse_command_line(int argc, char** argv) {
  ServeOptions serve;
  TopicsOptions topics;
  CLI::App app{"The DDS topics of axisgate", "axisgate-dds"};
  app.set_version_flag("--version", AXISGATE_VERSION);
  app.set_help_all_flag("--help-all", "Help of all commands");
  app.require_subcommand(1);

  CLI::App* serve_command =
      app.add_subcommand("serve", "Publish the axes of the gateway that started this program (not for people)");
  serve_command->add_option("--link-fd", serve.link_fd, "descriptor of the gateway's socket")
      ->required()
      ->check(CLI::NonNegativeNumber)
      ->type_name("N");
  add_participant(*serve_command, serve.participant);
  serve_command->add_option("--gateway-name", serve.gateway_name, "which gateway this is, in every sample")
      ->check([](const std::string& name) {
        return is_gateway_name(name) ? std::string() : "no gateway name: write a-z, 0-9 and _, a letter first";
      })
      ->type_name("NAME");
  serve_command->add_flag("--commands", serve.commands, "read axis_command and object_request");
  serve_command
      ->add_option("--certificate", serve.certificates,
                   "FILE of a certificate whose writers the gateway tells from others; may be given more than once. "
                   "Needs DDS-Security in --qos-file")
      ->type_name("FILE")
      ->expected(1, static_cast<int>(kMaxIdentities));
  serve_command->add_flag("--ros2", serve.ros2, "the topics of ROS 2");
  serve_command->add_option("--min-period-ms", serve.min_period_ms, "joint_states are at least this far apart")
      ->check(CLI::Range(1U, 60'000U))
      ->type_name("MS")
      ->capture_default_str();
  serve_command->add_option("--memory-limit-mib", serve.memory_limit_mib, "end beyond this much memory (exit code 73)")
      ->check(CLI::Range(kLeastMemoryMib, kMostMemoryMib))
      ->type_name("M")
      ->capture_default_str();

  CLI::App* topics_command = app.add_subcommand("topics", "Show all axes live, as the topics tell them");
  add_participant(*topics_command, topics.participant);
  topics_command->add_flag("--all", topics.all, "every gateway of the domain, with a table of them before the axes");
  topics_command->add_option("--gateway", topics.gateway_name, "the gateway of this name alone")->type_name("NAME");
  topics_command->add_flag("--once", topics.once, "print what is there and end; exit code 1: no axis was found");
  topics_command->add_flag("--json", topics.json, "one JSON object a line for each sample");

  if (const auto text = manual::generated(app, argc, argv)) {
    std::cout << *text;
    return 0;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error, std::cout, std::cerr) == 0 ? 0 : link::kExitUsage;
  }
  if (serve_command->parsed()) return serve;
  return topics;
}

}  // namespace axisgate::dds
