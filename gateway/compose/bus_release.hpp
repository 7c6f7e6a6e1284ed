// SPDX-License-Identifier: Apache-2.0
// Takes buses out of service while the gateway goes on: for a reload.
// Promises all or nothing: only where every drive of them is online, and a read that came after the last command was
// accepted shows that no motor has torque, are the buses released; else every one accepts commands again, and what made
// it miss the gateway is as before. Commands that are under way have their end first. Promises an answer within twice
// kBusReleaseStep. Never enables, stops or moves anything.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/compose/bus_line.hpp"

namespace axisgate::compose {

/// For each of its two steps: the reads of the state (and before them the end of commands), and the drives' forgetting
/// of the gateway.
inline constexpr Duration kBusReleaseStep = std::chrono::seconds(3);

class BusRelease {
 public:
  using Reasons = std::vector<std::string>;
  /// `done(why_not)`: once, in a turn of its own; empty: the buses are released, and only their end may follow.
  /// Otherwise one line for each axis that is in the way, or what `last_word` gave when they could be released. The
  /// buses outlive this object.
  BusRelease(Runtime& runtime, const std::vector<BusLine*>& buses, std::function<Reasons()> last_word,
             std::function<void(Reasons why_not)> done);
  ~BusRelease();
  BusRelease(const BusRelease&) = delete;
  BusRelease& operator=(const BusRelease&) = delete;

 private:
  using Closing = drive::Drive::Closing;
  void close(Closing why, Instant by);
  void step();
  void reopen();
  void end(Reasons why_not);
  [[nodiscard]] Reasons in_the_way() const;
  [[nodiscard]] std::string why_not(const drive::Drive& drive, const drive::Axis& axis) const;
  [[nodiscard]] bool commands_are_under_way() const;

  Runtime& runtime_;
  const Instant looked_by_;
  std::vector<drive::Drive*> drives_;
  std::function<Reasons()> last_word_;
  std::function<void(Reasons)> done_;
  Closing step_ = Closing::look;
  bool closed_ = false;                      ///< the drives accept only stops, and are ours to open again
  std::vector<const drive::Drive*> open_{};  ///< not closed yet
  std::unique_ptr<Timer> timer_;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
};

}  // namespace axisgate::compose
