// SPDX-License-Identifier: Apache-2.0
// The configuration as the gateway uses it: design section 5, checked and with defaults filled in.
// Promises that every value is within its documented range and that names and numbers are unique.
// Never holds JSON: config_loader makes it from a file.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/clock.hpp"
#include "gateway/core/rational.hpp"
#include "gateway/profile/json/json_schema.hpp"
#include "gateway/profile/resolve/profile_resolve.hpp"
#include "gateway/upstream/dds/dds_settings.hpp"
#include "gateway/upstream/modbus_tcp/client/listener_settings.hpp"
#include "gateway/upstream/web/web_settings.hpp"

namespace axisgate::config {

/// A drive whose profile has an open question (key "ask") before which it must not move: a mistake, or, for who finds
/// the answer out beside the machine, a warning.
enum class OpenAsks : std::uint8_t { refused, allowed };

/// What stands in a configuration to paste (`axisgate scan`) for a number that only a person can look up. Never a
/// value.
inline constexpr std::string_view kFillIn = "FILL IN";

/// What its model is made of, and what the gateway itself needs to know. The name is "axis 3" where none was given.
struct AxisConfig : profile::ResolveAxis {
  std::optional<Rational> metres_per_rev{};  ///< what DDS shows it in; none: rad
  bool vertical = false;                     ///< the load falls where the torque is taken away
  std::string pointer;                       ///< JSON pointer of the entry, for messages
  /// Not in the file: its profile says that a quick stop ends without torque.
  bool stop_without_torque = false;
  friend bool operator==(const AxisConfig&, const AxisConfig&) = default;
};

struct DriveConfig {
  std::string profile;  ///< a name in schemas/drives, or a path
  std::uint8_t node = 1;
  std::map<std::string, Rational> constants;
  std::array<std::optional<std::uint32_t>, 4> identity{};  ///< canopen: vendor, product, revision, serial (1018h)
  std::vector<AxisConfig> axes;
  std::string pointer;
  std::vector<profile::WantedConstant> wanted{};  ///< not in the file: what its profile would like to know
  std::vector<std::string> open_before{};         ///< not in the file: what open questions of its profile forbid
  std::string profile_text{};  ///< what the profile's file says, without spaces: its models are made from it
  friend bool operator==(const DriveConfig&, const DriveConfig&) = default;
};

struct BusConfig {
  std::string name;
  std::string adapter;
  std::string device;          ///< on CAN: an interface, or slcan:PATH (adapters/can/can_device.hpp)
  std::uint32_t baud = 38400;  ///< by default: modbus-rtu 19200, Keya's serial protocols 115200
  std::string parity = "none";
  std::string rs485 = "auto";  ///< auto: direction control where the port offers it; off
  bool cascade = false;        ///< Kinco 6510:0B = 1: every request comes back before its reply
  /// On CAN; keya-can 250000 by default. An interface is set by whoever brings it up: what it is taken for then.
  std::uint32_t bitrate = 500000;
  bool bitrate_given = false;
  Duration timeout{};  ///< where none is given: what its drives need (settle_..._buses())
  Duration min_gap{};
  Duration settle{};
  std::array<Duration, 3> poll{std::chrono::milliseconds(20), std::chrono::milliseconds(100),
                               std::chrono::milliseconds(1000)};  ///< fast, normal, slow
  bool poll_given = true;                                         ///< false: the periods are what the line carries
  bool decode = false;
  std::vector<DriveConfig> drives;
  std::string pointer;
  friend bool operator==(const BusConfig&, const BusConfig&) = default;
};

struct Config {
  std::string file;
  std::vector<profile::FileRead>
      read{};  ///< the file and its profiles, and where one was looked for in vain; each once
  std::vector<modbus_tcp::ListenerSettings> modbus_tcp;
  std::optional<dds::DdsSettings> dds;
  std::vector<profile::FileRead> read_by_dds{};  ///< what axisgate-dds reads when it starts, but the private key
  std::optional<web::WebSettings> web{};
  std::vector<BusConfig> buses;
};

/// Calls `look(axis)` for each axis.
template <class Look>
void each_axis(const std::vector<BusConfig>& buses, Look&& look) {
  for (const BusConfig& bus : buses)
    for (const DriveConfig& drive : bus.drives)
      for (const AxisConfig& axis : drive.axes) look(axis);
}

/// What the alarm "configuration changed" is about.
[[nodiscard]] inline std::vector<profile::FileRead> watched_files(const Config& config) {
  std::vector<profile::FileRead> all = config.read;
  all.insert(all.end(), config.read_by_dds.begin(), config.read_by_dds.end());
  return all;
}

}  // namespace axisgate::config
