#include "tests/obey/subject.hpp"

#include <ostream>
#include <stdexcept>

namespace axisgate::test::obey {
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

GatewayStage::Line plain_line(Subject subject) {
  switch (subject) {
    case Subject::jd_serial:
    case Subject::md_serial:
      return line_of(kinco_options(subject).type, 1);
    case Subject::jd_rtu:
    case Subject::md_rtu:
      return rtu_line_of({simulated::KincoRtuDrive{kinco_options(subject), {}}}, 1);
    case Subject::jd_can:
    case Subject::md_can:
      return can_line_of({simulated::KincoCanDrive{kinco_options(subject), {}}}, 1);
    case Subject::leadshine:
      return can_line_of({simulated::LeadshineOptions{}}, 1);
    case Subject::id286pro:
      return rtu_line_of({id286pro_options()}, 1);
    case Subject::keya_can_speed:
    case Subject::keya_can_position:
      return can_line_of({simulated::KeyaCanDrive{keya_options(subject)}}, 1);
    case Subject::keya_canopen_speed:
    case Subject::keya_canopen_position:
      return can_line_of({simulated::KeyaCanopenDrive{keya_options(subject)}}, 1);
    case Subject::keya_rs232_speed:
    case Subject::keya_rs232_position:
      return keya_line_of(KeyaWiring::rs232, {keya_options(subject)}, 1);
    case Subject::keya_rs485_speed:
    case Subject::keya_rs485_position:
      return keya_line_of(KeyaWiring::rs485, {keya_options(subject)}, 1);
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

std::string name(Subject subject) {
  static const std::array<std::string, kSubjects.size()> names{
      "KincoJdSerial",   "KincoMdSerial",       "KincoJdRtu",        "KincoMdRtu",
      "KincoJdCan",      "KincoMdCan",          "LeadshineCan",      "Id286proRtu",
      "KeyaCanSpeed",    "KeyaCanopenSpeed",    "KeyaRs232Speed",    "KeyaRs485Speed",
      "KeyaCanPosition", "KeyaCanopenPosition", "KeyaRs232Position", "KeyaRs485Position"};
  return names.at(static_cast<std::size_t>(subject));
}

void PrintTo(Subject subject, std::ostream* out) { *out << name(subject); }

GatewayStage::Line line_with(Subject subject, std::optional<LeaseRules> lease) {
  GatewayStage::Line line = plain_line(subject);
  line.lease = lease;
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

Truth truth(GatewayStage& stage, Subject subject) {
  using simulated::Cia402State;
  if (is_keya(subject)) {
    const simulated::KeyaDrive& drive = stage.keya(0);
    const simulated::KeyaMotor& motor = drive.at(KeyaMotorName::a);
    const std::int64_t per_rev = kEdges * drive.parameters().of(KeyaMotorName::a, kLinesOfA);
    return {units(motor.count(), per_rev), kMilli * motor.rpm(), motor.enabled(),
            (drive.faults(KeyaMotorName::a) & ~simulated::keya_fault::disabled) != 0};
  }
  if (subject == Subject::id286pro) {
    const simulated::Id286pro& drive = stage.id286pro(0);
    const std::int64_t per_rev = drive.registers().get(kPulsesPerRev);
    return {units(drive.position(), per_rev),
            simulated::rpm_of(drive.axis().speed(), per_rev, kMilli),
            {},
            drive.fault() != 0};
  }
  if (subject == Subject::leadshine) {
    const simulated::LeadshineDrive& drive = stage.leadshine(0);
    return {units(drive.position(), drive.units_per_revolution()),
            simulated::rpm_of(drive.axis().actual_speed(), drive.options().encoder_counts, kMilli),
            drive.state() == Cia402State::operation_enabled, is_fault(drive.state())};
  }
  const simulated::KincoDrive& drive = stage.drive(0);
  const std::int64_t per_rev = drive.model().encoder_counts;
  return {units(drive.position(), per_rev), simulated::rpm_of(drive.axis().actual_speed(), per_rev, kMilli),
          drive.state() == Cia402State::operation_enabled, is_fault(drive.state())};
}

void trip(GatewayStage& stage, Subject subject) {
  if (is_keya(subject)) {
    constexpr std::uint16_t kOvercurrent = 0x0040;  // goes with a disabling
    stage.keya(0).inject_fault(KeyaMotorName::a, kOvercurrent);
    return stage.keya(0).clear_fault_cause(KeyaMotorName::a, kOvercurrent);
  }
  if (subject == Subject::id286pro) {
    constexpr std::uint16_t kSupplyTooHigh = 14;
    stage.id286pro(0).inject_fault(kSupplyTooHigh);
    return stage.id286pro(0).clear_fault_cause();
  }
  if (subject == Subject::leadshine) {
    constexpr std::uint16_t kSupplyTooHigh = 0x3211;
    stage.leadshine(0).inject_fault(kSupplyTooHigh);
    return stage.leadshine(0).clear_fault_cause();
  }
  constexpr std::uint16_t kBusVoltageTooHigh = 0x0020;
  stage.drive(0).inject_fault(1, kBusVoltageTooHigh);
  stage.drive(0).clear_fault_cause(1, kBusVoltageTooHigh);
}

std::optional<TargetObject> target_object(Subject subject) {
  constexpr std::uint16_t kTargetPosition = 0x607A, kItsRegister = 0x4000;
  if (subject == Subject::jd_rtu || subject == Subject::md_rtu) return TargetObject{kItsRegister, 0};
  if (is_cia402(subject)) return TargetObject{kTargetPosition, 0};
  return {};
}

}  // namespace axisgate::test::obey
