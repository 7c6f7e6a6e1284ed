// SPDX-License-Identifier: Apache-2.0
#include "gateway/check/check_sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "gateway/upstream/dds/dds_session.hpp"
#include "gateway/upstream/dds_link/ros_names.hpp"

namespace axisgate::check {
namespace {

using dds::DdsSettings;

std::string discovery_text(const DdsSettings& settings) {
  std::string out = settings.shared_memory ? "UDP and shared memory; " : "UDP; ";
  if (!settings.discovery_servers.empty()) {
    out += fmt::format("found through discovery server {}", fmt::join(settings.discovery_servers, ", "));
  } else if (!settings.peers.empty()) {
    out += fmt::format("participants are looked for at {}, nothing is multicast", fmt::join(settings.peers, ", "));
  } else {
    out += "participants find each other by multicast";
  }
  if (!settings.qos_file.empty()) out += fmt::format("; profiles in {} may change all of this", settings.qos_file);
  return out;
}

std::string samples_text(const DdsSettings& settings) {
  const double most = 1000.0 / in_ms(settings.min_period);
  const std::size_t axes = settings.units.size();
  return fmt::format(
      "of an axis at most {:.4g} a second (on change, {:.0f} ms apart), at least one each {:.0f} ms; with {} ax{}s at "
      "most {:.4g} a second in all",
      most, in_ms(settings.min_period), in_ms(settings.max_period), axes, axes == 1 ? "i" : "e",
      most * static_cast<double>(axes));
}

std::string commands_text(const DdsSettings& settings) {
  if (!settings.commands) return "off: DDS clients read, and own nothing";
  if (!settings.roles.empty()) {
    std::string out;
    for (const dds::CertificateRole& each : settings.roles)
      out += fmt::format("{} commands as {}; ", each.certificate, axisgate::text(each.role));
    return out + fmt::format("all others as {}", axisgate::text(settings.role));
  }
  return fmt::format("every participant of domain {} that reaches {} may command as {}: DDS has no passwords",
                     settings.domain, fmt::join(settings.interfaces, ", "), axisgate::text(settings.role));
}

std::string signs_of_life(LeaseRenewal renew) {
  switch (renew) {
    case LeaseRenewal::any:
      return "its samples, axisgate/heartbeat, and its liveliness where that is MANUAL_BY_TOPIC with a finite lease";
    case LeaseRenewal::write:
      return "its samples for this axis; neither heartbeat nor liveliness count";
    case LeaseRenewal::heartbeat:
      return "axisgate/heartbeat, and its liveliness where that is MANUAL_BY_TOPIC with a finite lease";
  }
  return "";
}

}  // namespace

std::string dds_title(const DdsSettings& settings) {
  return fmt::format("DDS: domain {} on {}", settings.domain, fmt::join(settings.interfaces, ", "));
}

ReportLines dds_lines(const DdsSettings& settings) {
  ReportLines out;
  out.emplace_back("topics", fmt::format("axisgate/axis_state, axis_event, gateway_state{}",
                                         settings.commands ? ", command_reply, object_reply" : ""));
  if (settings.ros2) {
    const std::string space = settings.gateway.name.empty() ? "/" : "/" + settings.gateway.name + "/";
    out.emplace_back(
        "ROS 2", fmt::format("{0}joint_states and /diagnostics{1}", space,
                             settings.commands ? fmt::format(", {}joint_commands, and of each axis enable, quick_stop, "
                                                             "fault_reset, home; a stream of positions begins within "
                                                             "{:.3g} rad of its axis",
                                                             space, settings.sync_tolerance)
                                               : std::string()));
  }
  out.emplace_back("samples", samples_text(settings));
  out.emplace_back("network", discovery_text(settings));
  out.emplace_back("commands", commands_text(settings));
  out.emplace_back("process", fmt::format("axisgate-dds ends beyond {} MiB and is started again; leases of DDS clients "
                                          "last {:.0f} ms longer then",
                                          settings.memory_limit_mib, in_ms(dds::kGrace)));
  return out;
}

ReportLines dds_master_lines(const DdsSettings& settings, const config::AxisConfig& axis,
                             const config::BusBudget& budget) {
  const LeaseRules& lease = axis.lease;
  if (!settings.commands || most_rights(settings) == Role::viewer) return {};
  ReportLines out;
  // Names of topics have letters, digits and underscores alone; the joint is called as the axis is.
  if (settings.ros2 && dds::ros_token(axis.name) != axis.name) {
    out.emplace_back("ROS 2", fmt::format("joint \"{}\"; its topics begin with {}", axis.name,
                                          dds::ros_axis_topic(settings.gateway.name, axis.name, "").substr(2)));
  }
  if (!lease.on) return out;
  out.emplace_back("DDS client", "kept by " + signs_of_life(lease.renew));
  if (lease.on_expiry == LeaseAction::none) return out;
  const auto worst = [&](Duration more) {
    return std::ceil(in_ms(lease.timeout + budget.command_wait_unresponsive + more));
  };
  const bool liveliness = lease.renew != LeaseRenewal::write;
  out.emplace_back("",
                   fmt::format("dead: the stop comes at most {:.0f} ms after its last sign of life{}", worst({}),
                               liveliness ? ", and its liveliness outlives it by the lease that it has stated" : ""));
  out.emplace_back("", fmt::format("{:.0f} ms where axisgate-dds dies as well", worst(dds::kGrace)));
  return out;
}

}  // namespace axisgate::check
