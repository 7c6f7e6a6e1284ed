#include "gateway/app/commission_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <cstdio>
#include <iostream>

#include "adapters/asio/asio_runtime.hpp"
#include "gateway/app/commission_plan.hpp"
#include "gateway/app/config_loader.hpp"
#include "gateway/app/device_wires.hpp"
#include "gateway/app/faults_told.hpp"
#include "gateway/app/gateway.hpp"
#include "gateway/app/stderr_log.hpp"

namespace axisgate::app {
namespace {

// A drive that has not come up by then is not there, or not on this line.
constexpr Duration kOnlineLimit = std::chrono::seconds(15);
constexpr Duration kWriteLimit = std::chrono::seconds(5);

struct Place {
  std::size_t bus = 0;
  std::size_t drive = 0;
  bus::AxisSlot slot = 0;
};

std::optional<Place> find_axis(const Models& models, AxisNumber number) {
  for (std::size_t b = 0; b < models.size(); ++b)
    for (std::size_t d = 0; d < models[b].size(); ++d)
      for (std::size_t a = 0; a < models[b][d].axes.size(); ++a)
        if (models[b][d].axes[a].number == number) return Place{b, d, static_cast<bus::AxisSlot>(a)};
  return std::nullopt;
}

/// The bus of one axis, running, with nobody else on it.
class Workbench {
 public:
  Workbench(const Config& config, const Models& models, std::size_t bus)
      : log_(stderr_log(LogLevel::warning)), runtime_(io_) {
    Config alone;
    alone.file = config.file;
    alone.buses = {config.buses[bus]};
    gateway_ = std::make_unique<Gateway>(alone, Models{models[bus]}, runtime_, log_, device_wires(io_, runtime_, log_));
    gateway_->start();
  }
  [[nodiscard]] Gateway& gateway() { return *gateway_; }
  [[nodiscard]] bool run_until(const std::function<bool()>& done, Duration limit) {
    const Instant end = runtime_.now() + limit;
    while (!done()) {
      if (runtime_.now() >= end) return false;
      io_.run_one_for(std::chrono::milliseconds(100));
    }
    return true;
  }
  [[nodiscard]] GroupResult ask(AxisNumber axis, const ObjectRequest& request) {
    Group group;
    group.role = Role::engineer;
    group.object = request;
    group.start_by = group.answer_by = runtime_.now() + kWriteLimit;
    std::optional<GroupResult> result;
    if (auto at_once = gateway_->submit(axis, group, [&](const GroupResult& r) { result = r; })) return *at_once;
    if (!run_until([&] { return result.has_value(); }, kWriteLimit + kWriteLimit)) return {{Errc::timed_out, 0}, 0, 0};
    return *result;
  }

 private:
  boost::asio::io_context io_{1};
  Log log_;
  AsioRuntime runtime_;
  std::unique_ptr<Gateway> gateway_;
};

bool says_yes(const CommissionOptions& options) {
  if (options.yes) return true;
  fmt::print("Write these now? Only \"yes\" does: ");
  std::fflush(stdout);
  std::string answer;
  return std::getline(std::cin, answer) && answer == "yes";
}

bool write_all(Workbench& bench, const drive::DriveModel& model, AxisNumber axis,
               const std::vector<drive::ObjectWrite>& writes) {
  for (const drive::ObjectWrite& write : writes) {
    const drive::ObjectDef& object = model.object(write.object);
    ObjectRequest request{true, object.address.index, object.address.sub, object.size,
                          static_cast<std::uint32_t>(static_cast<std::uint64_t>(write.raw))};
    const GroupResult result = bench.ask(axis, request);
    const bool ok = result.outcome.code == Errc::ok;
    fmt::print("  {}: {}\n", text(model, write),
               ok ? "written" : fmt::format("{}, detail {:#x}", text(result.outcome.code), result.outcome.detail));
    if (!ok) return false;
  }
  return true;
}

/// Reads the checks' objects anew and judges them again.
bool verify(Workbench& bench, const drive::DriveModel& model, AxisNumber axis, const std::vector<Finding>& before) {
  bool good = true;
  for (const Finding& finding : before) {
    if (!finding.bad) continue;
    const drive::ObjectDef& object = model.object(finding.check->bad.object);
    const GroupResult result = bench.ask(axis, {false, object.address.index, object.address.sub, object.size, 0});
    const bool cured = result.outcome.code == Errc::ok && !finding.check->bad.holds(object, result.object_data);
    fmt::print("  {}: {}\n", finding.check->name, cured ? "ok now" : "STILL BAD");
    good = good && cured;
  }
  return good;
}

int commission(const LoadedConfig& loaded, const Place& place, const CommissionOptions& options) {
  const drive::DriveModel& model = loaded.models[place.bus][place.drive];
  const BusConfig& bus = loaded.config.buses[place.bus];
  fmt::print("axis {} \"{}\": {}, node {} on {} ({})\n", options.axis, model.axes[place.slot].name, model.title,
             model.node, bus.name, bus.device);
  Workbench bench(loaded.config, loaded.models, place.bus);
  fmt::print("waiting for the drive ...\n");
  std::fflush(stdout);
  const AxisImage& image = *bench.gateway().image().find(options.axis);
  if (!bench.run_until([&] { return image.link_state == LinkState::online; }, kOnlineLimit)) {
    fmt::print(stderr,
               "axis {} does not come online ({}): is {} the right device, the gateway stopped, the drive on?\n",
               options.axis, text(image.link_state), bus.device);
    return 1;
  }
  const std::vector<Finding> found = findings(model, bench.gateway().drive_of(options.axis)->store(), place.slot);
  for (const Finding& finding : found) fmt::print("  {}\n", text(model, finding));
  const std::vector<drive::ObjectWrite> writes = remedies(found);
  if (writes.empty()) {
    fmt::print("nothing to remedy\n");
    return 0;
  }
  if (image.has(AxisInput::enabled)) {
    fmt::print(stderr, "axis {} is enabled: disable it first, settings are not changed under torque\n", options.axis);
    return 1;
  }
  fmt::print("the remedy:\n");
  for (const drive::ObjectWrite& write : writes) fmt::print("  {}\n", text(model, write));
  if (!says_yes(options)) {
    fmt::print("nothing was written\n");
    return 1;
  }
  if (!write_all(bench, model, options.axis, writes)) return 1;
  return verify(bench, model, options.axis, found) ? 0 : 1;
}

}  // namespace

int run(const CommissionOptions& options) {
  const LoadResult result = load_config(options.config, options.profile_folders);
  if (const auto* faults = std::get_if<std::vector<ConfigFault>>(&result)) return tell(*faults);
  const auto& loaded = std::get<LoadedConfig>(result);
  const auto place = find_axis(loaded.models, options.axis);
  if (!place) {
    fmt::print(stderr, "{}: no axis {} in it\n", options.config, options.axis);
    return 1;
  }
  return commission(loaded, *place, options);
}

}  // namespace axisgate::app
