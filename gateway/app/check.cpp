#include "gateway/app/check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "gateway/app/bus_budget.hpp"
#include "gateway/app/check_can.hpp"

namespace axisgate::app {
namespace {

using std::chrono::milliseconds;

constexpr std::array<std::string_view, 3> kClassNames{"fast", "normal", "slow"};
/// Largest position a register shows.
constexpr double kRegisterReach = 2147483647;

double in_ms(Duration duration) { return static_cast<double>(duration.count()) / 1e6; }

/// "  label            text": the labels of one report line up.
void add_line(std::string& out, std::string_view label, std::string_view line) {
  out += fmt::format("  {:<16}{}\n", label, line);
}

std::string polls_text(const BusBudget& budget) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < budget.classes.size(); ++i) {
    parts.push_back(
        fmt::format("{} {} each {:.0f} ms", kClassNames[i], budget.classes[i].reads, in_ms(budget.classes[i].period)));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string suggestion(const BusBudget& budget) {
  const auto periods = comfortable_periods(budget);
  return fmt::format("\"poll\": {{\"fast\": {:.0f}, \"normal\": {:.0f}, \"slow\": {:.0f}}}", in_ms(periods[0]),
                     in_ms(periods[1]), in_ms(periods[2]));
}

/// "5 ms", or "5 to 20 ms" where some drives state a longer time than is assumed of the others.
std::string answers_text(const std::vector<drive::DriveModel>& drives) {
  if (drives.empty()) return fmt::format("{:.0f} ms", in_ms(kAssumedAnswer));
  const auto [quickest, slowest] =
      std::minmax_element(drives.begin(), drives.end(),
                          [](const auto& one, const auto& other) { return answer_of(one) < answer_of(other); });
  if (answer_of(*quickest) == answer_of(*slowest)) return fmt::format("{:.0f} ms", in_ms(answer_of(*slowest)));
  return fmt::format("{:.0f} to {:.0f} ms", in_ms(answer_of(*quickest)), in_ms(answer_of(*slowest)));
}

void add_load(std::string& out, const BusBudget& budget, const std::vector<drive::DriveModel>& drives) {
  add_line(out, "planned load",
           fmt::format("{:.1f} % with drives that answer after {}, {:.1f} % on the wire alone",
                       budget.load_answered / 10.0, answers_text(drives), budget.load_on_wire / 10.0));
  if (budget.overloaded()) {
    add_line(
        out, "OVERLOADED",
        fmt::format("more than the line carries: the polls would stretch, fast values come each {:.0f} ms; write {}",
                    in_ms(budget.cycle), suggestion(budget)));
  } else if (budget.load_answered > kComfortablePermille) {
    add_line(out, "note", fmt::format("commands have little room beside the polls; better: {}", suggestion(budget)));
  }
}

bool add_bus(std::string& out, const BusConfig& bus, const std::vector<drive::DriveModel>& drives) {
  const BusBudget budget = plan_bus(timing_of(bus), drives);
  const bool can = bus.adapter == "canopen";
  const std::string speed = can ? bitrate_text(bus) : fmt::format("{} baud", bus.baud);
  out += fmt::format("\nBus {}: {} on {}, {}{}\n", bus.name, bus.adapter, bus.device, speed,
                     bus.cascade ? ", drives in a chain" : "");
  std::vector<std::string> names;
  names.reserve(drives.size());
  for (const auto& model : drives) names.push_back(fmt::format("{} at node {}", model.title, model.node));
  add_line(out, "drives", fmt::format("{}", fmt::join(names, ", ")));
  add_line(out, "polls", polls_text(budget));
  if (can)
    for (const auto& [label, line] : can_lines(bus, drives, budget)) add_line(out, label, line);
  add_load(out, budget, drives);
  add_line(out, "cycle",
           fmt::format("fast values are {} each {:.0f} ms", can ? "polled, where no TPDO brings them," : "read",
                       in_ms(budget.cycle)));
  add_line(out, "command waits",
           fmt::format("at most {:.1f} ms; beside a mute drive at most {:.1f} ms", in_ms(budget.command_wait),
                       in_ms(budget.command_wait_mute)));
  add_line(out, "stop waits",
           fmt::format("at most {:.1f} ms; beside a mute drive at most {:.1f} ms", in_ms(budget.stop_wait),
                       in_ms(budget.stop_wait_mute)));
  return budget.overloaded();
}

std::string missing_quantities(const drive::AxisModel& axis) {
  std::vector<std::string_view> names;
  for (const QuantityRow& quantity : quantity_table()) {
    if ((axis.supported & bit(quantity.quantity)) == 0) names.push_back(quantity.name);
  }
  return names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, ", "));
}

