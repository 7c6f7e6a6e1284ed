// SPDX-License-Identifier: Apache-2.0
#include "tests/stage/subject.hpp"

#include <ostream>
#include <stdexcept>

namespace axisgate::test {
namespace {

using simulated::KeyaMotorName;
using simulated::KeyaWiring;
using simulated::KincoType;

constexpr std::int64_t kUnitsPerRev = 10000;                            // of the register map, unless configured
constexpr int kModeOfA = 20, kModeOfB = 50, kLinesOfA = 4, kEdges = 4;  // parameters of a Keya (7)
constexpr std::uint16_t kPulsesPerRev = 242;                            // of an iD286pro
constexpr std::int64_t kMilli = 1000;

simulated::KeyaOptions keya_options(Subject subject) {
  simulated::KeyaOptions options;
  const auto mode = has_speeds(subject) ? simulated::KeyaMode::speed : simulated::KeyaMode::absolute;
  options.parameters = {{kModeOfA, static_cast<std::int64_t>(mode)}, {kModeOfB, static_cast<std::int64_t>(mode)}};
  return options;
}

simulated::DriveOptions kinco_options(Subject subject) {
  simulated::DriveOptions options;
  options.type = is_md(subject) ? KincoType::md : KincoType::jd;
  return options;
}

/// With an origin signal on an input (5), as homing needs it.
simulated::Id286proOptions id286pro_options() {
  constexpr std::uint16_t kFunctionOfAnInput = 400;
  constexpr std::int64_t kOriginSignal = 11;
  simulated::Id286proOptions options;
  options.stored = {{kFunctionOfAnInput, kOriginSignal}};
  return options;
}

constexpr std::uint32_t kBaudOfTwo = 38'400;  // twice the usual rate: each of two is polled as often as one alone
constexpr std::uint8_t kNeighbour = 2;        ///< its station, unit or node

/// One of them, or two that differ by their number alone.
template <class Options, class Number>
auto drives(Options options, bool neighbour, const Number& number) {
  std::vector<Options> out(neighbour ? 2 : 1, options);
  if (neighbour) number(out.back()) = kNeighbour;
  return out;
}

/// As what the line takes.
template <class OfLine, class Options>
std::vector<OfLine> as(const std::vector<Options>& drives) {
  return {drives.begin(), drives.end()};
}

GatewayStage::Line kinco_line(Subject subject, bool neighbour) {
  GatewayStage::Line line = line_of(kinco_options(subject).type, 1);
  if (!neighbour) return line;
  line.options.wiring = simulated::Wiring::rs485;
  line.drives.push_back(line_of(kinco_options(subject).type, 2).drives.front());
  line.drives.back().options.station = kNeighbour;
  return line;
}

GatewayStage::Line plain_line(Subject subject, bool neighbour) {
  using simulated::CanDriveOptions;
  using simulated::RtuDriveOptions;
  const auto station = [](auto& kinco) -> auto& { return kinco.drive.station; };
  const auto of_drive = [](auto& keya) -> auto& { return keya.drive.node; };
  const auto node = [](auto& drive) -> auto& { return drive.node; };
  const auto unit = [](auto& drive) -> auto& { return drive.unit; };
  const auto on_can = [&](const auto& all) { return can_line_of(as<CanDriveOptions>(all), 1); };
  const auto on_rtu = [&](const auto& all) { return rtu_line_of(as<RtuDriveOptions>(all), 1); };
  switch (subject) {
    case Subject::jd_serial:
    case Subject::md_serial:
      return kinco_line(subject, neighbour);
    case Subject::jd_rtu:
    case Subject::md_rtu:
      return on_rtu(drives(simulated::KincoRtuDrive{kinco_options(subject), {}}, neighbour, station));
    case Subject::jd_can:
    case Subject::md_can:
      return on_can(drives(simulated::KincoCanDrive{kinco_options(subject), {}}, neighbour, station));
    case Subject::leadshine:
      return on_can(drives(simulated::LeadshineOptions{}, neighbour, node));
    case Subject::id286pro:
      return on_rtu(drives(id286pro_options(), neighbour, unit));
    case Subject::maxon_epos4:
    case Subject::nanotec_c5e:
    case Subject::technosoft_ipos:
    case Subject::elmo_gold:
    case Subject::faulhaber_mcbl:
      return on_can(drives(simulated::EdsDriveOptions{.type = &eds_type(subject)}, neighbour, node));
    case Subject::keya_can_speed:
    case Subject::keya_can_position:
      return on_can(drives(simulated::KeyaCanDrive{keya_options(subject)}, neighbour, of_drive));
    case Subject::keya_canopen_speed:
    case Subject::keya_canopen_position:
      return on_can(drives(simulated::KeyaCanopenDrive{keya_options(subject)}, neighbour, of_drive));
    case Subject::keya_rs232_speed:
    case Subject::keya_rs232_position:
      return keya_line_of(KeyaWiring::rs232, {keya_options(subject)}, 1);
    case Subject::keya_rs485_speed:
    case Subject::keya_rs485_position:
      return keya_line_of(KeyaWiring::rs485, drives(keya_options(subject), neighbour, node), 1);
  }
  throw std::invalid_argument("no such subject");
}

bool is_fault(simulated::Cia402State state) {
  return state == simulated::Cia402State::fault || state == simulated::Cia402State::fault_reaction_active;
}

std::int64_t units(std::int64_t counts, std::int64_t per_rev) {
  return simulated::divide_rounded(counts * kUnitsPerRev, per_rev);
}

}  // namespace

const simulated::EdsDriveType& eds_type(Subject subject) {
  constexpr std::array<std::string_view, kEdsSubjects.size()> names{"maxon-epos4", "nanotec-c5-e", "technosoft-ipos",
                                                                    "elmo-gold", "faulhaber-mcbl"};
  const auto at = static_cast<std::size_t>(subject) - static_cast<std::size_t>(Subject::maxon_epos4);
  return *simulated::eds_drive_type(names.at(at));
}

std::string name(Subject subject) {
  static const std::array<std::string, kSubjects.size() + kEdsSubjects.size()> names{
      "KincoJdSerial",    "KincoMdSerial",  "KincoJdRtu",      "KincoMdRtu",          "KincoJdCan",
      "KincoMdCan",       "LeadshineCan",   "Id286proRtu",     "MaxonEpos4",          "NanotecC5e",
      "TechnosoftIpos",   "ElmoGold",       "FaulhaberMcbl",   "KeyaCanSpeed",        "KeyaCanopenSpeed",
      "KeyaRs232Speed",   "KeyaRs485Speed", "KeyaCanPosition", "KeyaCanopenPosition", "KeyaRs232Position",
      "KeyaRs485Position"};
  return names.at(static_cast<std::size_t>(subject));
}

void PrintTo(Subject subject, std::ostream* out) { *out << name(subject); }

GatewayStage::Line line_with(Subject subject, std::optional<LeaseRules> lease, bool neighbour) {
  GatewayStage::Line line = plain_line(subject, neighbour && may_have_neighbour(subject));
  line.lease = lease;
  if (line.rtu_drives.size() > 1) line.rtu_options.baud = kBaudOfTwo;
  const auto name_torque = [&](auto& staged) {
    if (!is_kinco(subject)) return;
    staged.constants["rated_current_a"] = Rational(5);
    if (is_md(subject)) staged.constants["rated_speed_rpm"] = Rational(3000);
  };
  for (auto& staged : line.drives) name_torque(staged);
  for (auto& staged : line.rtu_drives) name_torque(staged);
  for (auto& staged : line.can_drives) name_torque(staged);
  return line;
}

Truth truth(GatewayStage& stage, Subject subject) { return truth(stage, subject, {}); }

std::vector<MotorPlace> motors(Subject subject, bool neighbour) {
  std::vector<MotorPlace> out;
  for (std::size_t drive = 0; drive < (neighbour && may_have_neighbour(subject) ? 2U : 1U); ++drive) {
    out.push_back({drive, KeyaMotorName::a});
    if (is_keya(subject)) out.push_back({drive, KeyaMotorName::b});
  }
  return out;
}

namespace {

bool has_torque(simulated::Cia402State state) {
  using enum simulated::Cia402State;
  return state == operation_enabled || state == quick_stop_active || state == fault_reaction_active;
}

}  // namespace

Truth truth(GatewayStage& stage, Subject subject, const MotorPlace& place) {
  using simulated::Cia402State;
  if (is_keya(subject)) {
    const simulated::KeyaDrive& drive = stage.keya(0, place.drive);
    const simulated::KeyaMotor& motor = drive.at(place.motor);
    const std::int64_t per_rev = kEdges * drive.parameters().of(place.motor, kLinesOfA);
    return {units(motor.count(), per_rev), kMilli * motor.rpm(), motor.enabled(),
            (drive.faults(place.motor) & ~simulated::keya_fault::disabled) != 0, motor.enabled()};
  }
  if (subject == Subject::id286pro) {
    const simulated::Id286pro& drive = stage.id286pro(0, place.drive);
    const std::int64_t per_rev = drive.registers().get(kPulsesPerRev);
    return {units(drive.position(), per_rev),
            simulated::rpm_of(drive.axis().speed(), per_rev, kMilli),
            {},
            drive.fault() != 0};
  }
  if (subject == Subject::leadshine) {
    const simulated::LeadshineDrive& drive = stage.leadshine(0, place.drive);
    return {units(drive.position(), drive.units_per_revolution()),
            simulated::rpm_of(drive.axis().actual_speed(), drive.options().encoder_counts, kMilli),
            drive.state() == Cia402State::operation_enabled, is_fault(drive.state()), has_torque(drive.state())};
  }
  if (is_eds(subject)) {
    const simulated::EdsDrive& drive = stage.eds_drive(0, place.drive);
    const std::int64_t per_rev = drive.encoder_counts();
    return {units(simulated::counts_of(drive.axis().actual()), per_rev),
            simulated::rpm_of(drive.axis().actual_speed(), per_rev, kMilli),
            drive.state() == Cia402State::operation_enabled, is_fault(drive.state()), has_torque(drive.state())};
  }
  const simulated::KincoDrive& drive = stage.drive(0, place.drive);
  const std::int64_t per_rev = drive.model().encoder_counts;
  return {units(drive.position(), per_rev), simulated::rpm_of(drive.axis().actual_speed(), per_rev, kMilli),
          drive.state() == Cia402State::operation_enabled, is_fault(drive.state()), has_torque(drive.state())};
}

namespace {

/// A supply that is too high; of a Keya an overcurrent, which goes with a disabling.
std::uint16_t usual_cause(Subject subject) {
  constexpr std::uint16_t kInKeya = 0x0040, kInId286pro = 14, kInLeadshine = 0x3211, kInKinco = 0x0020;
  if (is_keya(subject)) return kInKeya;
  if (subject == Subject::id286pro) return kInId286pro;
  return subject == Subject::leadshine || is_eds(subject) ? kInLeadshine : kInKinco;
}

}  // namespace

void break_down(GatewayStage& stage, Subject subject, std::optional<std::uint16_t> cause) {
  const std::uint16_t number = cause.value_or(usual_cause(subject));
  if (is_keya(subject)) return stage.keya(0).inject_fault(KeyaMotorName::a, number);
  if (subject == Subject::id286pro) return stage.id286pro(0).inject_fault(number);
  if (subject == Subject::leadshine) return stage.leadshine(0).inject_fault(number);
  if (is_eds(subject)) return stage.eds_drive(0).inject_fault(number);
  stage.drive(0).inject_fault(1, number);
}

void end_cause(GatewayStage& stage, Subject subject, std::optional<std::uint16_t> cause) {
  const std::uint16_t number = cause.value_or(usual_cause(subject));
  if (is_keya(subject)) return stage.keya(0).clear_fault_cause(KeyaMotorName::a, number);
  if (subject == Subject::id286pro) return stage.id286pro(0).clear_fault_cause();
  if (subject == Subject::leadshine) return stage.leadshine(0).clear_fault_cause();
  if (is_eds(subject)) return stage.eds_drive(0).clear_fault_cause();
  stage.drive(0).clear_fault_cause(1, number);
}

void trip(GatewayStage& stage, Subject subject, std::optional<std::uint16_t> cause) {
  break_down(stage, subject, cause);
  end_cause(stage, subject, cause);
}

bool lack(GatewayStage& stage, Subject subject, const std::vector<ObjectPlace>& objects) {
  std::set<simulated::ObjectKey> keys;
  std::set<std::uint16_t> registers;
  for (const ObjectPlace& object : objects) {
    keys.insert({object.index, object.sub});
    registers.insert(object.index);
  }
  const bool on_can = subject == Subject::jd_can || subject == Subject::md_can || subject == Subject::leadshine ||
                      is_eds(subject) || subject == Subject::keya_canopen_speed ||
                      subject == Subject::keya_canopen_position;
  if (on_can)
    stage.can_node(0).facts().lacks = keys;
  else if (is_kinco(subject))
    stage.drive(0).lack(keys);
  else if (subject == Subject::id286pro)
    stage.id286pro(0).lack(registers);
  else
    return false;
  return true;
}

namespace {

simulated::Cia402Drive& cia402(GatewayStage& stage, Subject subject) {
  if (subject == Subject::leadshine) return stage.leadshine(0);
  if (is_eds(subject)) return stage.eds_drive(0);
  return stage.drive(0);
}

}  // namespace

void lock(GatewayStage& stage, Subject subject, bool locked) {
  if (is_keya(subject)) return stage.keya(0).lock(locked);
  if (subject == Subject::id286pro) return stage.id286pro(0).set_enable_switch(!locked);
  cia402(stage, subject).lock(locked);
}

void ignore_quick_stop(GatewayStage& stage, Subject subject, bool ignores) {
  cia402(stage, subject).ignore_quick_stop(ignores);
}

void blur_speed(GatewayStage& stage, Subject subject, std::int64_t noise_rpm, Duration late) {
  cia402(stage, subject).blur_speed(noise_rpm, late);
}

void numb(GatewayStage& stage, Subject subject, bool numb) {
  if (subject == Subject::id286pro) return stage.id286pro(0).numb(numb);
  if (is_keya(subject)) return stage.keya(0).numb(numb);
  cia402(stage, subject).numb(numb);
}

ObjectPlace readable_object(Subject subject) {
  switch (subject) {
    case Subject::jd_rtu:
    case Subject::md_rtu:
      return {0x3200};
    case Subject::id286pro:
      return {117};
    case Subject::keya_can_speed:
    case Subject::keya_can_position:
      return {0x2103, 1};
    case Subject::keya_canopen_speed:
    case Subject::keya_canopen_position:
      return {0x2012};
    default:
      return is_keya(subject) ? ObjectPlace{0x2102} : ObjectPlace{0x6041};
  }
}

std::optional<TargetObject> target_object(Subject subject) {
  constexpr std::uint16_t kTargetPosition = 0x607A, kItsRegister = 0x4000;
  if (subject == Subject::jd_rtu || subject == Subject::md_rtu) return TargetObject{kItsRegister, 0};
  if (is_cia402(subject)) return TargetObject{kTargetPosition, 0};
  return {};
}

}  // namespace axisgate::test
