// What the gateway is measured against on Kinco's protocol: the same ten-byte exchanges by a loop of write, poll and
// read, and nothing else. Promises one exchange at a time, timed from before the write to the reply's last byte. Never
// checks more of a reply than its length.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "tests/simulated/ten_byte_frame.hpp"

namespace axisgate::bench {

class BareLoop {
 public:
  /// Throws std::runtime_error.
  explicit BareLoop(const std::string& device);
  ~BareLoop();
  BareLoop(const BareLoop&) = delete;
  BareLoop& operator=(const BareLoop&) = delete;

  /// Throws std::runtime_error if there is no reply for a second.
  std::chrono::nanoseconds exchange(const simulated::TenByteFrame& request) const;

 private:
  int port_;
};

/// The exchanges of parameter writes through the gateway, by a bare loop: write a parameter, read the statusword.
/// Microseconds of each exchange in `lasting`.
[[nodiscard]] std::vector<double> bare_exchanges(const std::string& device, std::chrono::milliseconds lasting);

}  // namespace axisgate::bench
