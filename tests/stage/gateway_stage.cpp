#include "tests/stage/gateway_stage.hpp"

#include <stdexcept>

#include "adapters/canopen/canopen_wire.hpp"
#include "adapters/keya/keya_can_wire.hpp"
#include "adapters/keya/keya_serial_wire.hpp"
#include "adapters/kinco/kinco_wire.hpp"
#include "adapters/modbus_rtu/rtu_wire.hpp"
#include "gateway/app/adapter_names.hpp"
#include "gateway/app/can_wires.hpp"
#include "gateway/app/config_sections.hpp"
#include "tests/stage/stage_lines.hpp"

namespace axisgate::test {
namespace {

std::vector<modbus_rtu::RtuNode> nodes_of(const std::vector<drive::DriveModel>& models) {
  std::vector<modbus_rtu::RtuNode> nodes;
  for (const drive::DriveModel& model : models) {
    nodes.push_back({model.node, model.rtu.low_word_first, model.rtu.error_functions, model.rtu.broadcast});
  }
  return nodes;
}

/// A line's far end with its drives on it.
template <class Link, class Drives, class Options>
std::unique_ptr<Link> link_with(ManualRuntime& runtime, const Drives& drives, const Options& options,
                                const GatewayStage::Line& line, std::uint64_t seed,
                                std::vector<drive::DriveModel>& models) {
  auto link = std::make_unique<Link>(runtime, options, seed);
  for (const auto& staged : drives) {
    link->line().add(staged.options);
    models.push_back(model_on(staged, line));
  }
  return link;
}

}  // namespace

GatewayStage::GatewayStage(std::vector<Line> lines, std::uint64_t seed)
    : log_([this](LogLevel level, std::string_view source, std::string_view message) {
        log_lines_.push_back(std::string(axisgate::text(level)) + " " + std::string(source) + ": " +
                             std::string(message));
      }) {
  app::Config config;
  app::Models models;
  std::map<std::string, std::unique_ptr<SimLink>> kinco;
  std::map<std::string, std::unique_ptr<RtuLinkSim>> rtu;
  std::map<std::string, std::unique_ptr<CanLinkSim>> can;
  std::map<std::string, std::unique_ptr<KeyaLinkSim>> keya;
  for (const Line& line : lines) {
    app::BusConfig bus = bus_on(line);
    auto& of_line = models.emplace_back();
    LinkOfLine ends;
    if (app::adapter::on_can(bus.adapter)) {
      auto link = link_with<CanLinkSim>(runtime_, line.can_drives, line.can_options, line, seed++, of_line);
      ends.can = link.get();
      can.emplace(line.name, std::move(link));
    } else if (bus.adapter == "modbus-rtu") {
      auto link = link_with<RtuLinkSim>(runtime_, line.rtu_drives, line.rtu_options, line, seed++, of_line);
      ends.rtu = link.get();
      rtu.emplace(line.name, std::move(link));
    } else if (app::adapter::keya_serial(bus.adapter)) {
      auto link = link_with<KeyaLinkSim>(runtime_, line.keya_drives, line.keya_options, line, seed++, of_line);
      ends.keya = link.get();
      keya.emplace(line.name, std::move(link));
    } else {
      auto link = link_with<SimLink>(runtime_, line.drives, line.options, line, seed++, of_line);
      ends.kinco = link.get();
      kinco.emplace(line.name, std::move(link));
    }
    links_.push_back(ends);
    for (std::size_t d = 0; d < bus.drives.size(); ++d) bus.drives[d].node = of_line[d].node;
    config.buses.push_back(std::move(bus));
  }
  app::ConfigFaults faults("stage");
  app::settle_rtu_buses(config, models, faults);
  app::settle_keya_buses(config, models, faults);
  if (!faults.faults().empty()) throw std::runtime_error(text(faults.faults().front()));
  const app::MakeWire make_wire = [&](const app::BusConfig& bus,
                                      const std::vector<drive::DriveModel>& drives) -> std::unique_ptr<bus::Wire> {
    if (bus.adapter == "kinco-serial") {
      return std::make_unique<kinco::KincoWire>(bus.name, std::move(kinco.at(bus.name)), runtime_, log_);
    }
    if (app::adapter::keya_serial(bus.adapter)) {
      const auto line = bus.adapter == app::adapter::kKeyaRs232 ? keya::KeyaLine::rs232 : keya::KeyaLine::rs485;
      return keya::make_keya_serial_wire({bus.name, line, bus.baud}, std::move(keya.at(bus.name)), runtime_, log_);
    }
    if (bus.adapter == app::adapter::kKeyaCan) {
      keya::KeyaCanSettings settings;
      settings.name = bus.name;
      settings.timeout = bus.timeout;
      for (const drive::DriveModel& model : drives) settings.nodes.push_back(model.node);
      return keya::make_keya_can_wire(std::move(settings), std::move(can.at(bus.name)), runtime_, log_);
    }
    if (bus.adapter == "canopen") {
      return canopen::make_canopen_wire(app::canopen_settings(bus, drives), std::move(can.at(bus.name)), runtime_,
                                        log_);
    }
    return std::make_unique<modbus_rtu::RtuWire>(bus.name, nodes_of(drives), modbus_rtu::LineSpeed{bus.baud, 0},
                                                 std::move(rtu.at(bus.name)), runtime_, log_);
  };
  gateway_ = std::make_unique<app::Gateway>(config, std::move(models), runtime_, log_, make_wire);
  gateway_->start();
}

simulated::KincoDrive& GatewayStage::drive(std::size_t line, std::size_t position) {
  const LinkOfLine& link = links_.at(line);
  simulated::KincoDrive* found = nullptr;
  if (link.kinco != nullptr) {
    link.kinco->advance_drives();
    return link.kinco->line().drive(position);
  }
  if (link.rtu != nullptr) {
    link.rtu->advance_drives();
    found = link.rtu->line().kinco(position);
  } else if (link.can != nullptr) {
    link.can->advance_drives();
    found = link.can->line().kinco(position);
  }
  if (found == nullptr) throw std::invalid_argument("the drive there is no Kinco");
  return *found;
}

simulated::KeyaDrive& GatewayStage::keya(std::size_t line, std::size_t position) {
  if (KeyaLinkSim* link = links_.at(line).keya) {
    link->advance_drives();
    return link->line().drive(position);
  }
  can_link(line).advance_drives();
  simulated::KeyaDrive* found = can_link(line).line().keya(position);
  if (found == nullptr) throw std::invalid_argument("the drive there is no Keya");
  return *found;
}

simulated::LeadshineDrive& GatewayStage::leadshine(std::size_t line, std::size_t position) {
  can_link(line).advance_drives();
  simulated::LeadshineDrive* found = can_link(line).line().leadshine(position);
  if (found == nullptr) throw std::invalid_argument("the drive there is no Leadshine");
  return *found;
}

simulated::CanopenNode& GatewayStage::can_node(std::size_t line, std::size_t position) {
  can_link(line).advance_drives();
  return can_link(line).line().node(position);
}

simulated::Id286pro& GatewayStage::id286pro(std::size_t line, std::size_t position) {
  rtu_link(line).advance_drives();
  simulated::Id286pro* found = rtu_link(line).line().id286pro(position);
  if (found == nullptr) throw std::invalid_argument("the drive there is no iD286pro");
  return *found;
}

bool GatewayStage::run_until(const std::function<bool()>& done, Duration limit) {
  const Instant end = runtime_.now() + limit;
  while (!done()) {
    // A drive moves between two exchanges as well: look at least each millisecond.
    if (runtime_.now() >= end) return false;
    runtime_.advance_by(std::chrono::milliseconds(1));
  }
  return true;
}

std::shared_ptr<std::optional<GroupResult>> GatewayStage::begin(AxisNumber axis, Group group) {
  if (group.role == Role::viewer) group.role = Role::engineer;
  if (group.start_by == kNever) group.start_by = runtime_.now() + std::chrono::milliseconds(500);
  if (group.answer_by == kNever) group.answer_by = runtime_.now() + std::chrono::milliseconds(900);
  auto place = std::make_shared<std::optional<GroupResult>>();
  if (auto result = gateway_->submit(axis, group, [place](const GroupResult& r) { *place = r; })) *place = result;
  return place;
}

GroupResult GatewayStage::ask(AxisNumber axis, Group group) {
  const auto place = begin(axis, std::move(group));
  if (!run_until([&] { return place->has_value(); })) throw std::runtime_error("a group never got its result");
  return **place;
}

GroupResult GatewayStage::command(AxisNumber axis, Command command) {
  Group group;
  group.command = command;
  return ask(axis, group);
}

GroupResult GatewayStage::write(AxisNumber axis, Quantity quantity, std::int64_t value) {
  Group group;
  if (quantity == Quantity::mode) {
    group.mode = static_cast<std::int16_t>(value);
  } else if (quantity == Quantity::controlword) {
    group.controlword = static_cast<std::uint16_t>(value);
    group.single_controlword = true;
  } else {
    group.setpoints.push_back({quantity, value});
  }
  return ask(axis, group);
}

}  // namespace axisgate::test
