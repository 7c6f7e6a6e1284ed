// Reads drive profiles, and resolves one for one configured drive: protocol, constants, units and limits of its axes.
// Promises every mistake of a profile at once, each with file, JSON pointer and what to change, and a model that is
// checked. Never guesses: what a sheet or a configuration does not give is not supported, or refused by name.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gateway/drive/profile.hpp"

namespace axisgate::drive {

struct Fault {
  std::string file;
  std::string pointer;  ///< RFC 6901; empty: the whole file
  std::string message;
  friend bool operator==(const Fault&, const Fault&) = default;
};
/// "kinco-jd.json: /objects/mode/type: must be ..."
[[nodiscard]] std::string text(const Fault& fault);

struct LoadedProfile {
  std::string file;
  Profile profile;
  std::string text;           ///< the file's JSON without spaces: whether two files say the same
  std::vector<Fault> faults;  ///< empty: the profile is good, and only then may it be resolved
};

/// Never throws for what the file says; a file that cannot be read is a fault as well.
[[nodiscard]] LoadedProfile load_profile(const std::string& path);

/// "kinco-jd" -> the first FOLDER/kinco-jd.json that exists; a name with '/' or ending in ".json" is a path already.
/// No value where there is none.
[[nodiscard]] std::optional<std::string> find_profile(const std::string& name_or_path,
                                                      const std::vector<std::string>& folders);

/// An axis of the configuration, in register units (design 2).
struct ResolveAxis {
  AxisNumber number = 0;
  std::string name;
  Rational units_per_rev{10000};
  bool inverted = false;
  std::optional<Range> position_limits;
  std::optional<std::int64_t> velocity_limit;
  std::optional<std::int64_t> acceleration_limit;
  std::optional<std::int64_t> torque_limit;
  std::optional<std::int64_t> quick_stop_deceleration_min;
  std::int64_t standstill_velocity = 1000;
  std::optional<std::int16_t> homing_method;
  Duration homing_timeout = std::chrono::seconds(60);
  LeaseRules lease;
  Duration jog_timeout = std::chrono::milliseconds(500);
  std::string motor;  ///< "A", "B": which of the drive's motors; empty: its place in the list
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

/// Faults point into the drive's entry of the configuration ("/constants/peak_current_a", "/axes/0/limits/velocity",
/// ""), and their `file` is empty: the caller knows both. `loaded.faults` must be empty.
[[nodiscard]] std::variant<DriveModel, std::vector<Fault>> resolve(const LoadedProfile& loaded,
                                                                   const ResolveInput& input);

}  // namespace axisgate::drive
