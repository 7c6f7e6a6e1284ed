// SPDX-License-Identifier: Apache-2.0
#include "gateway/check/check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "gateway/check/check_sections.hpp"
#include "gateway/config/adapter_names.hpp"

namespace axisgate::check {
namespace {

using std::chrono::milliseconds;

constexpr std::array<std::string_view, 3> kClassNames{"fast", "normal", "slow"};
/// Largest position a register shows.
constexpr double kRegisterReach = 2147483647;
constexpr double kFloatNumbers = 16777216;  // 2^24

std::string polls_text(const config::BusBudget& budget) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < budget.classes.size(); ++i) {
    parts.push_back(
        fmt::format("{} {} each {:.0f} ms", kClassNames[i], budget.classes[i].reads, in_ms(budget.classes[i].period)));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string suggestion(const config::BusBudget& budget) {
  const auto periods = config::comfortable_periods(budget);
  return fmt::format("\"poll\": {{\"fast\": {:.0f}, \"normal\": {:.0f}, \"slow\": {:.0f}}}", in_ms(periods[0]),
                     in_ms(periods[1]), in_ms(periods[2]));
}

/// "5 ms", or "5 to 20 ms" where some drives state a longer time than is assumed of the others.
std::string answers_text(const std::vector<model::DriveModel>& drives) {
  if (drives.empty()) return fmt::format("{:.0f} ms", in_ms(config::kAssumedAnswer));
  const auto [quickest, slowest] = std::minmax_element(
      drives.begin(), drives.end(),
      [](const auto& one, const auto& other) { return config::answer_of(one) < config::answer_of(other); });
  if (config::answer_of(*quickest) == config::answer_of(*slowest))
    return fmt::format("{:.0f} ms", in_ms(config::answer_of(*slowest)));
  return fmt::format("{:.0f} to {:.0f} ms", in_ms(config::answer_of(*quickest)), in_ms(config::answer_of(*slowest)));
}

void add_load(std::string& out, const config::BusBudget& budget, const std::vector<model::DriveModel>& drives) {
  add_line(out, "planned load",
           fmt::format("{:.1f} % with drives that answer after {}, {:.1f} % on the wire alone",
                       budget.load_answered / 10.0, answers_text(drives), budget.load_on_wire / 10.0));
  if (budget.overloaded()) {
    add_line(
        out, "OVERLOADED",
        fmt::format("more than the line carries: the polls would stretch, fast values come each {:.0f} ms; write {}",
                    in_ms(budget.cycle), suggestion(budget)));
  } else if (budget.load_answered > config::kComfortablePermille) {
    add_line(out, "note", fmt::format("commands have little room beside the polls; better: {}", suggestion(budget)));
  }
}

/// Keya: what goes over the line beside the polls.
void add_keya(std::string& out, const config::BusConfig& bus, const config::BusBudget& budget) {
  if (budget.kept_alive.reads > 0)
    add_line(out, "keep-alive",
             fmt::format("{} writes each {:.0f} ms, with every axis enabled", budget.kept_alive.reads,
                         in_ms(budget.kept_alive.period)));
  if (config::adapter::keya(bus.adapter) && budget.load_unsolicited > 0)
    add_line(out, "unasked",
             fmt::format("heartbeats of the drives: {:.1f} % of the line", budget.load_unsolicited / 10.0));
}

void add_bus(std::string& out, const config::BusConfig& bus, const std::vector<model::DriveModel>& drives,
             const config::BusBudget& budget) {
  const bool can = bus.adapter == config::adapter::kCanopen;
  const std::string speed = config::adapter::on_can(bus.adapter) ? bitrate_text(bus) : fmt::format("{} baud", bus.baud);
  out += fmt::format("\nBus {}: {} on {}, {}{}\n", bus.name, bus.adapter, bus.device, speed,
                     bus.cascade ? ", drives in a chain" : "");
  std::vector<std::string> names;
  names.reserve(drives.size());
  for (const auto& model : drives) names.push_back(fmt::format("{} at node {}", model.title, model.node));
  add_line(out, "drives", fmt::format("{}", fmt::join(names, ", ")));
  add_line(out, "polls", polls_text(budget));
  if (can) add_lines(out, can_lines(bus, drives, budget));
  if (bus.adapter == config::adapter::kKeyaCan) add_line(out, "interface", interface_text(bus));
  add_keya(out, bus, budget);
  add_load(out, budget, drives);
  add_line(out, "cycle",
           fmt::format("fast values are {} each {:.0f} ms", can ? "polled, where no TPDO brings them," : "read",
                       in_ms(budget.cycle)));
  add_line(out, "command waits",
           fmt::format("at most {:.1f} ms; beside an unresponsive drive at most {:.1f} ms", in_ms(budget.command_wait),
                       in_ms(budget.command_wait_unresponsive)));
  add_line(out, "stop waits",
           fmt::format("at most {:.1f} ms; beside an unresponsive drive at most {:.1f} ms", in_ms(budget.stop_wait),
                       in_ms(budget.stop_wait_unresponsive)));
}

/// A request that is given up before its answer can be there: each one makes a drive suspect, three of them offline.
std::vector<std::string> timeout_warnings(const config::LoadedConfig& loaded,
                                          const std::vector<config::BusBudget>& budgets) {
  std::vector<std::string> out;
  for (std::size_t b = 0; b < budgets.size(); ++b) {
    const config::BusConfig& bus = loaded.config.buses[b];
    const Duration needed = budgets[b].exchange;
    if (loaded.models[b].empty() || bus.timeout >= needed) continue;
    out.push_back(fmt::format(
        "bus {}: a timeout_ms of {:.0f} is shorter than the longest request, which takes {:.1f} ms with a "
        "drive that answers after {}: its drives will be taken for unresponsive; write at least {:.0f}",
        bus.name, in_ms(bus.timeout), in_ms(needed), answers_text(loaded.models[b]), std::ceil(in_ms(needed))));
  }
  return out;
}

std::string missing_quantities(const model::AxisModel& axis) {
  std::vector<std::string_view> names;
  for (const QuantityRow& quantity : quantity_table()) {
    if (!axis.supports(quantity.quantity)) names.push_back(quantity.name);
  }
  return names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, ", "));
}

