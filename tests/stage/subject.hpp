// SPDX-License-Identifier: Apache-2.0
// The drives of these tests, each on every protocol it speaks; a Keya in each of the two modes that its maker's tool
// can set. Promises one line whose first drive is axis 1. Never says what is right: the tests and the contract do.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test {

enum class Subject : std::uint8_t {
  jd_serial,
  md_serial,
  jd_rtu,
  md_rtu,
  jd_can,
  md_can,
  leadshine,
  id286pro,
  maxon_epos4,
  nanotec_c5e,
  technosoft_ipos,
  elmo_gold,
  faulhaber_mcbl,
  keya_can_speed,
  keya_canopen_speed,
  keya_rs232_speed,
  keya_rs485_speed,
  keya_can_position,
  keya_canopen_position,
  keya_rs232_position,
  keya_rs485_position,
};
inline constexpr std::array kSubjects{
    Subject::jd_serial,
    Subject::md_serial,
    Subject::jd_rtu,
    Subject::md_rtu,
    Subject::jd_can,
    Subject::md_can,
    Subject::leadshine,
    Subject::id286pro,
    Subject::keya_can_speed,
    Subject::keya_canopen_speed,
    Subject::keya_rs232_speed,
    Subject::keya_rs485_speed,
    Subject::keya_can_position,
    Subject::keya_canopen_position,
    Subject::keya_rs232_position,
    Subject::keya_rs485_position,
};
/// Known by their EDS alone: in the tables that say so, since they are CiA 402 drives as others are.
inline constexpr std::array kEdsSubjects{Subject::maxon_epos4, Subject::nanotec_c5e, Subject::technosoft_ipos,
                                         Subject::elmo_gold, Subject::faulhaber_mcbl};

[[nodiscard]] std::string name(Subject subject);
/// For INSTANTIATE_TEST_SUITE_P.
inline constexpr auto named = [](const auto& tested) { return name(tested.param); };
void PrintTo(Subject subject, std::ostream* out);

[[nodiscard]] constexpr bool is_keya(Subject s) { return s >= Subject::keya_can_speed; }
[[nodiscard]] constexpr bool is_eds(Subject s) { return s >= Subject::maxon_epos4 && s <= Subject::faulhaber_mcbl; }
/// Of it.
[[nodiscard]] const simulated::EdsDriveType& eds_type(Subject subject);
[[nodiscard]] constexpr bool is_kinco(Subject s) { return s <= Subject::md_can; }
[[nodiscard]] constexpr bool is_md(Subject s) {
  return s == Subject::md_serial || s == Subject::md_rtu || s == Subject::md_can;
}
[[nodiscard]] constexpr bool has_positions(Subject s) { return !is_keya(s) || s >= Subject::keya_can_position; }
[[nodiscard]] constexpr bool has_speeds(Subject s) { return s < Subject::keya_can_position; }
[[nodiscard]] constexpr bool has_torque(Subject s) {
  return is_kinco(s) || s == Subject::leadshine ||
         (is_eds(s) && s != Subject::technosoft_ipos && s != Subject::faulhaber_mcbl);
}
[[nodiscard]] constexpr bool has_homing(Subject s) { return !is_keya(s); }
/// The drive is a CiA 402 drive; the others' machine is the gateway's.
[[nodiscard]] constexpr bool is_cia402(Subject s) { return is_kinco(s) || s == Subject::leadshine || is_eds(s); }

/// The drive stops by itself when it has heard nobody for a second: CiA 301's heartbeat, or Keya's own watchdog, which
/// is stated for every interface but RS485.
[[nodiscard]] constexpr bool minds_silence(Subject s) {
  switch (s) {
    case Subject::jd_can:
    case Subject::md_can:
    case Subject::leadshine:
      return true;
    default:
      return is_eds(s) || (is_keya(s) && s != Subject::keya_rs485_speed && s != Subject::keya_rs485_position);
  }
}

/// Those of them that `which` is true of, for testing::ValuesIn.
template <class Predicate>
std::vector<Subject> subjects(Predicate which) {
  std::vector<Subject> out;
  for (const Subject subject : kSubjects)
    if (which(subject)) out.push_back(subject);
  return out;
}

/// A line of it may have a second drive.
[[nodiscard]] constexpr bool may_have_neighbour(Subject s) {
  return s != Subject::jd_serial && s != Subject::keya_rs232_speed && s != Subject::keya_rs232_position;
}

/// A commissioned drive of it, alone on its line or beside another one of its kind. `lease`: none where leases are off.
[[nodiscard]] GatewayStage::Line line_with(Subject subject, std::optional<LeaseRules> lease, bool neighbour = false);

/// What the simulated motor does, in the units of the registers. Never asked through the gateway.
struct Truth {
  std::int64_t position = 0;      ///< 1/10000 turn
  std::int64_t velocity = 0;      ///< 0.001 rpm; 0: it stands
  std::optional<bool> enabled{};  ///< none: the drive cannot be disabled over its bus
  bool faulted = false;
  bool torque = true;  ///< false: it has none, and what turns coasts
};
[[nodiscard]] Truth truth(GatewayStage& stage, Subject subject);

/// A motor of the line: which drive of it, and of a Keya which of its two.
struct MotorPlace {
  std::size_t drive = 0;
  simulated::KeyaMotorName motor = simulated::KeyaMotorName::a;
};
[[nodiscard]] Truth truth(GatewayStage& stage, Subject subject, const MotorPlace& place);
/// Of each axis of such a line, from axis 1 on.
[[nodiscard]] std::vector<MotorPlace> motors(Subject subject, bool neighbour);

/// A fault, by the number that the simulated drive knows its cause by; none: a usual one. The cause stays.
void break_down(GatewayStage& stage, Subject subject, std::optional<std::uint16_t> cause = {});
/// What was injected is gone; the fault stays until somebody resets it.
void end_cause(GatewayStage& stage, Subject subject, std::optional<std::uint16_t> cause = {});
/// Both at once.
void trip(GatewayStage& stage, Subject subject, std::optional<std::uint16_t> cause = {});

/// An object of the drive: index and sub-index, or the register of an iD286pro.
struct ObjectPlace {
  std::uint16_t index;
  std::uint8_t sub = 0;
};
/// From now on it has none of these, as one of another type, and refuses them; without any, it is itself again. False:
/// on this protocol no drive refuses anything.
bool lack(GatewayStage& stage, Subject subject, const std::vector<ObjectPlace>& objects);

/// A contact in the way of the torque, wired past the bus: an enable comes to nothing until it closes. Of an iD286pro
/// the hard-wired enable switch.
void lock(GatewayStage& stage, Subject subject, bool locked);
/// The drive acknowledges commands and carries none out; when it comes to, a CiA 402 drive carries out those in effect.
void numb(GatewayStage& stage, Subject subject, bool numb);

/// It shows quick stop active and turns on. Of a CiA 402 drive.
void ignore_quick_stop(GatewayStage& stage, Subject subject, bool ignores);
/// CiA 402: its velocity has noise, and is told late.
void blur_speed(GatewayStage& stage, Subject subject, std::int64_t noise_rpm, Duration late);

/// An object of the drive that can be read at any time: its statusword where it has one, else a speed.
[[nodiscard]] ObjectPlace readable_object(Subject subject);

/// The drive's own object for a position target, in its own counts, where the mailbox can write it without the motor
/// moving for it.
struct TargetObject {
  std::uint16_t index;
  std::uint16_t subindex;
};
[[nodiscard]] std::optional<TargetObject> target_object(Subject subject);

}  // namespace axisgate::test
