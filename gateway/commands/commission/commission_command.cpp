// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/commission/commission_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "gateway/commands/commission/workbench.hpp"
#include "gateway/commands/common/axis_place.hpp"
#include "gateway/commands/common/config_faults.hpp"
#include "gateway/config/config_loader.hpp"
#include "gateway/process/device_wires.hpp"

namespace axisgate::commands {
namespace {

/// What the loop does while the person is asked, and what a yes leads to.
class Commissioning {
 public:
  Commissioning(Workbench& bench, const model::DriveModel& model, AxisSlot slot, const CommissionOptions& options)
      : bench_(bench), model_(model), axis_(model.axes[slot].number), yes_(options.yes) {}

  /// Asks about one finding, and carries it out after a yes.
  void ask(const model::Check& check, std::string_view place) {
    const Numbers shown = read(check);
    const auto bad = is_bad(model_, check, shown);
    if (bad == false) return fmt::print("\n{} {}: ok by now\n", place, check.name);
    if (!bad) return leave(fmt::format("{} {}: it cannot be read, and is not asked about", place, check.name));
    fmt::print("\n{} {}", place, question(model_, check, shown));
    if (!says_yes()) return leave("not written");
    const std::string changed = objection(model_, check, shown, read(check));
    // Whether a motor has torque is looked at last, next to the write.
    const std::string forbidden = objection(axes_now());
    if (!forbidden.empty() || !changed.empty())
      return leave("not written: " + (forbidden.empty() ? changed : forbidden));
    carry_out(check);
  }
  [[nodiscard]] bool input_ended() const { return input_ended_; }
  [[nodiscard]] bool all_done() const { return !left_; }
  [[nodiscard]] bool wrote() const { return wrote_; }
  [[nodiscard]] std::vector<AxisShown> axes_now() { return bench_.axes_now(model_); }

 private:
  void leave(const std::string& why) {
    left_ = true;
    fmt::print("  {}\n", why);
  }
  [[nodiscard]] bool says_yes() {
    fmt::print("Write this to axis {}? Only \"yes\" does, anything else leaves it as it is: ", axis_);
    if (yes_) fmt::print("yes (--yes)\n");
    std::fflush(stdout);
    if (yes_) return true;
    const std::optional<std::string> line = bench_.next_line();
    input_ended_ = !line;
    if (!line || ::isatty(STDIN_FILENO) == 0) fmt::print("{}\n", line.value_or("no answer"));
    return line && means_yes(*line);
  }
  [[nodiscard]] Numbers read(const model::Check& check) {
    Numbers out;
    for (const model::ObjectId id : objects_of(model_, check))
      if (const auto number = bench_.read(model_, axis_, id)) out[id] = *number;
    return out;
  }
  void carry_out(const model::Check& check) {
    for (const model::ObjectWrite& write : check.remedy) {
      const model::ObjectDef& object = model_.object(write.object);
      wrote_ = true;
      const BatchResult result =
          bench_.ask(axis_, ObjectRequest{true, object.address.index, object.address.sub, object.size,
                                          static_cast<std::uint32_t>(static_cast<std::uint64_t>(write.raw))});
      const bool ok = result.outcome.code == Errc::ok;
      fmt::print("  {}: {}\n", text(model_, write),
                 ok ? "written" : fmt::format("{}, detail {:#x}", text(result.outcome.code), result.outcome.detail));
      left_ = left_ || !ok;
      if (!ok) break;
    }
    static_cast<void>(bench_.comes_online(axis_));  // one that stores may be unresponsive for a moment
    const ReadBack after = read_back(model_, check, read(check));
    fmt::print("{}", after.text);
    left_ = left_ || !after.cured;
  }

  Workbench& bench_;
  const model::DriveModel& model_;
  AxisNumber axis_;
  bool yes_;
  bool input_ended_ = false;
  bool left_ = false;   ///< something bad was left as it is
  bool wrote_ = false;  ///< at least tried to
};

int commission(const config::LoadedConfig& loaded, const AxisPlace& place, const CommissionOptions& options) {
  const model::DriveModel& model = loaded.models[place.bus][place.drive];
  const config::BusConfig& bus = loaded.config.buses[place.bus];
  fmt::print("{}\n", text(loaded, place));
  config::Config alone;
  alone.file = loaded.config.file;
  alone.buses = {bus};
  if (const std::string why = gateway_beside(options.config); !why.empty()) {
    fmt::print(stderr, "{}\n", why);
    return 1;
  }
  Workbench bench(alone, {loaded.models[place.bus]}, process::device_wires);
  fmt::print("waiting for the drive ...\n");
  std::fflush(stdout);
  const AxisNumber axis = model.axes[place.slot].number;
  const AxisImage& image = *bench.gateway().image().find(axis);
  if (!bench.comes_online(axis)) {
    fmt::print(stderr,
               "axis {} does not come online ({}): is {} the right device, the gateway stopped, the drive on?\n", axis,
               text(image.link_state), bus.device);
    return 1;
  }
  const std::vector<Finding> found = findings(model, bench.gateway().drive_of(axis)->store(), place.slot);
  for (const Finding& finding : found) fmt::print("  {}\n", text(model, finding));
  const std::vector<const model::Check*> questions = to_ask(found);
  if (questions.empty()) {
    fmt::print("nothing to remedy{}\n", leaves_bad(found) ? " by a write" : "");
    return leaves_bad(found) ? 1 : 0;
  }
  Commissioning work(bench, model, place.slot, options);
  if (const std::string why = objection(work.axes_now()); !why.empty()) {
    fmt::print(stderr, "{}\n", why);
    return 1;
  }
  for (std::size_t i = 0; i < questions.size() && !work.input_ended(); ++i)
    work.ask(*questions[i], fmt::format("question {} of {}:", i + 1, questions.size()));
  if (!work.wrote()) fmt::print("nothing was written\n");
  return work.all_done() && !leaves_bad(found) ? 0 : 1;
}

}  // namespace

int run(const CommissionOptions& options) {
  if (!keep_stdin_taken()) {
    fmt::print(stderr, "there is no standard input, and /dev/null cannot be opened in its place\n");
    return 1;
  }
  const config::LoadResult result = config::load_config(options.config, options.profile_folders);
  if (const auto* faults = std::get_if<std::vector<config::ConfigFault>>(&result)) return tell(*faults);
  const auto& loaded = std::get<config::LoadedConfig>(result);
  const auto place = find_axis(loaded, options.config, options.axis);
  return place ? commission(loaded, *place, options) : 1;
}

}  // namespace axisgate::commands
