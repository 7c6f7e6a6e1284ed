// What must hold in every run, whatever the seed: checked after every step of the world.
// Promises to name the first violation with the virtual time at which it was seen.
// Never changes anything it looks at.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <vector>

#include "gateway/app/gateway.hpp"
#include "tests/sim/modbus_client.hpp"
#include "tests/stage/sim_link.hpp"

namespace axisgate::test {

/// I1 at most one exchange outstanding per bus; I5 no unique value written twice: seen on the cable.
class CableWatch {
 public:
  CableWatch(SimLink& link, Runtime& runtime, Duration timeout, std::function<void(std::string)> violated);
  [[nodiscard]] std::uint64_t hash() const { return hash_; }
  [[nodiscard]] std::uint64_t starts() const { return starts_; }

 private:
  void to_drive(Bytes bytes);
  void to_host(Bytes bytes);
  [[nodiscard]] bool answered() const;

  SimLink& link_;
  Runtime& runtime_;
  Duration timeout_;
  std::function<void(std::string)> violated_;
  std::vector<Byte> request_;
  std::vector<Byte> heard_;  ///< since the request
  Instant sent_at_ = kLongAgo;
  std::map<std::pair<Byte, std::uint32_t>, int> profile_velocities_;  ///< per station and value
  std::uint64_t starts_ = 0;
  std::uint64_t hash_ = 0xCBF29CE484222325U;
};

/// What was asked for is on the wire within its start and answer deadlines, or never.
inline constexpr Duration kLongestWay = std::chrono::milliseconds(1500);

/// I6 and I10 of one axis, whatever line it is on.
class AxisWatch {
 public:
  AxisWatch(const app::Gateway& gateway, AxisNumber axis, const Asked& asked, Runtime& runtime,
            std::function<void(std::string)> violated);
  /// I6: nothing valid is stale, nor valid of a drive that is not there.
  void check_validity() const;
  /// I10 of a drive that has a state machine: `age` tells how long ago it was enabled.
  void check_enables(const std::deque<simulated::Transition>& transitions,
                     const std::function<Duration(simulated::Time)>& age);
  /// How often an object is confirmed, where that may be less often than its poll class is read.
  void set_period(std::function<Duration(drive::ObjectId)> period) { period_ = std::move(period); }
  [[nodiscard]] bool enable_was_asked(Instant at) const;

 private:
  const app::Gateway& gateway_;
  AxisNumber axis_;
  const Asked& asked_;
  [[nodiscard]] Duration stale_after(const drive::Binding& binding) const;
  Runtime& runtime_;
  std::function<void(std::string)> violated_;
  std::function<Duration(drive::ObjectId)> period_ = [](drive::ObjectId) { return Duration{}; };
  Instant enables_seen_until_;
};

/// I2 a stored value is what the drive sent in answer to that very request; I6 nothing valid is stale; I7 bounds;
/// I10 nothing is enabled unasked.
class DriveWatch {
 public:
  DriveWatch(const app::Gateway& gateway, SimLink& link, std::size_t position, AxisNumber axis, const Asked& asked,
             Runtime& runtime, std::function<void(std::string)> violated);
  void check();

 private:
  void check_values();
  const app::Gateway& gateway_;
  SimLink& link_;
  std::size_t position_;
  AxisNumber axis_;
  Runtime& runtime_;
  std::function<void(std::string)> violated_;
  AxisWatch watch_;
  std::vector<std::uint64_t> seen_;  ///< exchange of each object when it was last checked
};

}  // namespace axisgate::test
