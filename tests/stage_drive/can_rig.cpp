// SPDX-License-Identifier: Apache-2.0
#include "tests/stage_drive/can_rig.hpp"

#include <algorithm>

#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {
namespace {

std::vector<simulated::CanDriveOptions> options_of(const std::vector<CanType>& types) {
  std::vector<simulated::CanDriveOptions> out;
  for (const CanType type : types) out.push_back(options_of(type, static_cast<std::uint8_t>(out.size() + 1)));
  return out;
}

}  // namespace

std::string name(CanType type) {
  switch (type) {
    case CanType::leadshine:
      return "leadshine";
    case CanType::jd:
      return "jd";
    case CanType::md:
      return "md";
  }
  return "?";
}

simulated::CanDriveOptions options_of(CanType type, std::uint8_t node) {
  if (type == CanType::leadshine) {
    simulated::LeadshineOptions options;
    options.node = node;
    return options;
  }
  simulated::KincoCanDrive kinco;
  kinco.drive.type = type == CanType::jd ? simulated::KincoType::jd : simulated::KincoType::md;
  kinco.drive.station = node;
  return kinco;
}

CanRig::CanRig(const std::vector<CanType>& types) : CanRig(can_line_of(options_of(types), 1)) {}

CanRig::CanRig(GatewayStage::Line line) : stage({std::move(line)}) {}

void CanRig::online() { expect(stage.come_online(), "the axes never came online"); }

bool CanRig::becomes_operational(std::size_t position) {
  return stage.run_until([&] {
    const bool operational = stage.can_node(0, position).state() == simulated::NmtState::operational;
    return operational && axis(static_cast<AxisNumber>(position + 1)).link_state == LinkState::online;
  });
}

void CanRig::enable(AxisNumber number) {
  expect(stage.command(number, Command::enable).outcome.code == Errc::ok, "not enabled");
  expect(axis(number).has(AxisInput::enabled), "not shown as enabled");
}

std::vector<SdoRequest> CanRig::requests() {
  std::vector<SdoRequest> out;
  const auto& sent = stage.can_link(0).sent;
  for (std::size_t i = marked_; i < sent.size(); ++i) {
    const can::CanFrame& frame = sent[i].frame;
    if ((frame.id & ~0x7FU) != 0x600 || frame.size != 8) continue;
    const std::uint8_t specifier = frame.data[0] & 0xE0;
    if (specifier != 0x20 && specifier != 0x40) continue;
    out.push_back({sent[i].at, static_cast<std::uint8_t>(frame.id & 0x7F), specifier == 0x20, load_le16(frame.data, 1),
                   frame.data[3], load_le(frame.data, 4, 4)});
  }
  return out;
}

std::vector<SdoRequest> CanRig::writes() {
  std::vector<SdoRequest> out = requests();
  std::erase_if(out, [](const SdoRequest& request) { return !request.write; });
  return out;
}

std::vector<std::string> CanRig::nmt() {
  std::vector<std::string> out;
  const auto& sent = stage.can_link(0).sent;
  for (std::size_t i = marked_; i < sent.size(); ++i)
    if (sent[i].frame.id == 0) out.push_back(hex_text(sent[i].frame.bytes()));
  return out;
}

bool CanRig::told(const std::string& words) {
  return std::ranges::any_of(stage.log(), [&](const std::string& line) { return line.find(words) != line.npos; });
}

}  // namespace axisgate::test
