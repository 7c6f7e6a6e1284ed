#include "tests/stage/gateway_stage.hpp"

#include <stdexcept>

#include "adapters/kinco/kinco_wire.hpp"
#include "adapters/modbus_rtu/rtu_wire.hpp"
#include "gateway/app/config_sections.hpp"

namespace axisgate::test {
namespace {

/// What the profile and the configuration say of a drive: the profile by its name, found where it is shipped.
struct Entry {
  std::string profile;
  std::string protocol;
  std::uint8_t node = 1;
  drive::ResolveAxis axis;
  std::map<std::string, Rational> constants;
};

drive::DriveModel resolved(Entry entry, const std::optional<std::array<Duration, 3>>& poll) {
  const drive::LoadedProfile loaded =
      drive::load_profile(std::string(AXISGATE_SOURCE_DIR "/schemas/drives/") + entry.profile + ".json");
  if (!loaded.faults.empty()) throw std::runtime_error(text(loaded.faults.front()));
  drive::ResolveInput input;
  input.protocol = entry.protocol;
  input.node = entry.node;
  input.constants = std::move(entry.constants);
  if (poll) input.poll = *poll;
  input.axes = {entry.axis};
  auto model = drive::resolve(loaded, input);
  if (auto* faults = std::get_if<std::vector<drive::Fault>>(&model)) throw std::runtime_error(text(faults->front()));
  return std::get<drive::DriveModel>(std::move(model));
}

void name_kinco(Entry& entry, simulated::KincoType type) {
  const bool jd = type == simulated::KincoType::jd;
  entry.profile = jd ? "kinco-jd" : "kinco-md";
  entry.constants.emplace("peak_current_a", jd ? Rational(275, 10) : Rational(36));
}

Entry entry_of(const StageDrive& staged) {
  Entry entry{{}, "kinco-serial", staged.options.station, staged.axis, staged.constants};
  name_kinco(entry, staged.options.type);
  return entry;
}

Entry entry_of(const RtuStageDrive& staged) {
  Entry entry{"id286pro", "modbus-rtu", unit_of(staged.options), staged.axis, staged.constants};
  const auto* kinco = std::get_if<simulated::KincoRtuDrive>(&staged.options);
  if (kinco != nullptr) name_kinco(entry, kinco->drive.type);
  return entry;
}

std::vector<modbus_rtu::RtuNode> nodes_of(const std::vector<drive::DriveModel>& models) {
  std::vector<modbus_rtu::RtuNode> nodes;
  for (const drive::DriveModel& model : models) {
    nodes.push_back({model.node, model.rtu.low_word_first, model.rtu.error_functions, model.rtu.broadcast});
  }
  return nodes;
}

drive::ResolveAxis axis_named(AxisNumber number) {
  drive::ResolveAxis axis;
  axis.number = number;
  axis.name = "axis " + std::to_string(number);
  return axis;
}

app::BusConfig bus_of(const GatewayStage::Line& line) {
  app::BusConfig bus;
  bus.name = line.name;
  const bool rtu = !line.rtu_drives.empty();
  const bool several = line.drives.size() + line.rtu_drives.size() > 1;
  bus.adapter = rtu ? "modbus-rtu" : "kinco-serial";
  bus.timeout = line.timeout.value_or(rtu ? Duration{} : std::chrono::milliseconds(100));
  bus.settle = several ? std::chrono::milliseconds(20) : Duration{};
  bus.drives.resize(rtu ? line.rtu_drives.size() : line.drives.size());
  if (rtu) {
    constexpr std::uint32_t kUsualBaud = 19200;
    bus.baud = line.rtu_options.baud != 0 ? line.rtu_options.baud : kUsualBaud;
    bus.min_gap = modbus_rtu::gap_time(bus.baud);
    bus.poll_given = line.poll.has_value();
    if (line.poll) bus.poll = *line.poll;
  }
  return bus;
}

}  // namespace

GatewayStage::Line line_of(simulated::KincoType type, AxisNumber axis) {
  StageDrive staged;
  staged.options.type = type;
  staged.axis = axis_named(axis);
  GatewayStage::Line line;
  line.name = "line" + std::to_string(axis);
  line.drives = {staged};
  return line;
}

GatewayStage::Line rtu_line_of(std::vector<simulated::RtuDriveOptions> drives, AxisNumber first) {
  GatewayStage::Line line;
  line.name = "rtu" + std::to_string(first);
  for (simulated::RtuDriveOptions& options : drives) {
    line.rtu_drives.push_back({std::move(options), axis_named(first++), {}});
  }
  return line;
}

GatewayStage::GatewayStage(std::vector<Line> lines, std::uint64_t seed)
    : log_([this](LogLevel level, std::string_view source, std::string_view message) {
        log_lines_.push_back(std::string(axisgate::text(level)) + " " + std::string(source) + ": " +
                             std::string(message));
      }) {
  app::Config config;
  app::Models models;
  std::map<std::string, std::unique_ptr<SimLink>> kinco;
  std::map<std::string, std::unique_ptr<RtuLinkSim>> rtu;
  for (const Line& line : lines) {
    app::BusConfig bus = bus_of(line);
    models.emplace_back();
    if (line.rtu_drives.empty()) {
      auto link = std::make_unique<SimLink>(runtime_, line.options, seed++);
      for (const StageDrive& staged : line.drives) {
        link->line().add(staged.options);
        models.back().push_back(resolved(entry_of(staged), line.poll));
      }
      links_.push_back({link.get(), nullptr});
      kinco.emplace(line.name, std::move(link));
    } else {
      auto link = std::make_unique<RtuLinkSim>(runtime_, line.rtu_options, seed++);
      for (const RtuStageDrive& staged : line.rtu_drives) {
        link->line().add(staged.options);
        models.back().push_back(resolved(entry_of(staged), line.poll));
      }
      links_.push_back({nullptr, link.get()});
      rtu.emplace(line.name, std::move(link));
    }
    for (std::size_t d = 0; d < bus.drives.size(); ++d) bus.drives[d].node = models.back()[d].node;
    config.buses.push_back(std::move(bus));
  }
  app::ConfigFaults faults("stage");
  app::settle_rtu_buses(config, models, faults);
  if (!faults.faults().empty()) throw std::runtime_error(text(faults.faults().front()));
  const app::MakeWire make_wire = [&](const app::BusConfig& bus,
                                      const std::vector<drive::DriveModel>& drives) -> std::unique_ptr<bus::Wire> {
    if (bus.adapter == "kinco-serial") {
      return std::make_unique<kinco::KincoWire>(bus.name, std::move(kinco.at(bus.name)), runtime_, log_);
    }
    return std::make_unique<modbus_rtu::RtuWire>(bus.name, nodes_of(drives), modbus_rtu::LineSpeed{bus.baud, 0},
                                                 std::move(rtu.at(bus.name)), runtime_, log_);
  };
  gateway_ = std::make_unique<app::Gateway>(config, std::move(models), runtime_, log_, make_wire);
  gateway_->start();
}

simulated::KincoDrive& GatewayStage::drive(std::size_t line, std::size_t position) {
  const LinkOfLine& link = links_.at(line);
  if (link.kinco != nullptr) {
    link.kinco->advance_drives();
    return link.kinco->line().drive(position);
  }
  link.rtu->advance_drives();
  simulated::KincoDrive* found = link.rtu->line().kinco(position);
  if (found == nullptr) throw std::invalid_argument("the drive there is no Kinco");
  return *found;
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
