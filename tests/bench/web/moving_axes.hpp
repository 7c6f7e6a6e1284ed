// SPDX-License-Identifier: Apache-2.0
// Axes whose eight values change at a steady rate, and the gateway's half of the web server over them, on a thread of
// its own. Promises that the thread does nothing else, so that its processor time is the gateway's part. Never has a
// drive behind it.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <memory>

namespace axisgate::bench {

class MovingAxes {
 public:
  /// Returns when axisgate-web listens. `axes` change each `every`; 0: none but by set().
  MovingAxes(int axes, std::chrono::milliseconds every, std::uint32_t streams);
  ~MovingAxes();
  MovingAxes(const MovingAxes&) = delete;
  MovingAxes& operator=(const MovingAxes&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] pid_t process() const;
  /// Processor time of the gateway's half until now.
  [[nodiscard]] std::chrono::duration<double> thread_time() const;
  /// The position of axis 1, in turns.
  void set(std::int64_t turns);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace axisgate::bench
