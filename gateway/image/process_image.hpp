// SPDX-License-Identifier: Apache-2.0
// The process image: all axes, buses and the gateway itself, as every server reads them.
// Promises that pointers to axes stay good for the gateway's life, also to those that were removed, and that axes are
// found by number in constant time.
// Never holds anything of a client.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gateway/core/time_counts.hpp"
#include "gateway/image/axis_image.hpp"

namespace axisgate {

enum class GatewayState : std::uint8_t { starting = 0, running = 1, degraded = 2, stopping = 3 };

/// Register 6 of the gateway block.
enum class GatewayAlarm : std::uint8_t {
  axis_offline = 0,
  bus_down = 1,
  drive_fault = 2,
  identity_mismatch = 3,
  no_comm_watchdog = 4,
  check_failed = 5,
  adopted_running = 6,
  dds_process_down = 7,
  configuration_changed = 8,
  certificate_expires = 9,
  event_loop_slow = 10,
  nvm_budget = 11,
  bus_overloaded = 12,
  name_taken = 13,     ///< another gateway of the DDS domain publishes an axis under our key
  listener_down = 14,  ///< an address that is to be served is none of this computer's yet
};

/// Classes of exchanges, most urgent first: stop, fault cause, command, interactive, setup, poll.
inline constexpr std::size_t kExchangeClasses = 6;

/// Registers 50000 + 100 * b; refreshed by the gateway before a request is answered.
struct BusImage {
  std::string name;
  std::uint16_t link = 0;  ///< 0 down, 1 up, 2 suspect
  std::uint16_t load_permille = 0;
  std::uint16_t cycle_ms = 0;
  std::uint16_t queue_depth = 0;
  std::uint32_t requests = 0;
  std::uint32_t replies = 0;
  std::uint32_t timeouts = 0;
  std::uint32_t bad_frames = 0;
  std::uint32_t late_replies = 0;
  std::uint32_t dropped_bytes = 0;
  std::uint32_t refused = 0;
  std::uint32_t coalesced = 0;
  std::uint32_t superseded = 0;
  std::uint32_t reconnects = 0;
  std::uint32_t echoes = 0;
  // In no register.
  std::array<TimeCounts, kExchangeClasses> times{};  ///< how long the exchanges of each class took
  std::array<TimeCounts, kExchangeClasses> waits{};  ///< how long bus jobs of each class waited for their first one
  Duration busy{};                                   ///< how long the wire was taken
};

struct GatewayImage {
  GatewayState state = GatewayState::starting;
  std::uint16_t axes_online = 0;
  std::uint32_t uptime_s = 0;
  std::uint16_t alarms = 0;
};

inline constexpr std::size_t kMaxBuses = 100;  ///< 50000 + 100 * b must stay below the overview at 60000

class ProcessImage {
 public:
  /// Numbers are unique and within 1..499 (the configuration was checked).
  /// One that there was before begins from scratch, but for `sequence`, its record and its counts: to every client its
  /// link was lost.
  AxisImage& add_axis(AxisNumber number, std::string name, std::uint8_t bus);
  /// It shows nothing any more, and is not found.
  void remove_axis(AxisNumber number);
  [[nodiscard]] AxisImage* find(AxisNumber number) const;
  /// In the order of their numbers.
  [[nodiscard]] const std::vector<std::unique_ptr<AxisImage>>& axes() const { return axes_; }

  std::vector<BusImage> buses;  ///< in configuration order, at most kMaxBuses
  GatewayImage gateway;
  ChangeBoard changes;

  /// Bus and gateway rows are gathered only when somebody looks: the gateway installs how.
  std::function<void()> refresh = [] {};

 private:
  std::vector<std::unique_ptr<AxisImage>> axes_;
  std::map<AxisNumber, std::unique_ptr<AxisImage>> removed_;
  std::array<AxisImage*, kMaxAxisNumber + 1> by_number_{};
};

}  // namespace axisgate
