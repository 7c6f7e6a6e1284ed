// SPDX-License-Identifier: Apache-2.0
// The image of one axis: the newest sample of every quantity and the axis's states, as every server shows them.
// Promises that what it shows as valid is valid, and that `sequence` steps once for each change a client could notice.
// Never waits: a reader takes what is there. One thread writes and reads it, between two turns of the loop.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "gateway/core/clock.hpp"
#include "gateway/core/error.hpp"
#include "gateway/core/log_source.hpp"
#include "gateway/core/numbers.hpp"
#include "gateway/core/rational.hpp"
#include "gateway/image/axis_counts.hpp"
#include "gateway/image/axis_record.hpp"
#include "gateway/image/capabilities.hpp"
#include "gateway/image/changes.hpp"
#include "gateway/image/lease.hpp"
#include "gateway/image/quantity.hpp"

namespace axisgate {

static_assert(kMaxAxisNumber < ChangeBoard::kPlaces, "each axis has a place of its own");

enum class LinkState : std::uint8_t { unknown = 0, setup = 1, online = 2, suspect = 3, offline = 4, link_down = 5 };
enum class AxisState : std::uint8_t {
  disabled = 0,
  standstill = 1,
  discrete_motion = 2,
  continuous_motion = 3,
  homing = 4,
  stopping = 5,  ///< or stop-latched
  error_stop = 6,
  unknown = 7,  ///< out of sight: it may be running
};
enum class MotionState : std::uint8_t { none = 0, active = 1, completed = 2, aborted = 3, failed = 4 };

/// Register 34 (design 3.1).
enum class AxisAlarm : std::uint8_t {
  no_comm_watchdog = 0,
  adopted_running = 1,
  identity_mismatch = 2,
  local_control = 3,
  limit_inputs_open = 4,
  not_homed = 5,
  cannot_deenergise = 6,
  stop_latched = 7,
  duplicate_node = 8,
  nvm_budget = 9,
  clamped = 10,
  stop_options = 11,
  profile_mismatch = 12,   ///< the device refuses what the profile needs
  unexpected_motion = 13,  ///< nothing that was asked for explains it
  units_disagree = 14,     ///< velocity and position do not fit each other
};
inline constexpr std::size_t kAxisAlarmCount = 15;
[[nodiscard]] constexpr std::uint32_t bit(AxisAlarm alarm) { return 1U << static_cast<unsigned>(alarm); }
[[nodiscard]] std::string_view text(AxisAlarm alarm);
[[nodiscard]] std::string_view text(LinkState state);
[[nodiscard]] std::string_view text(AxisState state);

/// Discrete inputs 0..12 (design 3.1); bit 11, owned_by_me, is each client's own and never set here.
enum class AxisInput : std::uint8_t {
  online = 0,
  ready = 1,
  enabled = 2,
  fault = 3,
  warning = 4,
  target_reached = 5,
  homed = 6,
  moving = 7,
  limit_active = 8,
  quick_stop_active = 9,
  following_error = 10,
  owned_by_me = 11,
  stop_latched = 12,
};
inline constexpr std::size_t kAxisInputCount = 13;
[[nodiscard]] constexpr std::uint16_t bit(AxisInput input) {
  return static_cast<std::uint16_t>(1U << static_cast<unsigned>(input));
}

/// Register 98, loss_stop_ms.
inline constexpr std::uint16_t kGoesOn = 0;                 ///< the drive does not stop by itself
inline constexpr std::uint16_t kLossNotKnown = UINT16_MAX;  ///< nobody knows whether it does

struct Sample {
  std::int64_t value = 0;  ///< in register units
  bool received = false;   ///< a value was received since the gateway's start and could be represented
  bool valid = false;      ///< it is good now
  Instant at = kLongAgo;   ///< when it was last confirmed
};

/// The result of the last write batch of an axis, for registers 25, 26 and 30; of the axis's own, whose it was as well.
struct LatestResult {
  CommandResult result = CommandResult::none;
  std::uint32_t detail = 0;
  std::uint16_t command_id = 0;
  std::uint64_t stop = 0;                  ///< BatchResult::stop
  std::shared_ptr<const ClientLife> by{};  ///< who asked; none: the gateway itself
  std::string_view what{};                 ///< subject_of() what was asked
  Instant at = kLongAgo;                   ///< since when it is so
  friend bool operator==(const LatestResult&, const LatestResult&) = default;
};

/// Its capabilities are fixed while its drive is configured as it is, but for what the drive itself refuses.
struct AxisImage : Capabilities {
  // Fixed in the same way.
  AxisNumber number = 0;
  std::string name;
  std::uint8_t bus = 0;          ///< position of its bus in the configuration
  ChangeBoard* board = nullptr;  ///< marked with each step of `sequence`; none: nobody wants to know
  std::uint16_t supported_modes = 0;
  Rational units_per_rev{10000};
  std::optional<std::uint32_t> rated_speed{};  ///< 0.001 rpm; none: not known
  /// Per quantity, what a write may carry: the axis's, profile's and drive's limits together, in register units.
  std::array<Range, kQuantityCount> limits{};

