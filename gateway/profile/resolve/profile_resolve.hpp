// SPDX-License-Identifier: Apache-2.0
// Resolves a profile for one configured drive: protocol, constants, units and limits of its axes.
// Promises every mistake at once, each with JSON pointer and what to change, and a model that is checked.
// Never guesses: what a sheet or a configuration does not give is not supported, or refused by name.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gateway/profile/read/profile_loader.hpp"

namespace axisgate::profile {

/// What the configuration allows an axis; none: what its drive does.
struct AxisLimits {
  std::optional<Range> position;                            ///< register units
  std::optional<std::int64_t> velocity;                     ///< 0.001 rpm
  std::optional<std::int64_t> acceleration;                 ///< 0.1 rpm/s
  std::optional<std::int64_t> torque;                       ///< 0.1 % of rated
  std::optional<std::int64_t> quick_stop_deceleration_min;  ///< 0.1 rpm/s
  friend bool operator==(const AxisLimits&, const AxisLimits&) = default;
};

/// An axis of the configuration.
struct ResolveAxis : model::AxisSettings {
  AxisLimits limits;
  std::string motor;  ///< "A", "B": which of the drive's motors; empty: as many as stand before it in the list
  friend bool operator==(const ResolveAxis&, const ResolveAxis&) = default;
};

struct ResolveInput {
  std::string protocol;  ///< the adapter of its bus: "kinco-serial"
  std::uint8_t node = 1;
  std::map<std::string, Rational> constants;  ///< overrides
  /// canopen: 1018h sub 1 to 4 as they must be; none: whatever it is.
  std::array<std::optional<std::uint32_t>, 4> identity{};
  std::array<Duration, 3> poll{std::chrono::milliseconds(20), std::chrono::milliseconds(100),
                               std::chrono::milliseconds(1000)};
  std::vector<ResolveAxis> axes;  ///< at most as many as the drive has
};

/// Key of the configuration's `limits` that bounds a quantity; empty: none does.
[[nodiscard]] std::string_view limit_key(Quantity quantity);

/// Faults point into the drive's entry of the configuration ("/constants/peak_current_a", "/axes/0/limits/velocity",
/// ""), and their `file` is empty: the caller knows both. `loaded.faults` must be empty.
[[nodiscard]] std::variant<model::DriveModel, std::vector<Fault>> resolve(const LoadedProfile& loaded,
                                                                          const ResolveInput& input);

}  // namespace axisgate::profile
