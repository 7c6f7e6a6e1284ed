// SPDX-License-Identifier: Apache-2.0
// One simulated Kinco drive behind the shipped core, with the words in which these tests speak: bring it to a state,
// ask, look at what reached the wire and what the motor does. Promises a fresh world per rig. Never decides what is
// right: the tests do.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test {

using simulated::KincoType;

/// A request as it left the gateway.
struct WireRequest {
  Instant at;
  bool write = false;
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  std::uint8_t size = 0;
  std::uint32_t data = 0;
  friend bool operator==(const WireRequest& a, const WireRequest& b) {
    return a.write == b.write && a.index == b.index && a.sub == b.sub && a.data == b.data;
  }
};
[[nodiscard]] WireRequest decoded(Instant at, Bytes frame);

inline constexpr std::uint32_t kControlword = 0x6040, kStatusword = 0x6041, kMode = 0x6060, kTargetPosition = 0x607A,
                               kTargetVelocity = 0x60FF;

/// Where an axis may stand when it is asked something.
enum class Situation : std::uint8_t {
  disabled,
  enabled,
  moving,   ///< a long absolute move
  running,  ///< command 8
  homing,   ///< after a switch that never comes
  halted,
  latched,  ///< quick-stopped
  faulted,
  in_setup,
  suspect,
  offline,
  link_down,
};
[[nodiscard]] std::string name(Situation situation);
[[nodiscard]] std::string name(KincoType type);

struct RigOptions {
  simulated::DriveOptions drive{};
  drive::ResolveAxis axis{};
  simulated::Time reply_delay = std::chrono::milliseconds(2);
  std::optional<LeaseRules> lease{};  ///< none: leases are off
};

class Rig {
 public:
  explicit Rig(KincoType type, RigOptions options = {});

  GatewayStage stage;

  [[nodiscard]] KincoType type() const { return type_; }
  [[nodiscard]] const AxisImage& axis() { return stage.axis(1); }
  [[nodiscard]] simulated::KincoDrive& motor() { return stage.drive(0); }
  [[nodiscard]] simulated::DriveFaults& faults() { return stage.link(0).line().faults(0); }

  void bring_to(Situation situation);
  void online();

  BatchResult command(Command command) { return stage.command(1, command); }
  BatchResult write(Quantity quantity, std::int64_t value) { return stage.write(1, quantity, value); }
  BatchResult ask(const WriteBatch& batch) { return stage.ask(1, batch); }
  BatchResult mailbox_write(std::uint16_t index, std::uint8_t sub, std::uint8_t size, std::uint32_t data);

  /// Writes sent since the last mark().
  void mark() { marked_ = stage.link(0).sent.size(); }
  [[nodiscard]] std::vector<WireRequest> requests();
  [[nodiscard]] std::vector<WireRequest> writes();
  [[nodiscard]] std::vector<WireRequest> writes_of(std::uint32_t index, std::uint8_t sub = 0);
  [[nodiscard]] std::size_t count(std::uint32_t index, std::uint32_t data);

  [[nodiscard]] bool motor_enabled() { return motor().state() == simulated::Cia402State::operation_enabled; }
  [[nodiscard]] std::int64_t object(std::uint16_t index, std::uint8_t sub = 0) { return *motor().peek({index, sub}); }
  /// Position changes by more than a count within 100 ms.
  [[nodiscard]] bool turns();
  [[nodiscard]] bool has_event(EventKind kind, const std::string& part);

 private:
  KincoType type_;
  std::size_t marked_ = 0;
};

/// Throws where a rig does not come to where its test begins.
inline void expect(bool what, const char* why) {
  if (!what) throw std::runtime_error(why);
}

/// A write batch of set-points alone.
[[nodiscard]] WriteBatch setpoints(std::initializer_list<Setpoint> list);
/// A write batch with a command and set-points.
[[nodiscard]] WriteBatch with_command(Command command, std::initializer_list<Setpoint> list = {});
/// A raw controlword; `single`: in a write of its own.
[[nodiscard]] WriteBatch with_controlword(std::uint16_t word, bool single = true);

}  // namespace axisgate::test
