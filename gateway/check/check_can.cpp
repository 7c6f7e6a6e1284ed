// SPDX-License-Identifier: Apache-2.0
#include "gateway/check/check_sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "adapters/can/can_device.hpp"

namespace axisgate::check {
namespace {

/// "statusword, position_actual at most each 5 ms"
std::string tpdo_text(const model::DriveModel& model, const model::TpdoProperties& tpdo) {
  std::vector<std::string_view> names;
  for (const model::ObjectId id : tpdo.map) names.push_back(model.object(id).name);
  std::string out = fmt::format("{}", fmt::join(names, ", "));
  if (tpdo.inhibit_time > Duration{}) out += fmt::format(" at most each {:g} ms", in_ms(tpdo.inhibit_time));
  if (tpdo.event_ms) out += fmt::format(", at least each {} ms", *tpdo.event_ms);
  return out;
}

std::string mapping_text(const model::DriveModel& model) {
  std::vector<std::string> parts;
  for (const model::TpdoProperties& tpdo : model.canopen.tpdos) parts.push_back(tpdo_text(model, tpdo));
  return parts.empty() ? std::string("nothing") : fmt::format("{}", fmt::join(parts, "; "));
}

std::string watched_text(const model::CanopenProperties& facts) {
  if (facts.heartbeat > Duration{}) return fmt::format("heartbeat each {:g} ms", in_ms(facts.heartbeat));
  if (facts.guard_time > Duration{})
    return fmt::format("guarded each {:g} ms, gone after {}", in_ms(facts.guard_time), facts.life_factor);
  return "neither heartbeat nor guarding: only requests tell that it is there";
}

/// Each text with the nodes it is true of, so that ten equal drives take one line.
template <class Text>
void add_by_node(ReportLines& out, const std::string& label, const std::vector<model::DriveModel>& drives, Text text) {
  std::vector<std::pair<std::string, std::vector<int>>> lines;
  for (const model::DriveModel& model : drives) {
    const std::string said = text(model);
    const auto same = [&](const auto& line) { return line.first == said; };
    auto at = std::ranges::find_if(lines, same);
    if (at == lines.end()) at = lines.insert(lines.end(), {said, {}});
    at->second.push_back(model.node);
  }
  bool first = true;
  for (const auto& [said, nodes] : lines) {
    const bool one = nodes.size() == 1;
    out.emplace_back(first ? label : "", fmt::format("node{} {}: {}", one ? "" : "s", fmt::join(nodes, ", "), said));
    first = false;
  }
}

}  // namespace

std::string bitrate_text(const config::BusConfig& bus) {
  return fmt::format("{} bit/s{}", bus.bitrate, bus.bitrate_given ? "" : " assumed");
}

std::string interface_text(const config::BusConfig& bus) {
  if (can::parse_can_device(bus.device).lawicel)
    return fmt::format("a serial CAN adapter, which the gateway opens at {} bit/s", bus.bitrate);
  const std::string how = fmt::format("ip link set {} up type can bitrate {} restart-ms 100", bus.device, bus.bitrate);
  if (bus.bitrate_given) return fmt::format("bring it up as root: {}", how);
  return fmt::format(
      "bring it up as root, with the bit rate of the drives: {}; that rate is assumed below, \"bitrate\" "
      "gives another",
      how);
}

ReportLines can_lines(const config::BusConfig& bus, const std::vector<model::DriveModel>& drives,
                      const config::BusBudget& budget) {
  ReportLines out;
  out.emplace_back("interface", interface_text(bus));
  add_by_node(out, "by TPDO", drives, mapping_text);
  out.emplace_back("", "the mapping is tried at bring-up: what a drive refuses is polled by SDO like the rest");
  add_by_node(out, "watched by", drives, [](const model::DriveModel& model) { return watched_text(model.canopen); });
  out.emplace_back("confirmed",
                   budget.confirmed.reads == 0
                       ? std::string("nothing")
                       : fmt::format("{} values that come by TPDO, each read by SDO where it was silent for {:g} ms",
                                     budget.confirmed.reads, in_ms(budget.confirmed.period)));
  out.emplace_back(
      "unasked", fmt::format("TPDOs as often as they may come, heartbeats and guarding: {:.1f} % of the line; without "
                             "any mapping the polls would take {:.1f} %",
                             budget.load_unsolicited / 10.0, budget.load_unmapped / 10.0));
  return out;
}

}  // namespace axisgate::check
