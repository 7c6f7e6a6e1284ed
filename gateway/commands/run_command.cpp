// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/run_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adapters/asio/asio_runtime.hpp"
#include "gateway/commands/common/config_faults.hpp"
#include "gateway/commands/common/end_signals.hpp"
#include "gateway/compose/gateway.hpp"
#include "gateway/compose/start_lines.hpp"
#include "gateway/compose/web_facts.hpp"
#include "gateway/config/config_loader.hpp"
#include "gateway/process/control_socket.hpp"
#include "gateway/process/descriptor_needs.hpp"
#include "gateway/process/device_wires.hpp"
#include "gateway/process/file_watch.hpp"
#include "gateway/process/loop_watch.hpp"
#include "gateway/process/reload.hpp"
#include "gateway/process/service.hpp"
#include "gateway/process/stderr_log.hpp"
#include "gateway/upstream/dds_host/dds_server.hpp"
#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/server/descriptors.hpp"
#include "gateway/upstream/modbus_tcp/server/server.hpp"
#include "gateway/upstream/web_host/web_server.hpp"

namespace axisgate::commands {
namespace {

using Served = compose::Gateway::Served;

/// When all drives are done, what their clients are told still has to leave this process.
constexpr Duration kLastAnswers = std::chrono::milliseconds(50);

/// How often it is looked whether the log has left something out.
constexpr Duration kLogLooks = std::chrono::seconds(10);

/// Names given with --decode; one that no bus has is a mistake of the command line, not passed over.
std::optional<config::ConfigFault> switch_decode_on(config::Config& config, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const auto bus =
        std::find_if(config.buses.begin(), config.buses.end(), [&](const auto& b) { return b.name == name; });
    if (bus == config.buses.end())
      return config::ConfigFault{config.file, "/buses",
                                 fmt::format("no bus has the name {}, which --decode gives", name)};
    bus->decode = true;
  }
  return std::nullopt;
}

/// As the gateway runs with it: what the command line adds is in it.
config::LoadResult load(const RunOptions& options) {
  config::LoadResult result = config::load_config(options.config, options.profile_folders);
  if (auto* loaded = std::get_if<config::LoadedConfig>(&result))
    if (auto fault = switch_decode_on(loaded->config, options.decode))
      return std::vector<config::ConfigFault>{std::move(*fault)};
  return result;
}

std::string status_of(const ProcessImage& image) {
  return fmt::format("{} axes on {} buses", image.axes().size(), image.buses.size());
}

/// Another one for each start, and a greater one where the time of day goes on.
web::Boot this_boot(Instant now) {
  const auto of_day = std::chrono::system_clock::now().time_since_epoch();
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(of_day).count();
  return {AXISGATE_VERSION, static_cast<std::uint64_t>(ms), now};
}

web::ProgramStatistics statistics_of(const host::Keeper& keeper) {
  return {std::string(keeper.program().name), keeper.ready(), keeper.restarts()};
}

int serve(config::LoadedConfig loaded, const RunOptions& options) {
  std::signal(SIGPIPE, SIG_IGN);  // whoever read the log may go; the motors' gateway does not
  Log log =
      process::stderr_log(options.decode.empty() ? options.log_level : std::max(options.log_level, LogLevel::debug));
  for (const compose::StartLine& line : compose::start_lines(loaded, AXISGATE_VERSION))
    log.write(LogLevel::info, line.source, line.text, LogPace::each);
  boost::asio::io_context io(1);
  AsioRuntime runtime(io);
  log.limit([&runtime] { return runtime.now(); });
  std::unique_ptr<Timer> log_looks;
  log_looks = runtime.make_timer([&] {
    log.tell_left_out();
    log_looks->expires_at(runtime.now() + kLogLooks);
  });
  log_looks->expires_at(runtime.now() + kLogLooks);
  EndSignals signals(io, log);
  std::signal(SIGCHLD, SIG_DFL);  // inherited as ignored, it would hide how our programs end
  const modbus_tcp::DescriptorPlan descriptors = modbus_tcp::take_descriptors(process::descriptor_needs(loaded.config));
  modbus_tcp::ClientRegistry clients;
  compose::Gateway gateway(loaded.config, loaded.models, runtime, log, process::device_wires(io, runtime, log));
  modbus_tcp::Server server(io, runtime, loaded.config.modbus_tcp, gateway.image(), gateway, clients, log,
                            {[&](EventKind kind, std::string text) { gateway.report(kind, std::move(text)); },
                             [&](bool down) { gateway.report_address_missing(Served::modbus_tcp, down); }});
  std::optional<dds::DdsServer> dds;
  if (loaded.config.dds) {
    dds.emplace(io, runtime, *loaded.config.dds, gateway.image(), gateway.events(), gateway, log,
                dds::DdsReports{{[&](EventKind kind, std::string text) { gateway.report(kind, std::move(text)); },
                                 [&](bool down) { gateway.report_dds_down(down); },
                                 [&](bool missing) { gateway.report_address_missing(Served::dds, missing); }},
                                [&](bool taken) { gateway.report_name_taken(taken); }});
  }
  Duration worst_turn{};
  TimeCounts loop_late;
  std::optional<web::WebServer> web;
  const auto figures = [&] {
    const auto& counters = server.counters();
    web::ProcessFigures out{std::exchange(worst_turn, Duration{}),
                            counters.open,
                            static_cast<std::uint32_t>(counters.refused_not_allowed + counters.refused_full),
                            {}};
    out.modbus_requests = clients.figures.requests;
    out.modbus_exceptions = clients.figures.exceptions;
    out.modbus_took = clients.figures.took;
    out.loop_late = loop_late;
    if (dds) out.dds = {dds->counts().sent, dds->counts().received};
    if (dds) out.programs.push_back(statistics_of(dds->keeper()));
    out.programs.push_back(statistics_of(web->keeper()));
    return out;
  };
  web.emplace(io, runtime, this_boot(runtime.now()), gateway.image(), gateway.events(), figures, log,
              host::KeeperReports{[&](EventKind kind, std::string text) { gateway.report(kind, std::move(text)); },
                                  {},
                                  [&](bool missing) { gateway.report_address_missing(Served::web, missing); }});
  try {
    server.start(descriptors);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", options.config, error.what());
    return 1;
  }
  if (descriptors.limited()) gateway.report(EventKind::warning, modbus_tcp::text(descriptors));
  gateway.start();
  if (dds) dds->start();
  web->run(loaded.config.web, compose::web_facts(loaded));
  process::FileWatch file_watch(io, runtime, config::watched_files(loaded.config),
                                [&](const std::string& file) { gateway.report_file_changed(file); });
  process::LoopWatch watch(runtime, [&](Duration late) {
    worst_turn = std::max(worst_turn, late);
    loop_late.add(late);
    gateway.report_loop_delay(late);
  });
  process::Service service(runtime, [&](Duration slack) { return gateway.all_turn(slack); });
  process::Reload reload(io, std::move(loaded.config), [&options] { return load(options); },
                         {gateway, server, dds ? &*dds : nullptr, *web, file_watch, log});
  const auto begin_reload = [&](const process::Reload::Done& done) {
    service.reloading();
    reload.begin([&, done](const process::ReloadResult& result) {
      service.ready(status_of(gateway.image()));
      done(result);
    });
  };
  const auto end = [&] {
    gateway.stop();
    server.stop();
    io.stop();
  };
  const std::unique_ptr<Timer> last_answers = runtime.make_timer(end);
  signals.start(
      [&](bool at_once) {
        service.stopping();
        if (at_once) return end();
        gateway.close([&] { last_answers->expires_at(runtime.now() + kLastAnswers); });
      },
      [&] { begin_reload([](const process::ReloadResult&) {}); });
  const process::ControlSocket control(io, runtime, log, options.config, begin_reload);
  service.ready(status_of(gateway.image()));
  io.run();
  if (dds) dds->stop();
  web->stop();
  log.tell_left_out();
  return 0;
}

}  // namespace

int run(const RunOptions& options) {
  config::LoadResult result = load(options);
  if (const auto* faults = std::get_if<std::vector<config::ConfigFault>>(&result)) return tell(*faults);
  auto& loaded = std::get<config::LoadedConfig>(result);
  for (const std::string& warning : loaded.warnings) fmt::print(stderr, "{}\n", warning);
  return serve(std::move(loaded), options);
}

}  // namespace axisgate::commands
