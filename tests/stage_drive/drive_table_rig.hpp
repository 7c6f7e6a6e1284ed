// SPDX-License-Identifier: Apache-2.0
// One simulated drive of any kind, on any protocol, behind the shipped core, for tables that ask the same of all.
// Promises a fresh world per rig, and that what the motor does is asked of the simulated drive, never of the gateway.
// Never decides what is right: the tables do.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {

/// A drive on a protocol; a Keya also in the mode it was set to with its maker's tool.
enum class Subject : std::uint8_t {
  id286pro,
  jd_rtu,
  md_rtu,
  leadshine,
  jd_can,
  md_can,
  jd_serial,
  md_serial,
  keya_can_speed,
  keya_rs232_speed,
  keya_rs485_speed,
  keya_canopen_speed,
  keya_can_position,
  keya_rs232_position,
  keya_rs485_position,
  keya_canopen_position,
};
/// All but Kinco's own serial protocol, which the other tests of this folder speak throughout.
inline constexpr std::array kSubjects{
    Subject::id286pro,
    Subject::jd_rtu,
    Subject::md_rtu,
    Subject::leadshine,
    Subject::jd_can,
    Subject::md_can,
    Subject::keya_can_speed,
    Subject::keya_rs232_speed,
    Subject::keya_rs485_speed,
    Subject::keya_canopen_speed,
    Subject::keya_can_position,
    Subject::keya_rs232_position,
    Subject::keya_rs485_position,
    Subject::keya_canopen_position,
};
[[nodiscard]] std::string name(Subject subject);
[[nodiscard]] std::string name(LeaseAction action);
[[nodiscard]] constexpr bool is_keya(Subject s) { return s >= Subject::keya_can_speed; }
[[nodiscard]] constexpr bool positions_alone(Subject s) { return s >= Subject::keya_can_position; }
[[nodiscard]] constexpr bool is_keya_canopen(Subject s) {
  return s == Subject::keya_canopen_speed || s == Subject::keya_canopen_position;
}
/// 1000 ms without a command and it takes the torque away (Keya 3.1, 4.1, 6.1; none is stated for RS485).
[[nodiscard]] constexpr bool has_command_watchdog(Subject s) {
  return is_keya(s) && s != Subject::keya_rs485_speed && s != Subject::keya_rs485_position;
}

class TableRig {
 public:
  explicit TableRig(Subject subject, std::optional<LeaseRules> lease = {});

  GatewayStage stage;

  [[nodiscard]] Subject subject() const { return subject_; }
  [[nodiscard]] const AxisImage& axis() { return stage.axis(1); }
  BatchResult ask(const WriteBatch& batch) { return stage.ask(1, batch); }
  BatchResult command(Command command) { return stage.command(1, command); }

  /// There, and long enough for each poll and keep-alive to have been seen once.
  void bring_to(Situation situation);
  void online();
  /// A fault that was seen and whose cause is over.
  void fail_the_drive();
  /// Its power goes and comes back.
  void restart_the_drive();
  /// It neither hears nor is heard, and nobody is told; until mend().
  void silence_the_drive();
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

 private:
  [[nodiscard]] std::size_t frames();
  [[nodiscard]] std::string commanding(std::size_t frame);  ///< empty: it is none
  [[nodiscard]] Instant sent_at(std::size_t frame);
  void hush(double rate);

  Subject subject_;
  std::size_t marked_ = 0;
  std::set<std::string> known_;
};

}  // namespace axisgate::test
