// SPDX-License-Identifier: Apache-2.0
// Commands on their way from the library's threads to the thread that sends them on: decoded, and in the order of their
// arrival but for stops, which go first.
// Promises a bound: beyond it the library is told to keep a sample, and its writer sends it again. Never judges a
// sample beyond that order.
#pragma once

#include <deque>
#include <mutex>
#include <vector>

#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

inline constexpr std::size_t kMaxCommandsWaiting = 4096;

class CommandIntake {
 public:
  // From any thread.
  [[nodiscard]] bool has_room() const;
  /// `stops`: it passes all that are none. What its own writer asks after it stays behind it.
  void add(CommandRecord record, bool stops);

  /// At most `most`.
  void take(std::size_t most, std::vector<Record>& taken);

 private:
  mutable std::mutex mutex_;
  std::deque<CommandRecord> stops_;
  std::deque<CommandRecord> others_;
};

}  // namespace axisgate::dds
