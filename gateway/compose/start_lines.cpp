// SPDX-License-Identifier: Apache-2.0
#include "gateway/compose/start_lines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "gateway/check/check_lines.hpp"
#include "gateway/config/adapter_names.hpp"

namespace axisgate::compose {
namespace {

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::size_t axes_of(const config::BusConfig& bus) {
  std::size_t axes = 0;
  for (const config::DriveConfig& drive : bus.drives) axes += drive.axes.size();
  return axes;
}

std::string bus_text(const config::BusConfig& bus) {
  return fmt::format("{} on {}, {} with {}, timeout {:.0f} ms, polls {:.0f}/{:.0f}/{:.0f} ms{}", bus.adapter,
                     wire_text(bus), counted(bus.drives.size(), "drive", "drives"),
                     counted(axes_of(bus), "axis", "axes"), check::in_ms(bus.timeout), check::in_ms(bus.poll[0]),
                     check::in_ms(bus.poll[1]), check::in_ms(bus.poll[2]), bus.decode ? ", decoded" : "");
}

std::string_view renewed_by(LeaseRenewal renew) {
  switch (renew) {
    case LeaseRenewal::any:
      return "any request";
    case LeaseRenewal::write:
      return "writes";
    case LeaseRenewal::heartbeat:
      break;
  }
  return "the heartbeat";
}

std::string lease_text(const LeaseRules& lease) {
  if (!lease.on) return "no lease";
  const Command action = command_of(lease.on_expiry);
  return fmt::format("lease {:.0f} ms, renewed by {}, then {}", check::in_ms(lease.timeout), renewed_by(lease.renew),
                     action == Command::none ? "nothing" : text(action));
}

std::string axis_text(const config::BusConfig& bus, const config::DriveConfig& drive, const config::AxisConfig& axis,
                      const model::DriveModel& model) {
  const std::string motor = axis.motor.empty() ? "" : " motor " + axis.motor;
  return fmt::format("{} ({}) node {}{} on bus {}, {:.6g} units a turn{}, {}", model.title, model.profile, drive.node,
                     motor, bus.name, axis.units_per_rev.to_double(), axis.inverted ? ", inverted" : "",
                     lease_text(axis.lease));
}

std::string listener_text(const modbus_tcp::ListenerSettings& listener) {
  std::string out =
      fmt::format("listener {}: a client is {}, {}", modbus_tcp::address_text(listener.host, listener.port),
                  listener.client_is_address ? "an address" : "a connection",
                  listener.has_allow ? counted(listener.allow.size(), "entry in `allow`", "entries in `allow`")
                                     : "only this machine may command");
  if (listener.posted_writes) out += ", writes posted";
  if (listener.per_axis_units) out += ", a unit id for each axis";
  if (listener.low_word_first) out += ", low word first";
  if (listener.float_numbers) out += ", floats";
  if (listener.staged_halves) out += ", staged halves";
  return out;
}

std::string dds_line(const dds::DdsSettings& settings) {
  std::string out = fmt::format("domain {}, interfaces", settings.domain);
  for (const std::string& interface : settings.interfaces) out += " " + interface;
  return out + (settings.commands ? fmt::format(", commands are taken, role {}{}", text(settings.role),
                                                settings.roles.empty() ? "" : " or that of their certificate")
                                  : ", no commands are taken");
}

std::string web_line(const web::WebSettings& settings) {
  return fmt::format("page at http://{}/, may be looked at from {}{}", settings.listen,
                     settings.allow.empty() ? "nowhere" : fmt::format("{}", fmt::join(settings.allow, ", ")),
                     settings.insecure ? ", without encryption and passwords" : "");
}

}  // namespace

std::string wire_text(const config::BusConfig& bus) {
  if (config::adapter::on_can(bus.adapter)) return fmt::format("{}, {} kbit/s", bus.device, bus.bitrate / 1000);
  const char parity = bus.parity == "even" ? 'E' : bus.parity == "odd" ? 'O' : 'N';
  return fmt::format("{}, {} baud 8{}1", bus.device, bus.baud, parity);
}

std::vector<StartLine> start_lines(const config::LoadedConfig& loaded, std::string_view version) {
  const config::Config& config = loaded.config;
  std::size_t axes = 0;
  for (const config::BusConfig& bus : config.buses) axes += axes_of(bus);
  std::vector<StartLine> lines;
  lines.push_back({{.words = "gateway"},
                   fmt::format("axisgate {}, configuration {}: {}, {}", version, config.file,
                               counted(config.buses.size(), "bus", "buses"), counted(axes, "axis", "axes"))});
  for (std::size_t b = 0; b < config.buses.size(); ++b) {
    const config::BusConfig& bus = config.buses[b];
    lines.push_back({bus_source(bus.name), bus_text(bus)});
    for (std::size_t d = 0; d < bus.drives.size(); ++d)
      for (const config::AxisConfig& axis : bus.drives[d].axes)
        lines.push_back(
            {log_source(axis.number, axis.name, bus.name), axis_text(bus, bus.drives[d], axis, loaded.models[b][d])});
  }
  for (const modbus_tcp::ListenerSettings& listener : config.modbus_tcp)
    lines.push_back({{.words = "modbus"}, listener_text(listener)});
  if (config.dds) lines.push_back({{.words = "dds"}, dds_line(*config.dds)});
  if (config.web) lines.push_back({{.words = "web"}, web_line(*config.web)});
  return lines;
}

}  // namespace axisgate::compose
