// SPDX-License-Identifier: Apache-2.0
// A pseudo-terminal between the gateway and a simulated drive: passes every byte on, both ways, and notes when each
// command of the gateway arrived. Promises times of the steady clock, taken when the bytes are read and before they are
// passed on. Never holds, changes or answers a byte, and keeps at most kKept commands: more of them are an error.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/axisgate_sim/pty.hpp"
#include "tests/bench/exchange_tap.hpp"
#include "tests/bench/host_commands.hpp"

namespace axisgate::bench {

struct TappedCommand {
  std::chrono::nanoseconds at{};  ///< of the steady clock
  HostCommand command;
};

class TappedLine {
 public:
  static constexpr std::size_t kKept = 1U << 18;

  /// `link`: where the gateway shall find it; `drive`: the simulator's port. Throws std::runtime_error.
  TappedLine(const std::string& link, const std::string& drive, MotionProtocol protocol);
  ~TappedLine();
  TappedLine(const TappedLine&) = delete;
  TappedLine& operator=(const TappedLine&) = delete;

  /// All that came at this time or later. Throws std::runtime_error when more came than are kept.
  [[nodiscard]] std::vector<TappedCommand> since(std::chrono::nanoseconds from) const;
  /// When the first came, at this time or later, that stops the first motor. Throws std::runtime_error after
  /// `patience`.
  [[nodiscard]] std::chrono::nanoseconds await_stop(std::chrono::nanoseconds from, std::chrono::milliseconds patience);

 private:
  void relay();
  void hear_gateway();
  void hear_drive();

  simulated::Pty gateway_;
  simulated::Descriptor drive_;
  simulated::Descriptor ending_;
  std::unique_ptr<HostCommands> commands_;
  mutable std::mutex guard_;
  std::condition_variable more_;
  std::vector<TappedCommand> tapped_;
  bool overflowed_ = false;
  std::thread thread_;
};

}  // namespace axisgate::bench
