// SPDX-License-Identifier: Apache-2.0
#include "gateway/process/reload.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <exception>
#include <utility>

#include "gateway/compose/web_facts.hpp"
#include "gateway/process/descriptor_needs.hpp"
#include "gateway/upstream/modbus_tcp/server/descriptors.hpp"

namespace axisgate::process {

Reload::Reload(boost::asio::io_context& io, config::Config running, std::function<config::LoadResult()> load,
               const Running& with)
    : io_(io), running_(std::move(running)), load_(std::move(load)), with_(with) {}

void Reload::begin(Done done) {
  if (done_) return done({false, {"another reload is under way: ask again when it has ended"}});
  if (with_.gateway.ends()) return done({false, {"the gateway ends"}});
  done_ = std::move(done);
  boost::asio::post(thread_, [this, alive = std::weak_ptr(alive_)] {
    auto loaded = std::make_shared<config::LoadResult>(load_());
    boost::asio::post(io_, [this, alive, loaded] {
      if (!alive.expired()) on_loaded(std::move(*loaded));
    });
  });
}

void Reload::on_loaded(config::LoadResult loaded) {
  if (with_.gateway.ends()) return;
  if (const auto* faults = std::get_if<std::vector<config::ConfigFault>>(&loaded)) {
    std::vector<std::string> lines;
    for (const config::ConfigFault& fault : *faults) lines.push_back(text(fault));
    return refuse(std::move(lines));
  }
  change(std::get<config::LoadedConfig>(std::move(loaded)));
}

void Reload::change(config::LoadedConfig wanted) {
  const compose::ReloadPlan plan = compose::plan_reload(running_, wanted.config);
  std::vector<std::string> why_not = plan.refusals;
  for (std::string& line : clients_in_the_way(plan)) why_not.push_back(std::move(line));
  if (!why_not.empty()) return refuse(std::move(why_not));
  try {
    with_.server.prepare(wanted.config.modbus_tcp, plan.kept_listeners);
  } catch (const std::exception& error) {
    return refuse({fmt::format("{}: {}", wanted.config.file, error.what())});
  }
  for (const std::string& warning : wanted.warnings) with_.gateway.report(EventKind::warning, warning, true);
  std::vector<compose::StartLine> start = compose::start_lines(wanted, AXISGATE_VERSION);
  web::WebFacts facts = compose::web_facts(wanted);
  config::Config config = wanted.config;
  with_.gateway.reload(
      plan, std::move(wanted.config), std::move(wanted.models), [this, plan] { return clients_in_the_way(plan); },
      [this, plan, config = std::move(config), start = std::move(start),
       facts = std::move(facts)](std::vector<std::string> not_done) mutable {
        if (not_done.empty()) return commit(plan, std::move(config), start, std::move(facts));
        with_.server.give_up();
        refuse(std::move(not_done));
      });
}

bool may_stop_with_a_client(const AxisImage& axis, bool nothing_else_would) {
  const std::uint16_t jogging = 1U << jog_coil(Command::jog_forward) | 1U << jog_coil(Command::jog_reverse);
  const bool moves = axis.axis_state == AxisState::discrete_motion || axis.axis_state == AxisState::continuous_motion ||
                     axis.axis_state == AxisState::homing;
  return !axis.lease.rules.on && (((axis.level_coils & jogging) != 0) || (moves && nothing_else_would));
}

// A connection that is closed would end what keeps a motor under its owner's command.
std::vector<std::string> Reload::clients_in_the_way(const compose::ReloadPlan& plan) const {
  std::vector<std::string> out;
  for (const auto& axis : with_.gateway.image().axes()) {
    const drive::Drive* drive = with_.gateway.drive_of(axis->number);
    const bool nothing_else_would =
        drive != nullptr && drive->model().axes.front().virtual_axis && !drive->model().stops_by_itself;
    if (may_stop_with_a_client(*axis, nothing_else_would) && !plan.leaving_listeners.empty())
      out.push_back(
          fmt::format("axis {} ({}) has no lease and stops when the client that commanded it is gone, which may be "
                      "connected to a listener that would be changed: {}",
                      axis->number, axis->name, text(axis->axis_state)));
    const auto& owner = axis->lease.owner;
    if (!owner || axis->axis_state == AxisState::disabled) continue;
    for (const std::size_t place : plan.leaving_listeners) {
      if (!with_.server.serves(place, owner->id)) continue;
      const auto& listener = running_.modbus_tcp[place];
      out.push_back(fmt::format("listener {} would close the connection of {}, which owns axis {} ({}): {}",
                                modbus_tcp::address_text(listener.host, listener.port), owner->name, axis->number,
                                axis->name, text(axis->axis_state)));
    }
  }
  return out;
}

void Reload::commit(const compose::ReloadPlan& plan, config::Config wanted,
                    const std::vector<compose::StartLine>& start, web::WebFacts facts) {
  with_.server.commit(modbus_tcp::take_descriptors(descriptor_needs(wanted)));
  if (with_.dds != nullptr && wanted.dds) with_.dds->take_axes(wanted.dds->units);
  with_.web.run(wanted.web, std::move(facts));
  wanted.read_by_dds = running_.read_by_dds;  // axisgate-dds has not read them anew
  with_.files.take(config::watched_files(wanted));
  running_ = std::move(wanted);
  const std::vector<std::string> nothing{"nothing has changed"};
  with_.gateway.report(EventKind::boot,
                       fmt::format("{} was read anew: {}", running_.file,
                                   fmt::join(plan.changes.empty() ? nothing : plan.changes, "; ")),
                       true);
  for (const std::string& line : plan.lines) with_.log.write(LogLevel::info, "gateway", line, LogPace::each);
  for (const compose::StartLine& line : plan.changes.empty() ? std::vector<compose::StartLine>() : start)
    with_.log.write(LogLevel::info, line.source, line.text, LogPace::each);
  end({true, plan.lines.empty() ? nothing : plan.lines});
}

void Reload::refuse(std::vector<std::string> why_not) {
  for (const std::string& line : why_not)
    with_.gateway.report(EventKind::warning, "reload refused, and nothing was changed: " + line, true);
  end({false, std::move(why_not)});
}

void Reload::end(ReloadResult result) { std::exchange(done_, nullptr)(result); }

}  // namespace axisgate::process
