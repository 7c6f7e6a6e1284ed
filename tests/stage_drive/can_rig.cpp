// SPDX-License-Identifier: Apache-2.0
#include "tests/stage_drive/can_rig.hpp"

namespace axisgate::test {
namespace {

GatewayStage::Line line_of(const std::vector<Subject>& servos) {
  std::vector<simulated::CanDriveOptions> out;
  for (const Subject servo : servos) out.push_back(options_of(servo, static_cast<std::uint8_t>(out.size() + 1)));
  return can_line_of(std::move(out), 1);
}

}  // namespace

simulated::CanDriveOptions options_of(Subject servo, std::uint8_t node) {
  if (servo == Subject::leadshine) {
    simulated::LeadshineOptions options;
    options.node = node;
    return options;
  }
  if (is_eds(servo)) return simulated::EdsDriveOptions{.type = &eds_type(servo), .node = node};
  if (is_keya_canopen(servo)) {
    simulated::KeyaCanopenDrive keya;
    keya.drive.node = node;
    return keya;
  }
  simulated::KincoCanDrive kinco;
  kinco.drive.type = is_md(servo) ? simulated::KincoType::md : simulated::KincoType::jd;
  kinco.drive.station = node;
  return kinco;
}

CanRig::CanRig(const std::vector<Subject>& servos) : DriveRig(servos.front(), line_of(servos)) {}

CanRig::CanRig(GatewayStage::Line line) : DriveRig(Subject::leadshine, std::move(line)) {}

bool CanRig::becomes_operational(std::size_t position) {
  return stage.run_until([&] {
    const bool operational = node(position).state() == simulated::NmtState::operational;
    return operational && axis(static_cast<AxisNumber>(position + 1)).link_state == LinkState::online;
  });
}

void CanRig::enable(AxisNumber number) {
  expect(stage.command(number, Command::enable).outcome.code == Errc::ok, "not enabled");
  expect(axis(number).has(AxisInput::enabled), "not shown as enabled");
}

std::vector<std::string> CanRig::nmt() {
  std::vector<std::string> out;
  const auto& sent = stage.can_link(0).sent;
  for (std::size_t i = marked(); i < sent.size(); ++i)
    if (sent[i].frame.id == 0) out.push_back(hex_text(sent[i].frame.bytes()));
  return out;
}

}  // namespace axisgate::test
