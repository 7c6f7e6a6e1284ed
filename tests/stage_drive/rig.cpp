// SPDX-License-Identifier: Apache-2.0
#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {
namespace {

Subject subject_of(KincoType type) { return type == KincoType::jd ? Subject::jd_serial : Subject::md_serial; }

GatewayStage::Line line(KincoType type, const RigOptions& options) {
  GatewayStage::Line out = line_with(subject_of(type), options.lease);
  StageDrive& staged = out.drives.front();
  const profile::ResolveAxis standard = staged.axis;
  staged.options = options.drive;
  staged.options.type = type;
  staged.axis = options.axis;
  staged.axis.number = standard.number;
  staged.axis.name = standard.name;
  out.options.reply_delay = options.reply_delay;
  out.options.journal_capacity = 100'000;
  return out;
}

}  // namespace

std::string name(KincoType type) { return type == KincoType::jd ? "JD" : "MD"; }

GatewayStage::Line line_of_mds(std::uint8_t count, simulated::Time reply_delay) {
  GatewayStage::Line line = line_of(KincoType::md, 1);
  for (std::uint8_t i = 2; i <= count; ++i) {
    line.drives.push_back(line_of(KincoType::md, i).drives.front());
    line.drives.back().options.station = i;
  }
  line.options.wiring = simulated::Wiring::rs485;
  line.options.reply_delay = reply_delay;
  return line;
}

Rig::Rig(KincoType type, const RigOptions& options) : DriveRig(subject_of(type), line(type, options)) {}

}  // namespace axisgate::test
