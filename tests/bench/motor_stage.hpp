// SPDX-License-Identifier: Apache-2.0
// Simulated drives of several makers, each on a line of its own that is tapped, and one gateway in front of them all.
// Promises that every axis is online when it is made. Never enables an axis but by `run`.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/bench/benches.hpp"
#include "tests/bench/gateway_process.hpp"
#include "tests/bench/modbus_client.hpp"
#include "tests/bench/simulator_process.hpp"
#include "tests/bench/tapped_line.hpp"

namespace axisgate::bench {

/// A drive as the figures, the simulator and a configuration call it.
struct MotorDrive {
  std::string_view name;
  MotionProtocol protocol;
  std::string_view simulated;  ///< behind the port's path
  std::string_view bus;        ///< keys of the bus, but name, device and drives
  bool lawicel;
  std::string_view drive;  ///< keys of the drive, but its axes
  int axes;
};
/// Every protocol, with one drive of it.
[[nodiscard]] std::span<const MotorDrive> motor_drives();
[[nodiscard]] const MotorDrive& motor_drive(MotionProtocol protocol);

struct StageOptions {
  int lease_ms = 2000;
  std::string listener;  ///< further keys of the listener
};

class MotorStage {
 public:
  MotorStage(const BenchOptions& options, std::vector<MotorDrive> drives, const StageOptions& stage);

  [[nodiscard]] std::uint16_t port() const { return gateway_->port(); }
  [[nodiscard]] std::size_t lines() const { return drives_.size(); }
  [[nodiscard]] const MotorDrive& drive(std::size_t line) const { return drives_.at(line); }
  [[nodiscard]] TappedLine& tap(std::size_t line) { return *taps_.at(line); }
  /// Axes are counted through: the first of each line's drive.
  [[nodiscard]] int first_axis(std::size_t line) const;
  /// What the simulated drive of this line answers to a word of the control socket.
  [[nodiscard]] std::string ask(std::size_t line, std::string_view word) const;

 private:
  std::vector<MotorDrive> drives_;
  std::optional<SimulatorProcess> simulator_;
  std::vector<std::unique_ptr<TappedLine>> taps_;
  std::optional<GatewayProcess> gateway_;
};

inline constexpr std::uint16_t kTargetVelocityOffset = 44;
/// In 1/1000 rpm; every drive here can do it.
inline constexpr std::uint32_t kRunningVelocity = 100'000;

/// A new client that owns this axis and has enabled it and made it run: tried until it succeeds, for 10 s at most,
/// since a stop may still be under way. Throws std::runtime_error.
[[nodiscard]] ModbusClient running_axis(std::uint16_t port, int axis);

}  // namespace axisgate::bench
