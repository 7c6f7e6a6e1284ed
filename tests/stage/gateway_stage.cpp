// SPDX-License-Identifier: Apache-2.0
#include "tests/stage/gateway_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "adapters/canopen/canopen_wire.hpp"
#include "adapters/keya/keya_can_wire.hpp"
#include "adapters/keya/keya_serial_wire.hpp"
#include "adapters/kinco/kinco_wire.hpp"
#include "adapters/modbus_rtu/rtu_wire.hpp"
#include "gateway/compose/can_wires.hpp"
#include "gateway/config/adapter_names.hpp"
#include "gateway/config/config_sections.hpp"
#include "tests/stage/gateway_ends.hpp"
#include "tests/stage/stage_lines.hpp"

namespace axisgate::test {
namespace {

std::vector<modbus_rtu::RtuNode> nodes_of(const std::vector<model::DriveModel>& models) {
  std::vector<modbus_rtu::RtuNode> nodes;
  for (const model::DriveModel& model : models) {
    nodes.push_back({.node = model.node,
                     .low_word_first = model.rtu.low_word_first,
                     .error_functions = model.rtu.error_functions,
                     .worst_reply = model.resync.worst_reply,
                     .broadcast = model.rtu.broadcast});
  }
  return nodes;
}

/// A cable with the drives at its far end.
template <class Link, class Drives, class Options>
std::unique_ptr<Link> link_with(ManualRuntime& runtime, const Drives& drives, const Options& options,
                                std::uint64_t seed) {
  auto link = std::make_unique<Link>(runtime, options, seed);
  for (const auto& staged : drives) link->line().add(staged.options);
  return link;
}

/// All drives of the line; they are of one kind.
std::vector<model::DriveModel> models_on(const GatewayStage::Line& line, const std::string& adapter) {
  std::vector<model::DriveModel> models;
  const auto add = [&](const auto& drives) {
    for (const auto& staged : drives) models.push_back(model_on(staged, line));
  };
  if (config::adapter::on_can(adapter))
    add(line.can_drives);
  else if (adapter == "modbus-rtu")
    add(line.rtu_drives);
  else if (config::adapter::keya_serial(adapter))
    add(line.keya_drives);
  else
    add(line.drives);
  if (line.last_first) std::ranges::reverse(models);
  return models;
}

struct Configured {
  config::Config config;
  compose::Models models;
};

Configured configured(const std::vector<GatewayStage::Line>& lines) {
  Configured out;
  for (const GatewayStage::Line& line : lines) {
    config::BusConfig bus = bus_on(line);
    const auto& of_line = out.models.emplace_back(models_on(line, bus.adapter));
    for (std::size_t d = 0; d < bus.drives.size(); ++d) bus.drives[d].node = of_line[d].node;
    out.config.buses.push_back(std::move(bus));
  }
  config::ConfigFaults faults("stage");
  config::settle_rtu_buses(out.config, out.models, faults);
  config::settle_keya_buses(out.config, out.models, faults);
  if (!faults.faults().empty()) throw std::runtime_error(text(faults.faults().front()));
  return out;
}

}  // namespace

GatewayStage::GatewayStage(std::vector<Line> lines, std::uint64_t seed)
    : log_([this](LogLevel level, const LogSource& source, std::string_view message) {
        log_lines_.push_back(std::string(axisgate::text(level)) + " " + source.words + ": " + std::string(message));
        log_sources_.push_back(source);
      }),
      lines_(std::move(lines)) {
  for (const Line& line : lines_) links_.push_back(link_of(line, seed++));
  start();
}

GatewayStage::LinkOfLine GatewayStage::link_of(const Line& line, std::uint64_t seed) {
  LinkOfLine made;
  const std::string adapter = bus_on(line).adapter;
  if (config::adapter::on_can(adapter))
    made.can = link_with<CanLinkSim>(runtime_, line.can_drives, line.can_options, seed);
  else if (adapter == "modbus-rtu")
    made.rtu = link_with<RtuLinkSim>(runtime_, line.rtu_drives, line.rtu_options, seed);
  else if (config::adapter::keya_serial(adapter))
    made.keya = link_with<KeyaLinkSim>(runtime_, line.keya_drives, line.keya_options, seed);
  else
    made.kinco = link_with<SimLink>(runtime_, line.drives, line.options, seed);
  return made;
}

std::unique_ptr<bus::Wire> GatewayStage::wire_on(const config::BusConfig& bus,
                                                 const std::vector<model::DriveModel>& drives) {
  const auto found = std::ranges::find(lines_, bus.name, &Line::name);
  const LinkOfLine& link = links_.at(static_cast<std::size_t>(found - lines_.begin()));
  if (link.kinco) {
    return std::make_unique<kinco::KincoWire>(bus.name, std::make_unique<ByteEnd<SimLink>>(*link.kinco), runtime_,
                                              log_);
  }
  if (link.keya) {
    const auto line = bus.adapter == config::adapter::kKeyaRs232 ? keya::KeyaLine::rs232 : keya::KeyaLine::rs485;
    return keya::make_keya_serial_wire({bus.name, line, bus.baud}, std::make_unique<ByteEnd<KeyaLinkSim>>(*link.keya),
                                       runtime_, log_);
  }
  if (link.rtu) {
    return std::make_unique<modbus_rtu::RtuWire>(bus.name, nodes_of(drives), modbus_rtu::LineSpeed{bus.baud, 0},
                                                 std::make_unique<RtuEnd>(*link.rtu), runtime_, log_);
  }
  auto end = std::make_unique<CanEnd>(*link.can);
  if (bus.adapter == "canopen") {
    return canopen::make_canopen_wire(compose::canopen_settings(bus, drives), std::move(end), runtime_, log_);
  }
  keya::KeyaCanSettings settings;
  settings.name = bus.name;
  settings.timeout = bus.timeout;
  for (const model::DriveModel& model : drives) settings.nodes.push_back(model.node);
  return keya::make_keya_can_wire(std::move(settings), std::move(end), runtime_, log_);
}

compose::Gateway& GatewayStage::gateway() {
  if (!gateway_) throw std::logic_error("no gateway runs");
  return *gateway_;
}

void GatewayStage::start() {
  if (gateway_) throw std::logic_error("a gateway runs already");
  auto [config, models] = configured(lines_);
  config_ = std::move(config);
  gateway_ = std::make_unique<compose::Gateway>(
      config_, models, runtime_, log_,
      [this](const config::BusConfig& bus, const std::vector<model::DriveModel>& drives) {
        return wire_on(bus, drives);
      });
  gateway_->start();
}

std::shared_ptr<std::optional<GatewayStage::Reasons>> GatewayStage::begin_reload(
    const std::function<void(config::Config&)>& change, std::function<Reasons()> last_word) {
  Configured all = configured(lines_);
  config::Config wanted = config_;
  change(wanted);
  compose::Models models;
  for (const config::BusConfig& bus : wanted.buses) {
    const auto found = std::ranges::find(all.config.buses, bus.name, &config::BusConfig::name);
    models.push_back(all.models.at(static_cast<std::size_t>(found - all.config.buses.begin())));
  }
  auto place = std::make_shared<std::optional<Reasons>>();
  gateway().reload(compose::plan_reload(config_, wanted), wanted, std::move(models), std::move(last_word),
                   [this, place, wanted](Reasons why_not) {
                     if (why_not.empty()) config_ = wanted;
                     *place = std::move(why_not);
                   });
  return place;
}

void GatewayStage::expect_nothing_held_back() const {
  if (gateway_ == nullptr) return;
  std::string held;
  for (const std::string& line : log_lines_)
    if (line.find("was held back") != std::string::npos) held += line + "\n";
  for (const auto& axis : gateway_->image().axes()) EXPECT_EQ(axis->record.held_back(), 0U) << held;
}

void GatewayStage::crash(const std::function<void()>& others) {
  for (std::size_t line = 0; line < links_.size(); ++line) at_link(line, [](auto& link) { link.let_go(); });
  expect_nothing_held_back();
  gateway().stop();  // a dead process answers no session's end
  others();
  gateway_.reset();
}

simulated::KincoDrive& GatewayStage::drive(std::size_t line, std::size_t position) {
  const LinkOfLine& link = links_.at(line);
  simulated::KincoDrive* found = nullptr;
  if (link.kinco) {
    link.kinco->advance_drives();
    return link.kinco->line().drive(position);
  }
  if (link.rtu) {
    link.rtu->advance_drives();
    found = link.rtu->line().kinco(position);
  } else if (link.can) {
    link.can->advance_drives();
    found = link.can->line().kinco(position);
  }
  if (found == nullptr) throw std::invalid_argument("the drive there is no Kinco");
  return *found;
}

simulated::KeyaDrive& GatewayStage::keya(std::size_t line, std::size_t position) {
  if (const auto& link = links_.at(line).keya) {
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

simulated::EdsDrive& GatewayStage::eds_drive(std::size_t line, std::size_t position) {
  can_link(line).advance_drives();
  simulated::EdsDrive* found = can_link(line).line().eds_drive(position);
  if (found == nullptr) throw std::invalid_argument("the drive there is known otherwise than by its EDS");
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

simulated::Em2rs& GatewayStage::em2rs(std::size_t line, std::size_t position) {
  rtu_link(line).advance_drives();
  simulated::Em2rs* found = rtu_link(line).line().em2rs(position);
  if (found == nullptr) throw std::invalid_argument("the drive there is no EM2RS");
  return *found;
}

simulated::Zlac8015d& GatewayStage::zlac8015d(std::size_t line, std::size_t position) {
  rtu_link(line).advance_drives();
  simulated::Zlac8015d* found = rtu_link(line).line().zlac8015d(position);
  if (found == nullptr) throw std::invalid_argument("the drive there is no ZLAC8015D");
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

std::shared_ptr<std::optional<BatchResult>> GatewayStage::begin(AxisNumber axis, WriteBatch batch) {
  if (batch.role == Role::viewer) batch.role = Role::engineer;
  if (batch.start_by == kNever) batch.start_by = runtime_.now() + std::chrono::milliseconds(500);
  if (batch.answer_by == kNever) batch.answer_by = runtime_.now() + std::chrono::milliseconds(900);
  auto place = std::make_shared<std::optional<BatchResult>>();
  if (auto result = gateway().submit(axis, batch, [place](const BatchResult& r) { *place = r; })) *place = result;
  return place;
}

BatchResult GatewayStage::ask(AxisNumber axis, WriteBatch batch) {
  const auto place = begin(axis, std::move(batch));
  if (!run_until([&] { return place->has_value(); })) throw std::runtime_error("a write batch never got its result");
  return **place;
}

BatchResult GatewayStage::command(AxisNumber axis, Command command) {
  WriteBatch batch;
  batch.command = command;
  return ask(axis, batch);
}

BatchResult GatewayStage::write(AxisNumber axis, Quantity quantity, std::int64_t value) {
  WriteBatch batch;
  if (quantity == Quantity::mode) {
    batch.mode = static_cast<std::int16_t>(value);
  } else if (quantity == Quantity::controlword) {
    batch.controlword = static_cast<std::uint16_t>(value);
    batch.single_controlword = true;
  } else {
    batch.setpoints.push_back({quantity, value});
  }
  return ask(axis, batch);
}

}  // namespace axisgate::test
