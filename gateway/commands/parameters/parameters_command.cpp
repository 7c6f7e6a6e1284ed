// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/parameters/parameters_command.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "gateway/commands/common/config_faults.hpp"
#include "gateway/commands/common/new_file.hpp"
#include "gateway/commands/parameters/parameter_bench.hpp"
#include "gateway/commands/profile/eds_file.hpp"

namespace axisgate::commands {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{4} << 20U;

void say(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

int refuse(const std::string& why) {
  fmt::print(stderr, "{}\n", why);
  return 1;
}

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
}

/// One call of the command, on a drive that answers.
class Work {
 public:
  Work(const ParametersOptions& options, ParameterBench& bench, AxisSlot slot, std::vector<Parameter> parameters)
      : options_(options), bench_(bench), slot_(slot), parameters_(std::move(parameters)) {}

  int save(const model::AxisModel& axis) {
    if (!read_all()) return 1;
    ParameterFile file{AXISGATE_VERSION, utc_now(), axis.number, axis.name, bench_.facts()};
    file.objects = saved(parameters_, readings_);
    if (const int error = write_new_file(options_.file, json_text(file)); error != 0)
      return refuse(fmt::format("{} could not be written: {}", options_.file, std::strerror(error)));
    const auto unread = static_cast<std::size_t>(
        std::ranges::count_if(readings_, [](const Reading& reading) { return !reading.number; }));
    say(fmt::format("{} is written: {} objects{}", options_.file, readings_.size() - unread,
                    unread == 0 ? "" : fmt::format(", and {} that could not be read, with the reasons", unread)));
    return 0;
  }

  int compare(const ParameterFile& file) {
    if (!fits(file) || !read_all()) return 1;
    const std::vector<Difference> found = differences(bench_.model(), parameters_, readings_, file);
    for (const Difference& difference : found)
      say(fmt::format("  {}{}", difference.text,
                      difference.counts ? "" : fmt::format("  ({})", difference.not_written)));
    const bool differs = any_counts(found);
    say(fmt::format("{} objects compared: {}", readings_.size(),
                    differs ? "they differ" : "nothing differs that counts"));
    return differs ? 1 : 0;
  }

  int restore(const ParameterFile& file) {
    if (!fits(file)) return 1;
    if (const std::string why = bench_.forbidden(); !why.empty()) return refuse(why);
    if (!read_all()) return 1;
    const std::vector<Difference> found = differences(bench_.model(), parameters_, readings_, file);
    show(found);
    std::vector<const Difference*> due;
    for (const Difference& difference : found)
      if (difference.write) due.push_back(&difference);
    if (due.empty()) {
      say("nothing to write");
      return any_counts(found) ? 1 : 0;
    }
    if (!agreed(due.size())) {
      say("nothing was written");
      return 1;
    }
    const bool done = write(std::move(due));
    const bool same = !ended_ && last_look(file);
    return done && same ? 0 : 1;
  }

 private:
  bool read_all() {
    say(fmt::format("reading {} objects ...", parameters_.size()));
    std::size_t read = 0;
    auto readings = bench_.read(parameters_, read, [&](std::size_t done, Duration took) {
      say(progress_text(done, parameters_.size(), took));
    });
    if (!readings) {
      refuse(fmt::format("the drive fell silent after {} of {} objects", read, parameters_.size()));
      return false;
    }
    readings_ = *std::move(readings);
    return true;
  }

  bool fits(const ParameterFile& file) {
    const DriveFacts now = bench_.facts();
    if (const std::string why = objection(file.drive, now); !why.empty()) {
      refuse(fmt::format("{}: {}", options_.file, why));
      return false;
    }
    say(fmt::format("{}: axis {} \"{}\", saved {}", options_.file, file.axis, printable(file.axis_name),
                    printable(file.at)));
    if (const AxisNumber here = bench_.model().axes[slot_].number; file.axis != here)
      say(fmt::format("  another axis: {} in the file, {} here", file.axis, here));
    for (const std::string& line : remarks(file.drive, now)) say("  " + line);
    return true;
  }

  void show(const std::vector<Difference>& found) {
    const auto list = [&](bool written, const char* title) {
      std::size_t lines = 0;
      for (const Difference& difference : found) {
        if (difference.write.has_value() != written) continue;
        if (lines++ == 0) say(title);
        if (written || lines <= kMostShown)
          say(fmt::format("  {}{}", difference.text, written ? "" : ": " + difference.not_written));
      }
      if (!written && lines > kMostShown) say(fmt::format("  and {} more", lines - kMostShown));
    };
    list(false, "not written:");
    list(true, "to write:");
    for (const std::string& line : cost(bench_.model(), slot_, parameters_, found)) say("  " + line);
  }

  bool agreed(std::size_t count) {
    fmt::print("Write these {} to axis {}? Only \"yes\" does, anything else leaves the drive as it is: ", count,
               bench_.model().axes[slot_].number);
    std::fflush(stdout);
    const std::optional<std::string> line = bench_.next_line();
    if (!line || ::isatty(STDIN_FILENO) == 0) say(line.value_or("no answer"));
    return line && means_yes(*line);
  }

