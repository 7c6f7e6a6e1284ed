// SPDX-License-Identifier: Apache-2.0
#include "gateway/check/check_sections.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/model/loss.hpp"

namespace axisgate::check {
namespace {

/// A lease shorter than so many of the longest waits for the bus would run out under a client that is alive.
constexpr int kWaitsInALease = 3;

std::string signs_of_life(const MasteredAxis& axis) {
  switch (axis.config.lease.renew) {
    case LeaseRenewal::any:
      return "any request of its owner, reads too";
    case LeaseRenewal::write:
      return "a write of its owner to this axis";
    case LeaseRenewal::heartbeat:
      return fmt::format("a changed number that its owner writes to register {} or 8", axis.config.number * 100 + 56);
  }
  return "";
}

std::string name_of(LeaseAction action) {
  return action == LeaseAction::quick_stop ? "quick stop" : std::string(axisgate::text(command_of(action)));
}

bool has_stop_option(const model::DriveModel& drive) {
  return std::ranges::any_of(drive.objects,
                             [](const model::ObjectDef& object) { return object.name == "quick_stop_option"; });
}

/// A wait that is not the last step is for the motor to stand, before the steps that take the torque away.
bool decelerates(const model::Steps& steps) {
  return std::ranges::any_of(
      steps, [&](const model::Step& step) { return step.verb == model::Step::Verb::wait && &step != &steps.back(); });
}

const model::Steps& steps_in(const model::CommandDef& command, std::int16_t mode) {
  for (const auto& variant : command.variants)
    if (std::ranges::find(variant.modes, mode) != variant.modes.end()) return variant.steps;
  return command.steps;
}

/// A CiA 402 drive decelerates by itself; of a virtual one the steps tell.
std::string torque_off_text(const model::AxisModel& axis) {
  const std::string ramp = "it decelerates, then the torque goes";
  const auto& command = axis.command(Command::quick_stop);
  if (!axis.virtual_axis || !command) return ramp;
  std::vector<int> modes;
  for (const auto& [mode, number] : axis.modes)
    if (decelerates(steps_in(*command, mode))) modes.push_back(mode);
  if (modes.size() == axis.modes.size()) return ramp;
  if (modes.empty()) return "the torque goes at once";
  return fmt::format("in mode{} {} {}; in its others the torque goes at once", modes.size() == 1 ? "" : "s",
                     fmt::join(modes, ", "), ramp);
}

std::string quick_stop_text(const MasteredAxis& axis) {
  if (axis.config.stop_without_torque) return torque_off_text(axis.model);
  if (has_stop_option(axis.drive))
    return "it decelerates as its quick_stop_option (605Ah) says, which also says how it ends";
  return "it decelerates and stands energised";
}

std::string stop_text(const MasteredAxis& axis) {
  const bool gate_only = axis.model.virtual_axis && axis.model.virtual_axis->gate_only;
  switch (axis.config.lease.on_expiry) {
    case LeaseAction::quick_stop:
      return quick_stop_text(axis);
    case LeaseAction::halt: {
      const auto& halt = axis.model.command(Command::halt);
      const bool otherwise = halt && halt->quick_stop_otherwise;
      return fmt::format("it decelerates and stays enabled{}",
                         otherwise ? "; in modes without halt a quick stop: " + quick_stop_text(axis) : "");
    }
    case LeaseAction::disable:
      return gate_only ? "it decelerates and stays energised: no bus takes its torque away"
                       : "the torque goes at once: it coasts, or its brake closes";
    case LeaseAction::none:
      break;
  }
  return "";
}

void add_program_dies(ReportLines& out, const MasteredAxis& axis) {
  const LeaseRules& lease = axis.config.lease;
  if (lease.on_expiry == LeaseAction::none) {
    out.emplace_back("program dies",
                     fmt::format("THE AXIS GOES ON; after {:.0f} ms another client may have it", in_ms(lease.timeout)));
    return;
  }
  out.emplace_back(
      "program dies",
      fmt::format("{} at most {:.0f} ms after its last sign of life, {:.0f} ms beside an unresponsive drive",
                  name_of(lease.on_expiry), std::ceil(in_ms(lease.timeout + axis.budget.command_wait)),
                  std::ceil(in_ms(lease.timeout + axis.budget.command_wait_unresponsive))));
  if (lease.renew != LeaseRenewal::heartbeat)
    out.emplace_back("", "never while a stopped PLC goes on scanning: \"renew\": \"heartbeat\" notices that");
  out.emplace_back("the stop", stop_text(axis));
}

std::string objects_told(const model::DriveModel& drive) {
  std::vector<std::string> written;
  for (const model::ObjectId id : drive.loss_objects) {
    const ObjectAddress address = drive.object(id).address;
    written.push_back(fmt::format("{:04X}h:{:02X}", address.index, address.sub));
  }
  return fmt::format("{}", fmt::join(written, ", "));
}

std::string gateway_dies_text(const model::DriveModel& drive) {
  if (model::loss_stop_ms(drive, true) == kGoesOn)
    return fmt::format(
        "THE DRIVE DOES NOT STOP BY ITSELF on {}: it goes on with what it was told last (alarm no_comm_watchdog)",
        drive.protocol);
  const std::uint16_t within = model::loss_stop_ms(drive, true);
  const std::string ends = within == kLossNotKnown ? "WHETHER IT STOPS BY ITSELF IS NOT KNOWN"
                                                   : fmt::format("it begins to stop by itself within {} ms", within);
  const std::string noticed =
      drive.loss_objects.empty()
          ? "the drive notices by itself"
          : fmt::format("the drive is told to notice ({}), which is verified at bring-up", objects_told(drive));
  return fmt::format("{}: {}{}", ends, noticed, drive.loss_text.empty() ? "" : ": " + drive.loss_text);
}

/// "3, 4": the modes in which something is sent again.
std::string kept_modes(const model::AxisModel& axis) {
  std::vector<int> modes;
  for (const auto& [mode, object] : axis.keep_alive) modes.push_back(mode);
  return fmt::format("{}", fmt::join(modes, ", "));
}

void add_keep_alive(ReportLines& out, const MasteredAxis& axis) {
  if (axis.drive.keep_alive == Duration{}) return;
  if (axis.model.keep_alive.empty()) {
    out.emplace_back("kept alive", "in no mode: the drive's own watchdog ends every motion");
    return;
  }
  out.emplace_back("kept alive",
                   fmt::format("each {:.0f} ms in mode{} {}, while it is enabled{}", in_ms(axis.drive.keep_alive),
                               axis.model.keep_alive.size() == 1 ? "" : "s", kept_modes(axis.model),
                               axis.config.lease.on ? " and its lease lives" : ""));
  if (axis.model.keep_alive.size() < axis.model.modes.size())
    out.emplace_back("",
                     "in its other modes sending it again could move the motor: the drive's watchdog ends a motion");
}

void add_vertical(ReportLines& out, const MasteredAxis& axis) {
  if (!axis.config.vertical) return;
  const bool falls = axis.config.stop_without_torque;
  const bool shown = axis.model.supports(Quantity::digital_outputs);
  out.emplace_back("vertical",
                   fmt::format("{}; {}",
                               falls ? "A QUICK STOP ENDS WITHOUT TORQUE: its brake must hold the load by then"
                                     : "its brake must hold the load wherever the torque goes",
                               shown ? "digital_outputs bit 0 shows it where the drive tells"
                                     : "no register shows the brake of this drive"));
}

// --- Warnings ----------------------------------------------------------------------------------------------------

template <class Function>
void each_axis(const config::LoadedConfig& loaded, const std::vector<config::BusBudget>& budgets, Function function) {
  for (std::size_t b = 0; b < loaded.models.size(); ++b)
    for (std::size_t d = 0; d < loaded.models[b].size(); ++d) {
      const model::DriveModel& drive = loaded.models[b][d];
      for (std::size_t a = 0; a < drive.axes.size(); ++a)
        function(MasteredAxis{loaded.config.buses[b].drives[d].axes[a], drive.axes[a], drive, budgets[b],
                              loaded.config.dds});
    }
}

/// "axis 3", or "axes 1, 2".
std::string axes_text(const std::vector<AxisNumber>& axes) {
  return fmt::format("{} {}", axes.size() == 1 ? "axis" : "axes", fmt::join(axes, ", "));
}

void warn_about_no_lease(std::vector<std::string>& out, const config::LoadedConfig& loaded,
                         const std::vector<config::BusBudget>& budgets) {
  std::vector<AxisNumber> unwatched;
  std::vector<AxisNumber> kept;
  each_axis(loaded, budgets, [&](const MasteredAxis& axis) {
    if (axis.config.lease.on) return;
    const bool keep_alive = axis.drive.keep_alive != Duration{} && !axis.model.keep_alive.empty();
    (keep_alive ? kept : unwatched).push_back(axis.config.number);
  });
  if (!unwatched.empty())
    out.push_back(fmt::format("{}: \"lease\": null: nobody notices that the client is dead, the motor goes on",
                              axes_text(unwatched)));
  if (!kept.empty())
    out.push_back(
        fmt::format("{}: \"lease\": null: nobody notices that the client is dead, and the keep-alive runs as long as "
                    "the axis is enabled: the drive's own watchdog does not stop the motor either",
                    axes_text(kept)));
}

/// The longest that a client of any listener waits for its answer.
Duration longest_answer(const config::Config& config) {
  Duration longest{};
  for (const auto& listener : config.modbus_tcp) longest = std::max(longest, listener.reply_deadline);
  return longest;
}

void warn_about_short_leases(std::vector<std::string>& out, const config::LoadedConfig& loaded,
                             const std::vector<config::BusBudget>& budgets) {
  const Duration answer = longest_answer(loaded.config);
  each_axis(loaded, budgets, [&](const MasteredAxis& axis) {
    const LeaseRules& lease = axis.config.lease;
    const Duration waits = kWaitsInALease * axis.budget.command_wait_unresponsive;
    const Duration needed = std::max(answer, waits);
    if (!lease.on || lease.timeout >= needed) return;
    const std::string why = waits > answer ? fmt::format("{} of the longest waits for its bus", kWaitsInALease)
                                           : std::string("the reply_deadline_ms of a listener");
    out.push_back(
        fmt::format("axis {}: its lease of {:.0f} ms is shorter than {} ({:.0f} ms) and may run out under a "
                    "client that waits for an answer: write a longer timeout_ms",
                    axis.config.number, in_ms(lease.timeout), why, std::ceil(in_ms(needed))));
  });
}

/// A keep-alive comes at least twice in the time of the drive's watchdog: one more period of waiting is too much.
void warn_about_late_keep_alives(std::vector<std::string>& out, const config::LoadedConfig& loaded,
                                 const std::vector<config::BusBudget>& budgets) {
  for (std::size_t b = 0; b < loaded.models.size(); ++b) {
    const bool alone = loaded.models[b].size() < 2;  // no other drive can be unresponsive
    const config::BusBudget& budget = budgets[b];
    if (alone || budget.kept_alive.reads == 0 || budget.command_wait_unresponsive <= budget.kept_alive.period) continue;
    out.push_back(fmt::format(
        "bus {}: beside an unresponsive drive a command may wait {:.0f} ms, longer than the {:.0f} ms of the "
        "keep-alive: the watchdogs of the other drives may stop them; write a shorter timeout_ms",
        loaded.config.buses[b].name, std::ceil(in_ms(budget.command_wait_unresponsive)),
        in_ms(budget.kept_alive.period)));
  }
}

/// Those to which a client is an address, or a connection.
std::vector<std::string> listeners_of(const config::Config& config, bool client_is_address) {
  std::vector<std::string> out;
  for (const auto& listener : config.modbus_tcp)
    if (listener.client_is_address == client_is_address)
      out.push_back(fmt::format("{}:{}", listener.host, listener.port));
  return out;
}

void hint_at_tools(std::vector<std::string>& out, const config::LoadedConfig& loaded,
                   const std::vector<config::BusBudget>& budgets) {
  bool leased = false;
  each_axis(loaded, budgets, [&](const MasteredAxis& axis) { leased = leased || axis.config.lease.on; });
  const std::vector<std::string> listeners = listeners_of(loaded.config, false);
  if (!leased || listeners.empty()) return;
  out.push_back(
      fmt::format("on {} each connection is a client: one-shot tools such as mbpoll leave a lease behind that runs out "
                  "and stops the axis; they need \"client\": \"address\" or \"lease\": null",
                  fmt::join(listeners, ", ")));
}

/// Where a client is an address nobody can tell two programs of it apart: neither who commands, nor who is dead.
void warn_about_shared_addresses(std::vector<std::string>& out, const config::LoadedConfig& loaded,
                                 const std::vector<config::BusBudget>& budgets) {
  std::vector<AxisNumber> leased, by_writes;
  each_axis(loaded, budgets, [&](const MasteredAxis& axis) {
    if (!axis.config.lease.on) return;
    leased.push_back(axis.config.number);
    if (axis.config.lease.renew != LeaseRenewal::heartbeat) by_writes.push_back(axis.config.number);
  });
  const std::vector<std::string> listeners = listeners_of(loaded.config, true);
  if (leased.empty() || listeners.empty()) return;
  const std::string who = fmt::format("on {} two programs of one computer are one client (\"client\": \"address\"): ",
                                      fmt::join(listeners, ", "));
  if (by_writes.empty()) {
    out.push_back(who + "what one of them owns the other commands too, and a heartbeat of either keeps " +
                  axes_text(leased) + " alive");
  } else {
    out.push_back(who + "an HMI that writes from the PLC's computer keeps " + axes_text(by_writes) +
                  " alive when the PLC's program is dead; write \"renew\": \"heartbeat\"");
  }
}

}  // namespace

ReportLines master_lines(const MasteredAxis& axis) {
  ReportLines out;
  if (axis.config.lease.on) {
    out.emplace_back("lease",
                     fmt::format("{:.0f} ms, kept by {}", in_ms(axis.config.lease.timeout), signs_of_life(axis)));
    add_program_dies(out, axis);
  } else {
    out.emplace_back("lease", "null: nobody owns it");
    out.emplace_back("program dies", "THE AXIS GOES ON: nobody notices");
    if (axis.model.virtual_axis && !axis.drive.stops_by_itself)
      out.emplace_back("", "but for a quick stop when its connection ends, where \"client\" is \"connection\"");
  }
  if (axis.dds) {
    for (auto& line : dds_master_lines(*axis.dds, axis.config, axis.budget)) out.push_back(std::move(line));
  }
  out.emplace_back("gateway dies", gateway_dies_text(axis.drive));
  add_keep_alive(out, axis);
  add_vertical(out, axis);
  return out;
}

std::vector<std::string> lease_warnings(const config::LoadedConfig& loaded,
                                        const std::vector<config::BusBudget>& budgets) {
  std::vector<std::string> out;
  warn_about_no_lease(out, loaded, budgets);
  warn_about_short_leases(out, loaded, budgets);
  warn_about_late_keep_alives(out, loaded, budgets);
  warn_about_shared_addresses(out, loaded, budgets);
  hint_at_tools(out, loaded, budgets);
  return out;
}

}  // namespace axisgate::check
