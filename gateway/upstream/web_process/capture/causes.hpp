// SPDX-License-Identifier: Apache-2.0
// What begins a capture by itself. Pure: samples and events in, causes out.
// Promises one source for each cause: stops by a lease or a stranger are events, all else is read from the samples,
// where it must have been seen otherwise before. A drive that is out of sight is neither faulted nor well. Never looks
// at an event that is older than this program.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/upstream/web_process/capture/trigger.hpp"
#include "gateway/upstream/web_process/picture/picture.hpp"

namespace axisgate::web {

enum class Cause : std::uint8_t {
  fault,
  link_lost,
  lease_stop,
  stranger_stop,   ///< by another than the owner
  command_failed,  ///< result 11, not reached
  unexpected_motion,
  units_disagree,
  trigger,
};
[[nodiscard]] constexpr Cause last_of(Cause /*any*/) { return Cause::trigger; }
[[nodiscard]] std::string_view text(Cause cause);

/// What is said of a fault until the drive has named it.
inline constexpr std::string_view kFaultUnnamed = "the cause is not read yet";

struct CauseSeen {
  Cause cause{};
  std::uint16_t axis = 0;
  SteadyNs at = 0;
  std::string text{};  ///< in words; of a trigger its name
  friend bool operator==(const CauseSeen&, const CauseSeen&) = default;
};

class Causes {
 public:
  explicit Causes(std::vector<Trigger> triggers);

  /// Another hello: what was seen before was of axes that may be others now. @param now older events are history
  void begin(SteadyNs now);
  /// When this program began to look; 0: not yet.
  [[nodiscard]] SteadyNs began() const { return began_; }
  /// @param picture has taken it already
  [[nodiscard]] std::vector<CauseSeen> in(const SamplesRecord& record, const Picture& picture);
  [[nodiscard]] std::optional<CauseSeen> in(const EventRecord& event) const;

 private:
  struct Seen {
    Edge fault, lost, unexpected_motion, units_disagree;
    std::optional<SteadyNs> failed;  ///< when the newest result 11 came; 0: it was none
  };
  void look(const AxisSample& sample, SteadyNs at, std::vector<CauseSeen>& out);
  void look_at_triggers(const AxisSample& sample, SteadyNs at, const AxisPicture& axis, std::vector<CauseSeen>& out);

  std::vector<Trigger> settings_;
  std::vector<TriggerWatch> triggers_;
  std::map<std::uint16_t, Seen> seen_;
  SteadyNs began_ = 0;
};

}  // namespace axisgate::web