  /// What the drive refuses is tried again when all the others are written. True: it holds them all, and keeps them.
  bool write(std::vector<const Difference*> due) {
    std::size_t written = 0;
    std::size_t failed = 0;
    for (int i = 1; i <= kParameterTries && !due.empty() && !ended_; ++i) {
      std::vector<const Difference*> later;
      for (std::size_t at = 0; at < due.size() && !ended_; ++at) {
        const Difference& difference = *due[at];
        const Written result = bench_.write(parameters_[difference.place], difference.now, *difference.write);
        const bool again = result.try_later && i < kParameterTries;
        say(fmt::format("  {}: {}{}", difference.text, result.text, again ? "; it is tried again at the end" : ""));
        written += result.held ? 1 : 0;
        failed += result.held || again || result.ends ? 0 : 1;
        ended_ = result.ends;
        if (again) later.push_back(&difference);
        if (ended_) tell_rest(due, at + 1, later);
      }
      due = std::move(later);
    }
    say(fmt::format("{} written{}", written, failed == 0 ? "" : fmt::format(", {} not", failed)));
    return stored(written) && failed == 0;
  }

  void tell_rest(const std::vector<const Difference*>& due, std::size_t from,
                 const std::vector<const Difference*>& later) {
    for (std::size_t at = from; at < due.size(); ++at) say(fmt::format("  {}: not written", due[at]->text));
    for (const Difference* difference : later) say(fmt::format("  {}: not written", difference->text));
  }

  bool stored(std::size_t written) {
    if (written == 0 || ended_ || !has_save_command(bench_.model(), slot_)) return !ended_;
    const Written result = bench_.save();
    say(result.text);
    return result.held;
  }

  bool last_look(const ParameterFile& file) {
    if (!read_all()) return false;
    const std::vector<Difference> left = differences(bench_.model(), parameters_, readings_, file);
    for (const Difference& difference : left)
      if (difference.counts) say(fmt::format("  still: {}", difference.text));
    say(any_counts(left) ? "the drive is not as the file has it" : "the drive is as the file has it");
    return !any_counts(left);
  }

  const ParametersOptions& options_;
  ParameterBench& bench_;
  AxisSlot slot_;
  std::vector<Parameter> parameters_;
  Readings readings_;
  bool ended_ = false;  ///< nothing more can be written
};

/// What cannot be said to be wrong without the drive.
int work(const ParametersOptions& options, const config::LoadedConfig& loaded, const AxisPlace& place,
         const ParameterFile& file, const profile::Eds* eds) {
  const model::DriveModel& model = loaded.models[place.bus][place.drive];
  if (eds != nullptr && !takes_eds(model))
    return refuse(fmt::format("--eds: a drive on {} has no objects of an EDS: leave it out", model.protocol));
  std::vector<Parameter> parameters = parameters_of(model, place.slot, eds);
  if (parameters.size() > kMaxParameters)
    return refuse(fmt::format("{}: {} objects can be written, and {} at most are read", options.eds, parameters.size(),
                              kMaxParameters));
  say(text(loaded, place));
  if (const std::string why = gateway_beside(options.config); !why.empty()) return refuse(why);
  ParameterBench bench(loaded, place);
  say("waiting for the drive ...");
  if (!bench.comes_online())
    return refuse(
        fmt::format("axis {} does not come online ({}): is {} the right device, the gateway stopped, the "
                    "drive on?",
                    options.axis, text(bench.link()), loaded.config.buses[place.bus].device));
  Work work(options, bench, place.slot, std::move(parameters));
  if (options.action == ParametersOptions::Action::save) return work.save(model.axes[place.slot]);
  return options.action == ParametersOptions::Action::compare ? work.compare(file) : work.restore(file);
}

}  // namespace

int run(const ParametersOptions& options) {
  if (!keep_stdin_taken()) return refuse("there is no standard input, and /dev/null cannot be opened in its place");
  ParameterFile file;
  if (options.action == ParametersOptions::Action::save) {
    std::error_code error;
    if (std::filesystem::exists(options.file, error))
      return refuse(fmt::format("{} is there already, and is not written over: give another name", options.file));
  } else {
    const auto content = content_of(options.file, kMaxFileBytes);
    if (const auto* fault = std::get_if<config::ConfigFault>(&content)) return tell({*fault});
    auto parsed = parse_parameter_file(std::get<std::string>(content));
    if (const auto* faults = std::get_if<std::vector<profile::SchemaFault>>(&parsed)) {
      std::vector<config::ConfigFault> out;
      for (const auto& fault : *faults) out.push_back({options.file, fault.pointer, fault.message});
      return tell(out);
    }
    file = std::get<ParameterFile>(std::move(parsed));
  }
  std::optional<profile::Eds> eds;
  if (!options.eds.empty()) {
    auto read = load_eds(options.eds);
    if (const auto* faults = std::get_if<std::vector<config::ConfigFault>>(&read)) return tell(*faults);
    eds = std::get<profile::Eds>(std::move(read));
  }
  const config::LoadResult result = config::load_config(options.config, options.profile_folders);
  if (const auto* faults = std::get_if<std::vector<config::ConfigFault>>(&result)) return tell(*faults);
  const auto& loaded = std::get<config::LoadedConfig>(result);
  const auto place = find_axis(loaded, options.config, options.axis);
  return place ? work(options, loaded, *place, file, eds ? &*eds : nullptr) : 1;
}

}  // namespace axisgate::commands
