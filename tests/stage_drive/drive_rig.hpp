// SPDX-License-Identifier: Apache-2.0
// One simulated drive of any kind, on any protocol, behind the shipped core, with the words in which these tests speak:
// bring it to a state, ask, look at what reached the wire and what the motor does. Promises a fresh world per rig, and
// that what the motor does is asked of the simulated drive, never of the gateway. Never decides what is right: the
// tests do.
#pragma once

#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/stage/subject.hpp"

namespace axisgate::test {

/// A request for an object as it left the gateway: of Kinco's serial protocol, or an expedited SDO (CiA 301 7.2.4.3).
struct WireRequest {
  Instant at;
  bool write = false;
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  std::uint8_t size = 0;
  std::uint32_t data = 0;
  std::uint8_t node = 0;  ///< of an SDO
  friend bool operator==(const WireRequest& a, const WireRequest& b) {
    return a.write == b.write && a.index == b.index && a.sub == b.sub && a.data == b.data;
  }
};
/// Of Kinco's serial protocol.
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
[[nodiscard]] std::string name(LeaseAction action);

[[nodiscard]] constexpr bool is_keya_canopen(Subject s) {
  return s == Subject::keya_canopen_speed || s == Subject::keya_canopen_position;
}
/// 1000 ms without a command and it takes the torque away (Keya 3.1, 4.1, 6.1; none is stated for RS485).
[[nodiscard]] constexpr bool has_command_watchdog(Subject s) { return is_keya(s) && minds_silence(s); }

class DriveRig {
 public:
  explicit DriveRig(Subject subject, std::optional<LeaseRules> lease = {});
  DriveRig(Subject subject, GatewayStage::Line line);

  GatewayStage stage;

  [[nodiscard]] Subject subject() const { return subject_; }
  [[nodiscard]] const AxisImage& axis(AxisNumber number = 1) { return stage.axis(number); }
  [[nodiscard]] simulated::DriveFaults& faults() {
    return *stage.at_link(0, [](auto& link) { return &link.line().faults(0); });
  }
  BatchResult ask(const WriteBatch& batch) { return stage.ask(1, batch); }
  BatchResult command(Command command) { return stage.command(1, command); }
  BatchResult write(Quantity quantity, std::int64_t value) { return stage.write(1, quantity, value); }
  BatchResult mailbox_write(std::uint16_t index, std::uint8_t sub, std::uint8_t size, std::uint32_t data);

  /// There, for so long.
  void bring_to(Situation situation, Duration stays = {});
  void online();
  /// A fault that was seen and whose cause is over.
  void fail_the_drive();
  /// Its power goes and comes back.
  void restart_the_drive();
  /// It neither hears nor is heard, and nobody is told; until mend().
  void silence_the_drive() { hush(true); }
  /// The adapter is pulled, and the gateway sees it; until mend().
  void unplug();
  void mend();
  /// What makes it turn for many seconds: a velocity, or a far target where that is all it can.
  [[nodiscard]] WriteBatch motion() const;
  /// The same by a far target.
  [[nodiscard]] WriteBatch far_move() const;

  // The truth, of the simulated drive.
  [[nodiscard]] bool turns();  ///< within 100 ms
  [[nodiscard]] std::int64_t position();
  /// Under torque by command. An iD286pro always is: there the gateway's gate counts.
  [[nodiscard]] bool powered();
  /// Motor B of a Keya, which nobody ever asks for anything.
  [[nodiscard]] bool neighbour_powered();
  [[nodiscard]] std::uint64_t stores();
  [[nodiscard]] std::uint64_t trips() { return stage.keya(0).trips(); }

  /// From here on; what was repeated in the second before it is known.
  void mark();
  /// Frames since the mark that could enable, start or stop a motor, those aside that were repeated before it.
  [[nodiscard]] std::vector<std::string> commanding();
  /// Since the mark, of the protocols that WireRequest knows.
  [[nodiscard]] std::vector<WireRequest> requests();
  [[nodiscard]] std::vector<WireRequest> writes();
  [[nodiscard]] std::vector<WireRequest> writes_of(std::uint32_t index, std::uint8_t sub = 0);
  [[nodiscard]] std::size_t count(std::uint32_t index, std::uint32_t data);

  [[nodiscard]] bool has_event(EventKind kind, const std::string& part);
  /// Lines of the log that have this in them.
  [[nodiscard]] std::size_t times_told(std::string_view part);
  [[nodiscard]] bool told(std::string_view part) { return times_told(part) > 0; }

 protected:
  [[nodiscard]] std::size_t marked() const { return marked_; }

 private:
  [[nodiscard]] std::size_t frames();
  [[nodiscard]] std::string commanding(std::size_t frame);  ///< empty: it is none
  [[nodiscard]] Instant sent_at(std::size_t frame);
  void hush(bool silent);

  Subject subject_;
  std::size_t marked_ = 0;
  std::set<std::string> known_;
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
