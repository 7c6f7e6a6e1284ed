// SPDX-License-Identifier: Apache-2.0
// What happened around one cause: values of all axes, and events. It stands for itself: names, units and the time of
// day are in it, so that it can be read after another start of the gateway.
// Promises the points of its axis as they came, and of every other axis the lowest, highest and last of each 100 ms.
// Never is longer than before, after and a bound of bytes allow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/upstream/web_process/capture/causes.hpp"
#include "gateway/upstream/web_process/capture/packed_points.hpp"

namespace axisgate::web {

/// That are listed; more are counted.
inline constexpr std::size_t kMostCauses = 64;

struct Capture {
  std::string id;           ///< boot.number
  SteadyNs from = 0;        ///< nothing before it is known
  SteadyNs to = 0;          ///< until it was, or will be, looked
  std::int64_t to_utc = 0;  ///< as Now has it
  bool complete = false;
  bool cut = false;               ///< of other axes not all had room
  std::vector<CauseSeen> causes;  ///< at first what it began with
  std::uint64_t times = 0;        ///< how often one of them came
  std::vector<AxisInfoRecord> axes;
  std::map<Series, PackedPoints> lines;
  std::vector<EventRecord> events;

  [[nodiscard]] const CauseSeen& first() const { return causes.front(); }
  /// Of those of its axis the one that somebody looks for first.
  [[nodiscard]] const CauseSeen& gravest() const;
  [[nodiscard]] bool has(Cause cause, std::uint16_t axis) const;
  [[nodiscard]] const AxisInfoRecord* find(std::uint16_t axis) const;
  /// "trigger: too fast; then over-current; then link_lost of axis 3: the link is lost", of a fault
  [[nodiscard]] std::string text() const;
  /// As EachPoint says.
  void each(Series series, SteadyNs from, SteadyNs to, const Visit& visit) const;
  [[nodiscard]] std::size_t samples() const;
  /// About what it takes in memory.
  [[nodiscard]] std::size_t bytes() const;
};

/// "42.1700": digits, a point, digits. What is no id names no file.
[[nodiscard]] bool is_capture_id(std::string_view text);

}  // namespace axisgate::web
