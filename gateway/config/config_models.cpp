// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "gateway/config/config_sections.hpp"
#include "gateway/core/nearest.hpp"
#include "gateway/profile/resolve/profile_resolve.hpp"

namespace axisgate::config {
namespace {

namespace fs = std::filesystem;

/// Largest position a register can show, design 3.1; the other end is its negative.
constexpr std::int64_t kLargestPosition = 2147483647;

profile::ResolveInput input_of(const BusConfig& bus, const DriveConfig& config) {
  profile::ResolveInput input;
  input.protocol = bus.adapter;
  input.node = config.node;
  input.constants = config.constants;
  input.identity = config.identity;
  input.poll = bus.poll;
  input.axes.assign(config.axes.begin(), config.axes.end());
  return input;
}

bool is_path(const std::string& profile) {
  return profile.find('/') != std::string::npos || profile.ends_with(".json");
}

/// The names by which profiles of these folders are called.
std::vector<std::string> names_in(const std::vector<std::string>& folders) {
  std::vector<std::string> out;
  std::error_code error;
  for (const std::string& folder : folders)
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (entry.path().extension() == ".json") out.push_back(entry.path().stem().string());
  std::ranges::sort(out);
  return out;
}

/// Reads each profile once, however many drives use it.
class Profiles {
 public:
  /// A path counts from the folder of `config_file`.
  Profiles(const std::string& config_file, const std::vector<std::string>& folders, ConfigFaults& faults)
      : base_(fs::path(config_file).parent_path()), folders_(folders), faults_(faults) {}

  /// Null where it is missing or wrong; the mistakes are told.
  const profile::LoadedProfile* find(const DriveConfig& config) {
    const std::string pointer = config.pointer + "/profile";
    const std::string name = is_path(config.profile) ? (base_ / config.profile).string() : config.profile;
    const auto file = profile::find_profile(name, folders_, &read_);
    if (!file) {
      faults_.add(pointer, missing(config.profile, name));
      return nullptr;
    }
    auto known = loaded_.find(*file);
    if (known == loaded_.end()) {
      known = loaded_.emplace(*file, profile::load_profile(*file, folders_)).first;
      read_.insert(read_.end(), known->second.read.begin(), known->second.read.end());
    }
    const profile::LoadedProfile& profile = known->second;
    if (profile.faults.empty()) return &profile;
    for (const profile::Fault& fault : profile.faults) faults_.add(fault);
    faults_.add(pointer, fmt::format("profile {} is wrong, see its own mistakes: correct it", *file));
    return nullptr;
  }

  /// All that was read, with what they extend, and where profiles were looked for in vain; each once.
  [[nodiscard]] std::vector<profile::FileRead> read() const {
    std::vector<profile::FileRead> out;
    for (const profile::FileRead& each : read_)
      if (std::ranges::find(out, each) == out.end()) out.push_back(each);
    return out;
  }

 private:
  [[nodiscard]] std::string missing(const std::string& profile, const std::string& path) const {
    if (is_path(profile))
      return fmt::format("there is no file {}: a path that does not begin with / counts from this file", path);
    return fmt::format("there is no {}.json in {}: correct the name, or name its folder with --profiles{}", profile,
                       folders_.empty() ? "any folder" : fmt::format("{}", fmt::join(folders_, ", ")),
                       did_you_mean(profile, names_in(folders_)));
  }