std::string missing_commands(const model::AxisModel& axis) {
  std::vector<std::string_view> names;
  for (auto number = static_cast<std::uint8_t>(Command::enable);
       number <= static_cast<std::uint8_t>(Command::save_parameters); ++number) {
    if (const auto command = static_cast<Command>(number); !axis.supports(command))
      names.push_back(axisgate::text(command));
  }
  return names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, ", "));
}

std::string shared_text(const model::AxisModel& axis, const model::DriveModel& drive) {
  std::vector<AxisNumber> others;
  for (const AxisSlot slot : axis.shares) others.push_back(drive.axes[slot].number);
  return fmt::format(
      "enable, disable, stops, fault reset and mode are one with axis {}: to enable this axis gives "
      "torque to both, a stop of one stops and latches both, and both have one owner",
      fmt::join(others, " and "));
}

/// How far the drive's own counter reaches before it wraps.
std::string counter_text(const config::AxisConfig& config, const model::AxisModel& axis,
                         const model::DriveModel& drive) {
  const model::Binding* position = axis.binding(Quantity::position_actual);
  if (position == nullptr || position->object == model::kNoObject) return "";
  const auto reach = position->to_register(drive.object(position->object).range().max);
  if (!reach) return "";
  return fmt::format(", the drive's counter ±{:.1f}",
                     std::abs(static_cast<double>(*reach) / config.units_per_rev.to_double()));
}

std::string units_text(const config::AxisConfig& config) {
  const Rational& units = config.units_per_rev;
  const std::string number = units.denominator() == 1 ? fmt::format("{}", units.numerator())
                                                      : fmt::format("{}/{}", units.numerator(), units.denominator());
  return fmt::format("{} per motor turn{}; in turns, a register reaches ±{:.1f}", number,
                     config.inverted ? ", inverted" : "", kRegisterReach / units.to_double());
}

