// SPDX-License-Identifier: Apache-2.0
// The gateway program itself, `axisgate run`, in a process of its own, with simulated drives behind it.
// Promises that every axis is online when it is made, and that it ends with the object.
// Never listens on anything but loopback.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "tests/bench/drive_process.hpp"
#include "tests/bench/process.hpp"

namespace axisgate::bench {

/// Milliseconds between two reads of a value, by class.
struct PollPeriods {
  int fast = 50;
  int normal = 250;
  int slow = 2500;
};
inline constexpr PollPeriods kHardlyPolled{60'000, 60'000, 600'000};

class GatewayProcess {
 public:
  /// Axes 1, 2, ... are the drives of the lines in order. Throws std::runtime_error.
  GatewayProcess(const std::string& program, const std::string& folder, const DriveProcess& drives,
                 const PollPeriods& periods, unsigned processor = 0);
  /// `buses`: as a configuration has them, with axes 1 to `axes`; `listener`: further keys of its listener.
  GatewayProcess(const std::string& program, const std::string& folder, const std::string& buses, int axes,
                 unsigned processor = 0, const std::string& listener = {});

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] int axes() const { return axes_; }
  [[nodiscard]] std::chrono::nanoseconds processor_time() const;
  /// In KiB, as /proc tells: all of it, and the part that is no file's.
  struct Memory {
    std::size_t resident = 0;
    std::size_t anonymous = 0;
  };
  [[nodiscard]] Memory memory() const;

 private:
  void await_axes();

  int axes_ = 0;
  std::uint16_t port_ = 0;
  std::optional<Process> process_;
};

}  // namespace axisgate::bench