  // Changed by the drive alone, through AxisWriter's rules.
  std::array<Sample, kQuantityCount> samples{};
  LinkState link_state = LinkState::unknown;
  AxisState axis_state = AxisState::unknown;
  MotionState motion_state = MotionState::none;
  std::uint16_t motion_id = 0;
  std::uint32_t alarms = 0;
  std::uint16_t loss_stop_ms = kLossNotKnown;  ///< row 98: how soon its drive stops by itself when the gateway dies
  std::uint16_t inputs = 0;                    ///< AxisInput bits
  /// Coils 0, 3, 7, 8, 9 read back: bits 0 enabled, 3 halted, 7 velocity running, 8 and 9 jogging.
  std::uint16_t level_coils = 0;
  std::uint32_t jog_velocity = 0;  ///< row 58, 0.001 rpm: the gateway's own
  Lease lease{};
  /// A position sampled no later than this counts from another zero: a homing or a set_position was under way since.
  Instant zero_moved = kLongAgo;
  AxisRecord record{};               ///< what came after what: the servers' rules of edges look at it
  Instant oldest_cyclic = kLongAgo;  ///< when the oldest cyclic value was confirmed
  LatestResult latest;
  std::uint64_t unheeded_stop = 0;  ///< BatchResult::stop of the newest that was done, and whose motor turned on
  std::uint32_t sequence = 0;
  /// One of an axis for the gateway's life: copies of the image share it.
  std::shared_ptr<AxisCounts> counts = std::make_shared<AxisCounts>();

  [[nodiscard]] const Sample& operator[](Quantity q) const { return samples[static_cast<std::size_t>(q)]; }
  [[nodiscard]] Sample& operator[](Quantity q) { return samples[static_cast<std::size_t>(q)]; }
  [[nodiscard]] const Range& limit(Quantity q) const { return limits[static_cast<std::size_t>(q)]; }
  [[nodiscard]] bool has(AxisInput input) const { return (inputs & bit(input)) != 0; }
  [[nodiscard]] bool reachable() const { return link_state == LinkState::online || link_state == LinkState::suspect; }
  /// Register 22: supported values that are good now; none while link_state is not 2 or 3.
  [[nodiscard]] std::uint32_t valid_bits() const;
};

/// Who speaks in log lines about an axis: "axis 3 lift", or "axis 3" where it has no name of its own.
[[nodiscard]] LogSource log_source(AxisNumber number, const std::string& name, const std::string& bus);

/// Whether no client could tell the two apart: what `sequence` counts (design 3.2). Ages, times, how long the lease
/// still runs, `sequence` itself and the latest result do not count.
[[nodiscard]] bool shows_the_same(const AxisImage& a, const AxisImage& b);

}  // namespace axisgate