/// A binary32 has 24 bits: below a power of two turns each position unit has a number of its own.
std::string float_text(const config::AxisConfig& config) {
  const double turns = std::exp2(std::floor(std::log2(kFloatNumbers / config.units_per_rev.to_double())));
  return fmt::format("on listeners with \"numbers\": \"float\" each unit has its own number up to ±{:g} turns", turns);
}

/// What would be there with a constant that nobody has given.
void add_wanted(std::string& out, const std::vector<profile::WantedConstant>& wanted) {
  for (const profile::WantedConstant& constant : wanted) {
    std::vector<std::string_view> names;
    for (const Quantity quantity : constant.quantities) names.push_back(row(quantity).name);
    add_line(out, "not given", fmt::format("{}, for {}", constant.name, fmt::join(names, ", ")));
  }
}

void add_axis(std::string& out, const MasteredAxis& whole, bool floats) {
  const auto& [config, axis, drive, budget, dds] = whole;
  out += fmt::format("\nAxis {} \"{}\": {}, registers {} to {}\n", config.number, config.name, drive.title,
                     config.number * 100, config.number * 100 + 99);
  if (drive.only_simulated) add_line(out, "profile", fmt::format("{}: {}", drive.profile, model::kOnlySimulated));
  add_line(out, "units", units_text(config) + counter_text(config, axis, drive));
  if (floats) add_line(out, "", float_text(config));
  add_lines(out, limit_lines(config, axis));
  add_lines(out, watch_lines(axis));
  if (!axis.shares.empty()) add_line(out, "shared", shared_text(axis, drive));
  add_line(out, "not on it", fmt::format("quantities: {}", missing_quantities(axis)));
  add_line(out, "", fmt::format("commands: {}", missing_commands(axis)));
  if (config.inverted && axis.command(Command::home)) {
    add_line(out, "note", "homing methods are not translated for the inverted direction: they mean the drive's own");
  }
  add_lines(out, master_lines(whole));
}

/// Of all axes together.
std::size_t values_of(const std::vector<std::vector<model::DriveModel>>& buses) {
  std::size_t out = 0;
  for (const auto& drives : buses)
    for (const model::DriveModel& drive : drives)
      for (const model::AxisModel& axis : drive.axes) out += axis.bindings.size();
  return out;
}

}  // namespace

CheckReport report(const config::LoadedConfig& loaded) {
  const config::Config& config = loaded.config;
  CheckReport report;
  std::string& out = report.text;
  out = fmt::format("{} is valid.\n", config.file);
  std::vector<config::BusBudget> budgets;
  const bool floats =
      std::ranges::any_of(config.modbus_tcp, [](const auto& listener) { return listener.float_numbers; });
  for (std::size_t b = 0; b < config.buses.size(); ++b) {
    const config::BusConfig& bus = config.buses[b];
    budgets.push_back(config::plan_bus(config::timing_of(bus), loaded.models[b]));
    report.overloaded |= budgets[b].overloaded();
    add_bus(out, bus, loaded.models[b], budgets[b]);
    for (std::size_t d = 0; d < bus.drives.size(); ++d) {
      const model::DriveModel& model = loaded.models[b][d];
      for (std::size_t a = 0; a < model.axes.size(); ++a)
        add_axis(out, {bus.drives[d].axes[a], model.axes[a], model, budgets[b], config.dds}, floats);
      add_wanted(out, bus.drives[d].wanted);
    }
  }
  if (config.dds) {
    out += fmt::format("\n{}\n", dds_title(*config.dds));
    add_lines(out, dds_lines(*config.dds));
  }
  if (config.web) {
    out += fmt::format("\n{}\n", web_title(*config.web));
    add_lines(out, web_lines(*config.web, values_of(loaded.models)));
  }
  out += "\nNo function of this gateway is a safety function: emergency stop and STO are wired.\n";
  for (const std::string& warning : timeout_warnings(loaded, budgets)) out += "warning: " + warning + "\n";
  for (const std::string& warning : lease_warnings(loaded, budgets)) out += "warning: " + warning + "\n";
  for (const std::string& warning : limit_warnings(loaded)) out += "warning: " + warning + "\n";
  for (const std::string& warning : loaded.warnings) out += "warning: " + warning + "\n";
  return report;
}

}  // namespace axisgate::check
