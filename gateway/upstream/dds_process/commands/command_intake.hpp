// SPDX-License-Identifier: Apache-2.0
// Commands on their way from the library's threads to the thread that sends them on: decoded, each with the time of its
// arrival, and in that order but for stops, which go first.
// Promises bounds, one for stops and one for all others: beyond its bound the library is asked to keep a sample, and
// its writer sends it again. Never judges a sample beyond that order: what a stop has overtaken the gateway tells by
// the times.
#pragma once

#include <deque>
#include <mutex>
#include <vector>

#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

inline constexpr std::size_t kMaxCommandsWaiting = 4096;
/// Of their own, so that no flood of commands keeps a stop out.
inline constexpr std::size_t kMaxStopsWaiting = 1024;

class CommandIntake {
 public:
  // From any thread.
  [[nodiscard]] bool has_room(bool for_a_stop) const;
  /// Of two, the one that was added later has the later time, whatever `now` is.
  void add(CommandRecord record, SteadyNs now);

  /// At most so many, stops first. No other is taken while stops are left. False: there are more.
  bool take(std::size_t most_stops, std::size_t most_others, std::vector<Record>& taken);

 private:
  mutable std::mutex mutex_;
  SteadyNs newest_ = 0;
  std::deque<CommandRecord> stops_;
  std::deque<CommandRecord> others_;
};

}  // namespace axisgate::dds