std::string missing_commands(const drive::AxisModel& axis) {
  std::vector<std::string_view> names;
  for (auto number = static_cast<std::uint8_t>(Command::enable);
       number <= static_cast<std::uint8_t>(Command::save_parameters); ++number) {
    if ((axis.supported_commands >> number & 1U) == 0) names.push_back(axisgate::text(static_cast<Command>(number)));
  }
  return names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, ", "));
}

/// How far the drive's own counter reaches before it wraps.
std::string counter_text(const AxisConfig& config, const drive::AxisModel& axis, const drive::DriveModel& drive) {
  const drive::Binding* position = axis.binding(Quantity::position_actual);
  if (position == nullptr || position->object == drive::kNoObject) return "";
  const auto reach = position->to_register(drive.object(position->object).range().max);
  if (!reach) return "";
  return fmt::format(", the drive's counter ±{:.1f}",
                     std::abs(static_cast<double>(*reach) / config.units_per_rev.to_double()));
}

std::string units_text(const AxisConfig& config) {
  const Rational& units = config.units_per_rev;
  const std::string number = units.denominator() == 1 ? fmt::format("{}", units.numerator())
                                                      : fmt::format("{}/{}", units.numerator(), units.denominator());
  return fmt::format("{} per motor turn{}; in turns, a register reaches ±{:.1f}", number,
                     config.inverted ? ", inverted" : "", kRegisterReach / units.to_double());
}

std::string loss_text(const drive::DriveModel& drive) {
  if (!drive.stops_by_itself)
    return fmt::format("THE DRIVE DOES NOT STOP BY ITSELF on {}: it goes on with what it was told last",
                       drive.protocol);
  if (drive.loss_objects.empty()) return "the drive notices and stops by itself";
  std::vector<std::string> written;
  for (const drive::ObjectId id : drive.loss_objects) {
    const bus::ObjectAddress address = drive.object(id).address;
    written.push_back(fmt::format("{:04X}h:{:02X}", address.index, address.sub));
  }
  return fmt::format("the drive is told to notice ({}), which is verified at bring-up{}{}", fmt::join(written, ", "),
                     drive.loss_text.empty() ? "" : ": ", drive.loss_text);
}

void add_axis(std::string& out, const AxisConfig& config, const drive::AxisModel& axis,
              const drive::DriveModel& drive) {
  out += fmt::format("\nAxis {} \"{}\": {}, registers {} to {}\n", config.number, config.name, drive.title,
                     config.number * 100, config.number * 100 + 99);
  add_line(out, "units", units_text(config) + counter_text(config, axis, drive));
  if (config.limits.position) {
    const double units = config.units_per_rev.to_double();
    add_line(out, "position limits",
             fmt::format("{} to {} ({:.2f} to {:.2f} turns)", config.limits.position->min, config.limits.position->max,
                         static_cast<double>(config.limits.position->min) / units,
                         static_cast<double>(config.limits.position->max) / units));
  }
  add_line(out, "not on it", fmt::format("quantities: {}", missing_quantities(axis)));
  add_line(out, "", fmt::format("commands: {}", missing_commands(axis)));
  if (config.inverted && axis.command(Command::home)) {
    add_line(out, "note", "homing methods are not translated for the inverted direction: they mean the drive's own");
  }
  add_line(out, "gateway dies", loss_text(drive));
  if (axis.virtual_axis && !drive.stops_by_itself) {
    add_line(out, "client leaves",
             "quick stop when the connection of the client that commanded the motion ends; not where \"client\" is "
             "\"address\"");
  }
}

bool any_lease(const Config& config) {
  const auto leased = [](const AxisConfig& axis) { return axis.lease.on; };
  for (const BusConfig& bus : config.buses) {
    for (const DriveConfig& drive : bus.drives) {
      if (std::any_of(drive.axes.begin(), drive.axes.end(), leased)) return true;
    }
  }
  return false;
}

}  // namespace

CheckReport check(const LoadedConfig& loaded) {
  const Config& config = loaded.config;
  CheckReport report;
  std::string& out = report.text;
  out = fmt::format("{} is valid.\n", config.file);
  for (std::size_t b = 0; b < config.buses.size(); ++b) {
    const BusConfig& bus = config.buses[b];
    report.overloaded |= add_bus(out, bus, loaded.models[b]);
    for (std::size_t d = 0; d < bus.drives.size(); ++d) {
      const drive::DriveModel& model = loaded.models[b][d];
      for (std::size_t a = 0; a < model.axes.size(); ++a) add_axis(out, bus.drives[d].axes[a], model.axes[a], model);
    }
  }
  out += "\nNo function of this gateway is a safety function: emergency stop and STO are wired.\n";
  if (any_lease(config)) {
    out += "Leases are not enforced by this version: an axis goes on when the client that commands it falls silent.\n";
  }
  for (const std::string& warning : loaded.warnings) out += "warning: " + warning + "\n";
  return report;
}

}  // namespace axisgate::app
