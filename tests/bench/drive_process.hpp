// SPDX-License-Identifier: Apache-2.0
// Simulated Kinco JD drives on pseudo-terminals or virtual CAN interfaces, in a process of their own that does as
// little as possible per exchange. Promises the answers of tests/simulated, each after the same time, and a record of
// every exchange in the tap. Never outlives the bench, and never echoes, breaks or delays a frame.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/exchange_tap.hpp"
#include "tests/bench/line_protocol.hpp"
#include "tests/bench/process.hpp"

namespace axisgate::bench {

struct DriveLines {
  int lines = 1;
  int drives_per_line = 1;                  ///< stations 1, 2, ... on each
  std::chrono::nanoseconds reply_after{0};  ///< from the request's last byte to the reply's first
  unsigned processor = 1;
  LineProtocol protocol = LineProtocol::kinco_serial;
  /// CANopen: so often the first drive of each line tells that its motor has made another turn; 0: never. Each is in
  /// the tap as an exchange with the number of the turn for its object.
  std::chrono::nanoseconds turn_every{0};
};

class DriveProcess {
 public:
  /// `folder`: for the links to the ports.
  DriveProcess(const DriveLines& shape, const std::string& folder);
  ~DriveProcess();
  DriveProcess(const DriveProcess&) = delete;
  DriveProcess& operator=(const DriveProcess&) = delete;

  [[nodiscard]] const DriveLines& shape() const { return shape_; }
  [[nodiscard]] const std::string& device(int line = 0) const { return devices_.at(static_cast<std::size_t>(line)); }
  [[nodiscard]] const ExchangeTap& tap() const { return *tap_; }
  void mute(std::uint8_t station) { tap_->mute(station); }

 private:
  DriveLines shape_;
  std::vector<std::string> devices_;
  SharedTap tap_;
  std::optional<ServerProcess> process_;
};

}  // namespace axisgate::bench
