// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_host/dds_program.hpp"

namespace axisgate::dds {

std::vector<std::string> participant_arguments(const DdsSettings& settings) {
  std::vector<std::string> out{"--domain=" + std::to_string(settings.domain)};
  for (const auto& interface : settings.interfaces) out.push_back("--interface=" + interface);
  if (settings.shared_memory) out.emplace_back("--shared-memory");
  for (const auto& peer : settings.peers) out.push_back("--peer=" + peer);
  for (const auto& server : settings.discovery_servers) out.push_back("--discovery-server=" + server);
  if (settings.multicast) out.emplace_back("--multicast");
  if (!settings.qos_file.empty()) out.push_back("--qos-file=" + settings.qos_file);
  return out;
}

std::vector<std::string> serve_arguments(const DdsSettings& settings, int link_descriptor) {
  std::vector<std::string> out{"serve", "--link-fd=" + std::to_string(link_descriptor)};
  const auto participant = participant_arguments(settings);
  out.insert(out.end(), participant.begin(), participant.end());
  if (!settings.gateway.name.empty()) out.push_back("--gateway-name=" + settings.gateway.name);
  if (settings.commands) out.emplace_back("--commands");
  for (const auto& each : settings.roles) out.push_back("--certificate=" + each.certificate);
  if (settings.ros2) {
    out.emplace_back("--ros2");
    out.push_back("--min-period-ms=" + std::to_string(settings.min_period / std::chrono::milliseconds(1)));
  }
  out.push_back("--memory-limit-mib=" + std::to_string(settings.memory_limit_mib));
  return out;
}

}  // namespace axisgate::dds
