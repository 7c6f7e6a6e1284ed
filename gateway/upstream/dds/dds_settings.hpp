// SPDX-License-Identifier: Apache-2.0
// The settings of the DDS server (configuration key "dds", design sections 4 and 5), with their defaults.
// Promises values within their documented ranges: the configuration was checked before.
// Never changes while the gateway runs.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gateway/core/clock.hpp"
#include "gateway/core/rational.hpp"
#include "gateway/image/axis_image.hpp"
#include "gateway/image/lease.hpp"
#include "gateway/upstream/dds_link/gateway_name.hpp"

namespace axisgate::dds {

/// How the values of one axis become SI (design 2).
struct AxisUnits {
  AxisNumber axis = 0;
  Rational units_per_rev{10000};
  std::optional<Rational> metres_per_rev{};  ///< "dds_unit": "m"; none: rad
  friend bool operator==(const AxisUnits&, const AxisUnits&) = default;
};

/// Configuration key "roles": who proves by DDS-Security to have this certificate's subject.
struct CertificateRole {
  std::string certificate{};  ///< a PEM file
  Role role = Role::viewer;
  friend bool operator==(const CertificateRole&, const CertificateRole&) = default;
};

struct DdsSettings {
  GatewayId gateway{};                           ///< configuration key "gateway"
  std::uint32_t domain = 0;                      ///< 0..232
  std::vector<std::string> interfaces{"lo"};     ///< by name or address; of a host with others, these alone are used
  bool shared_memory = false;                    ///< the shared memory transport beside UDP
  std::vector<std::string> peers{};              ///< addresses of participants to look for; then nothing is multicast
  std::vector<std::string> discovery_servers{};  ///< "192.168.1.5:11811"
  bool multicast = false;                        ///< data goes to multicast addresses that readers name
  std::string qos_file{};                        ///< Fast DDS XML profiles; empty: none
  bool commands = false;                         ///< axis_command and object_request are read
  Role role = Role::engineer;                    ///< of every DDS writer that `roles` does not name
  std::vector<CertificateRole> roles{};
  /// A command that was written longer ago, or as far ahead, is not carried out; none: its age is not looked at.
  std::optional<Duration> max_age{};
  bool ros2 = false;             ///< the topics of ROS 2 (schemas/ros2)
  double sync_tolerance = 0.01;  ///< rad of the motor: how near a stream of positions must begin
  Duration min_period = std::chrono::milliseconds(10);
  Duration max_period = std::chrono::milliseconds(1000);
  Duration start_deadline = std::chrono::milliseconds(500);  ///< as start_deadline_ms of a listener
  Duration reply_deadline = std::chrono::milliseconds(900);  ///< as reply_deadline_ms of a listener
  std::uint32_t memory_limit_mib = 512;                      ///< of axisgate-dds, which is ended beyond it
  std::vector<AxisUnits> units{};                            ///< one an axis
  friend bool operator==(const DdsSettings&, const DdsSettings&) = default;
};

/// Of all DDS writers: viewer: none commands anything.
[[nodiscard]] inline Role most_rights(const DdsSettings& settings) {
  Role most = settings.role;
  for (const CertificateRole& each : settings.roles) most = std::max(most, each.role);
  return most;
}

}  // namespace axisgate::dds
