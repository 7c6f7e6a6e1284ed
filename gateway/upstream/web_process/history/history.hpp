// SPDX-License-Identifier: Apache-2.0
// What each value of each axis was, in register units, as far back as there is room. Pure: records in, points out.
// Promises the instant at which a value was right, to a microsecond; a gap where a value was not valid, was lost or the
// axis was not heard; that all series reach back equally far; and that what stands takes no room. Never guesses a value
// between two.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "gateway/upstream/web_link/records.hpp"
#include "gateway/upstream/web_process/history/chunk_pool.hpp"
#include "gateway/upstream/web_process/time/utc.hpp"
#include "gateway/upstream/web_process/values/series.hpp"

namespace axisgate::web {

/// The gateway tells each axis four times a second: one of which nothing comes for longer is not heard.
inline constexpr SteadyNs kSilentAfter = kSecond;

/// A value that was right at an instant, or the begin of a gap.
struct Point {
  SteadyNs at = 0;
  std::int64_t value = 0;  ///< register units
  bool known = false;      ///< false: a gap begins
  friend bool operator==(const Point&, const Point&) = default;
};
/// False: enough.
using Visit = std::function<bool(const Point&)>;
/// Whatever has points: the history, a capture. Oldest first, at first what held at `from`, as a point at `from`.
using EachPoint = std::function<void(Series, SteadyNs from, SteadyNs to, const Visit& visit)>;

class History {
 public:
  /// @param bytes that runs may take; a list of them for each series comes on top, some hundredth part of it
  explicit History(std::size_t bytes) : pool_(bytes) {}

  /// Of another start of the gateway: all before is void.
  void take(const HelloRecord& record);
  /// Of an axis that is another one than before under this number (name, bus, node, drive, units): its past is void.
  void take(const AxisInfoRecord& record);
  void take(const SamplesRecord& record);

  /// As EachPoint says. Of a value that stays the same the first and the last sample are visited.
  /// @param to at most now: an axis that was not heard for long before it has a gap
  void each(Series series, SteadyNs from, SteadyNs to, const Visit& visit) const;

  /// Nothing that is newer was thrown away; 0: nothing came yet.
  [[nodiscard]] SteadyNs oldest() const { return oldest_us_ * kMicrosecond; }
  /// When the newest samples were made; 0: nothing came yet.
  [[nodiscard]] SteadyNs newest() const { return newest_us_ * kMicrosecond; }
  /// Of runs, of those there may be.
  [[nodiscard]] std::size_t bytes() const { return pool_.bytes(); }
  /// Taken in since the start.
  [[nodiscard]] std::uint64_t samples() const { return samples_; }

 private:
  using Us = std::int64_t;

  /// One series: its runs, and its newest one, which stays when they are thrown away.
  struct Line {
    std::vector<ChunkPool::Place> chunks;  ///< the oldest first
    Us at = 0;                             ///< of the last sample, or of the begin of the gap
    std::uint32_t bits = 0;                ///< of the last value
  };
  struct Axis {
    AxisInfoRecord info{};
    Us heard = 0;             ///< 0: never
    bool lost = false;        ///< since it was heard, samples had no room on their way
    std::uint64_t ever = 0;   ///< by name: there was a value
    std::uint64_t known = 0;  ///< by name: no gap since
    std::array<Line, kSeriesNames> lines{};
  };
  void take(Axis& axis, const AxisSample& sample, Us at);
  void note(Axis& axis, Series series, Us at, std::uint32_t bits, Us made);
  void begin_gap(Axis& axis, Series series, Us at);
  void begin_gaps(Axis& axis, std::uint16_t number, std::uint64_t names, Us at);
  void add_run(Line& line, Series series, Us at, std::uint32_t bits, bool known);
  [[nodiscard]] ChunkPool::Place another_chunk(Series series, Us begin);
  void forget(Axis& axis);
  /// Of the runs that hold or begin behind `from`, the oldest first, until it says false.
  void each_run(const Line& line, Us from, const std::function<bool(const Chunk&, const Run&)>& visit) const;

  ChunkPool pool_;
  std::map<std::uint16_t, Axis> axes_;
  std::uint64_t boot_ = 0;
  std::uint32_t gaps_ = 0;  ///< as the newest record counted them
  Us oldest_us_ = 0;
  Us newest_us_ = 0;
  std::uint64_t samples_ = 0;
};

}  // namespace axisgate::web