  fs::path base_;
  const std::vector<std::string>& folders_;
  ConfigFaults& faults_;
  std::map<std::string, profile::LoadedProfile> loaded_;
  std::vector<profile::FileRead> read_;
};

/// Without limits, an axis that can travel further than a register can count would one day show no position at all.
void check_travel(const model::AxisModel& model, const model::DriveModel& drive, const AxisConfig& axis,
                  ConfigFaults& faults) {
  const model::Binding* position = model.binding(Quantity::position_actual);
  if (position == nullptr || position->object == model::kNoObject || axis.limits.position) return;
  if (position->recipe.waits()) return;  // how it counts is read from the drive: its values are judged one by one
  const auto travel = position->to_register(drive.object(position->object).range().max);
  if (travel && *travel <= kLargestPosition && *travel >= -kLargestPosition) return;
  faults.add(
      axis.pointer + "/units_per_rev",
      fmt::format(
          "the drive can travel further than a register can count in these units (±{:.1f} turns): write fewer units "
          "per turn, or \"limits\": {{\"position\": [min, max]}}",
          static_cast<double>(kLargestPosition) / axis.units_per_rev.to_double()));
}

void check_lease(const model::AxisModel& model, const AxisConfig& axis, ConfigFaults& faults) {
  const Command action = command_of(axis.lease.on_expiry);
  if (!axis.lease.on || action == Command::none || model.command(action)) return;
  faults.add(axis.pointer + "/lease/on_expiry",
             fmt::format("this drive has no {} on its protocol: write quick_stop, halt or disable, whichever it has",
                         axisgate::text(action)));
}

void check_asks(const profile::LoadedProfile& loaded, DriveConfig& config, OpenAsks open_asks, ConfigFaults& faults) {
  for (const profile::Ask& ask : loaded.profile.open_asks(config.constants)) {
    config.open_before.insert(config.open_before.end(), ask.before.begin(), ask.before.end());
    const std::string answer =
        ask.of.starts_with('/')
            ? fmt::format("write the answer at {} and take this entry out", ask.of)
            : fmt::format("write \"constants\": {{\"{}\": ...}} into {} of {}", ask.of, config.pointer, faults.file());
    const std::string before =
        ask.before.empty() ? "" : fmt::format(", and no {} before it is answered", fmt::join(ask.before, ", no "));
    const std::string open = fmt::format("open question{}: {} Once you know, {}", before, ask.question(), answer);
    const profile::Written written = profile::written_at(loaded.written, ask.pointer);
    if (ask.before.empty() || open_asks == OpenAsks::allowed)
      faults.warn(config.pointer + "/profile", fmt::format("{}{}: {}", written.file, written.pointer, open));
    else
      faults.add(ConfigFault{written.file, written.pointer, open});
  }
}

std::optional<model::DriveModel> load_model(const BusConfig& bus, DriveConfig& config, Profiles& profiles,
                                            OpenAsks open_asks, ConfigFaults& faults) {
  const profile::LoadedProfile* profile = profiles.find(config);
  if (profile == nullptr || faults.within(config.pointer)) return std::nullopt;
  check_asks(*profile, config, open_asks, faults);
  config.profile_text = profile->text;
  config.wanted = profile->profile.wanted(bus.adapter, config.constants);
  const std::size_t motors = profile->profile.axes.size();
  if (config.axes.size() > motors) {
    faults.add(config.pointer + "/axes",
               fmt::format("the {} drives {} motor{}, and {} axes are given: remove what is too many",
                           profile->profile.title, motors, motors == 1 ? "" : "s", config.axes.size()));
    return std::nullopt;
  }
  auto resolved = profile::resolve(*profile, input_of(bus, config));
  if (const auto* wrong = std::get_if<std::vector<profile::Fault>>(&resolved)) {
    for (const profile::Fault& fault : *wrong) faults.add(config.pointer + fault.pointer, fault.message);
    return std::nullopt;
  }
  auto& model = std::get<model::DriveModel>(resolved);
  for (std::size_t i = 0; i < model.axes.size(); ++i) {
    check_travel(model.axes[i], model, config.axes[i], faults);
    check_lease(model.axes[i], config.axes[i], faults);
    config.axes[i].stop_without_torque = !profile->profile.state.quick_stop_energised;
  }
  return std::move(model);
}

}  // namespace

std::vector<std::vector<model::DriveModel>> load_models(Config& config, const std::vector<std::string>& profile_folders,
                                                        OpenAsks open_asks, ConfigFaults& faults) {
  std::vector<std::vector<model::DriveModel>> models;
  Profiles profiles(config.file, profile_folders, faults);
  for (BusConfig& bus : config.buses) {
    auto& drives = models.emplace_back();
    if (bus.adapter.empty() || faults.within(bus.pointer + "/adapter")) continue;  // no protocol to resolve for
    for (DriveConfig& drive : bus.drives) {
      if (faults.within(drive.pointer + "/profile") || drive.profile.empty()) continue;
      if (auto model = load_model(bus, drive, profiles, open_asks, faults)) drives.push_back(std::move(*model));
    }
  }
  for (profile::FileRead& each : profiles.read()) config.read.push_back(std::move(each));
  return models;
}

}  // namespace axisgate::config
