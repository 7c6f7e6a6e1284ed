#include "tests/stage/gateway_stage.hpp"

#include <stdexcept>

#include "adapters/kinco/kinco_wire.hpp"

namespace axisgate::test {
namespace {

drive::DriveModel model_of(const StageDrive& staged, const std::optional<std::array<Duration, 3>>& poll) {
  const bool jd = staged.options.type == simulated::KincoType::jd;
  const std::string file =
      std::string(AXISGATE_SOURCE_DIR "/schemas/drives/") + (jd ? "kinco-jd" : "kinco-md") + ".json";
  const drive::LoadedProfile loaded = drive::load_profile(file);
  if (!loaded.faults.empty()) throw std::runtime_error(text(loaded.faults.front()));
  drive::ResolveInput input;
  input.protocol = "kinco-serial";
  input.node = staged.options.station;
  input.constants = staged.constants;
  input.constants.emplace("peak_current_a", jd ? Rational(275, 10) : Rational(36));
  if (poll) input.poll = *poll;
  input.axes = {staged.axis};
  auto resolved = drive::resolve(loaded, input);
  if (auto* faults = std::get_if<std::vector<drive::Fault>>(&resolved)) throw std::runtime_error(text(faults->front()));
  return std::get<drive::DriveModel>(std::move(resolved));
}

}  // namespace

GatewayStage::Line line_of(simulated::KincoType type, AxisNumber axis) {
  StageDrive staged;
  staged.options.type = type;
  staged.axis.number = axis;
  staged.axis.name = "axis " + std::to_string(axis);
  GatewayStage::Line line;
  line.name = "line" + std::to_string(axis);
  line.drives = {staged};
  return line;
}

GatewayStage::GatewayStage(std::vector<Line> lines, std::uint64_t seed)
    : log_([this](LogLevel level, std::string_view source, std::string_view message) {
        log_lines_.push_back(std::string(axisgate::text(level)) + " " + std::string(source) + ": " +
                             std::string(message));
      }) {
  app::Config config;
  app::Models models;
  std::map<std::string, std::unique_ptr<SimLink>> made;
  for (const Line& line : lines) {
    app::BusConfig bus;
    bus.name = line.name;
    bus.adapter = "kinco-serial";
    bus.timeout = std::chrono::milliseconds(100);
    bus.settle = line.drives.size() > 1 ? std::chrono::milliseconds(20) : Duration{};
    auto link = std::make_unique<SimLink>(runtime_, line.options, seed++);
    models.emplace_back();
    for (const StageDrive& staged : line.drives) {
      link->line().add(staged.options);
      app::DriveConfig drive;
      drive.node = staged.options.station;
      bus.drives.push_back(drive);
      models.back().push_back(model_of(staged, line.poll));
    }
    links_.push_back(link.get());
    made.emplace(line.name, std::move(link));
    config.buses.push_back(std::move(bus));
  }
  gateway_ = std::make_unique<app::Gateway>(
      config, std::move(models), runtime_, log_, [&](const app::BusConfig& bus, const std::vector<drive::DriveModel>&) {
        return std::make_unique<kinco::KincoWire>(bus.name, std::move(made.at(bus.name)), runtime_, log_);
      });
  gateway_->start();
}

simulated::KincoDrive& GatewayStage::drive(std::size_t line, std::size_t position) {
  links_[line]->advance_drives();
  return links_[line]->line().drive(position);
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
