// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/support/gathering.hpp"

#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <sys/utsname.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/use_future.hpp>
#include <filesystem>
#include <fstream>
#include <set>
#include <utility>

#include "gateway/commands/record/page_client.hpp"
#include "gateway/commands/record/plan/request.hpp"
#include "gateway/commands/support/bounded_run.hpp"
#include "gateway/commands/support/device_facts.hpp"

namespace axisgate::commands::support {
namespace {

using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

constexpr unsigned kGood = 200;
/// Files of profiles whose sums are taken.
constexpr std::size_t kMostSums = 500;
const std::string kTooLate = fmt::format("not asked: what came before took {} s", kLongest.count());

/// What a small file says, as far as `most` bytes.
std::string text_of_file(const fs::path& path, std::size_t most) {
  std::ifstream file(path, std::ios::binary);
  std::string text(most, '\0');
  file.read(text.data(), static_cast<std::streamsize>(most));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

/// The files of libraries that this program has loaded: their names tell their versions.
std::string loaded_libraries() {
  std::set<std::string> out;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (const std::size_t at = line.find('/'); at != std::string::npos && line.find(".so") != std::string::npos)
      out.insert(line.substr(at));
  std::string text;
  for (const std::string& library : out) text += library + "\n";
  return text;
}

class Gathering {
 public:
  Gathering(const Asked& asked, const Redaction& redaction)
      : asked_(asked), redaction_(redaction), places_(places_of(redaction.json)) {}

  std::vector<Gathered> run() {
    out_.push_back({.file = "configuration.json",
                    .what = "the configuration",
                    .text = redaction_.json,
                    .why_not = redaction_.why_none});
    add_check();
    add_versions();
    add_profiles();
    add_devices();
    add_unit();
    add_log();
    add_top();
    add_page();
    return std::move(out_);
  }

 private:
  /// What a program says becomes a file. Its exit code.
  int add(Gathered file, const std::vector<std::string>& words) {
    if (Clock::now() >= end_) {
      file.why_not = kTooLate;
      out_.push_back(std::move(file));
      return -1;
    }
    RunEnd run = run_program(words, {asked_.patience, kMostOfFile, file.newest_is_last});
    file.text += run.text;
    file.why_not = run.problem;
    if (file.text.empty() && file.why_not.empty())
      file.why_not = fmt::format("{} says nothing, exit code {}", words.front(), run.exit_code);
    out_.push_back(std::move(file));
    return run.exit_code;
  }

  void add_check() {
    if (redaction_.json.empty()) {
      out_.push_back({.file = "check.txt",
                      .what = "what axisgate check says of it",
                      .why_not = "its words show parts of the configuration, which is left out"});
      return;
    }
    std::vector<std::string> words{asked_.axisgate, "check", asked_.config};
    words.insert(words.end(), profiles_option_.begin(), profiles_option_.end());
    is_valid_ = add({.file = "check.txt", .what = "what axisgate check says of it"}, words) == 0;
  }

  void add_versions() {
    std::string text = "axisgate " AXISGATE_VERSION "\n";
    utsname system{};
    if (::uname(&system) == 0)
      text += fmt::format("{} {} {} {}\n", system.sysname, system.release, system.version, system.machine);
    text += fmt::format("glibc {}\n\n", ::gnu_get_libc_version());
    constexpr std::size_t kMostOfRelease = 4096;
    text += text_of_file("/etc/os-release", kMostOfRelease) + "\n" + loaded_libraries() + "\n";
    add({.file = "versions.txt",
         .what = "axisgate, libraries, kernel, distribution, packages",
         .text = std::move(text)},
        {"dpkg-query", "-W", "-f", "${binary:Package} ${Version} ${db:Status-Abbrev}\n", "axisgate*", "libc6",
         "libmodbus5", "libfastrtps*", "libfastcdr*", "libseccomp2", "libsystemd0", "libprometheus-cpp-core*",
         "systemd", "udev"});
  }

  /// Of the shipped ones, and of those that the configuration names by a path.
  void add_profiles() {
    std::vector<std::string> words{"sha256sum", "--"};
    const auto take = [&](const fs::path& file) {
      std::error_code failed;
      if (words.size() < kMostSums && fs::is_regular_file(file, failed)) words.push_back(file.string());
    };
    for (const std::string& folder : asked_.profile_folders) {
      std::error_code failed;
      std::set<fs::path> files;
      for (fs::directory_iterator each(folder, failed), end; !failed && each != end; each.increment(failed))
        if (each->path().extension() == ".json") files.insert(each->path());
      std::ranges::for_each(files, take);
    }
    for (const std::string& profile : places_.profiles)
      if (profile.find('/') != std::string::npos || profile.ends_with(".json"))
        take(fs::path(asked_.config).parent_path() / profile);
    Gathered file{.file = "profiles.txt", .what = "SHA-256 sums of drive profiles"};
    if (words.size() > 2) {
      add(std::move(file), words);
    } else {
      file.why_not = "no profile was found";
      out_.push_back(std::move(file));
    }
  }

  void add_devices() {
    Gathered file{.file = "devices.txt", .what = "serial ports and interfaces of the configuration"};
    for (const Device& device : places_.devices) file.text += device_facts(device);
    if (file.text.empty()) file.why_not = "the configuration names none that can be read";
    out_.push_back(std::move(file));
  }

  void add_unit() {
    // No more than these: the unit's environment may hold anything.
    add({.file = "unit.txt", .what = "the state of axisgate.service"},
        {"systemctl", "--no-pager", "show", "axisgate.service",
         "--property=LoadState,UnitFileState,ActiveState,SubState,Result,NRestarts,MainPID,ExecMainStartTimestamp,"
         "ExecMainExitTimestamp,ExecMainCode,ExecMainStatus,MemoryCurrent,CPUUsageNSec,TasksCurrent,FragmentPath,"
         "DropInPaths,NeedDaemonReload"});
  }

  void add_log() {
    add({.file = "log.txt", .what = "the service's log of the last day", .newest_is_last = true},
        {"journalctl", "--no-pager", "--quiet", "--unit=axisgate.service", "--since=-1d", "--utc", "--no-hostname",
         "--output=short-iso-precise"});
    Gathered& log = out_.back();
    if (log.text.empty() && log.why_not.find("exit code 0") != std::string::npos)
      log.why_not =
          "nothing of the last day that this user may read; a gateway that was not started as a service logs where it "
          "was started";
  }

  void add_top() {
    Gathered file{.file = "top.txt", .what = "all axes as axisgate top shows them"};
    if (!places_.listener) {
      file.why_not = "the configuration has no listener that can be read";
      out_.push_back(std::move(file));
      return;
    }
    std::vector<std::string> words{asked_.axisgate, "top", "--once", "--plain",
                                   record::authority_of(*places_.listener)};
    if (is_valid_) {
      words.push_back(asked_.config);
      words.insert(words.end(), profiles_option_.begin(), profiles_option_.end());
    }
    const bool shown = add(std::move(file), words) == 0;
    Gathered& top = out_.back();
    if (shown || !top.why_not.empty()) return;
    top.why_not = std::exchange(top.text, {});
    while (top.why_not.ends_with('\n')) top.why_not.pop_back();
  }

  /// After one that hangs the others are not asked.
  void add_page() {
    const std::pair<const char*, const char*> all[] = {
        {"gateway.json", "/api/v1/gateway"},   {"buses.json", "/api/v1/buses"},
        {"axes.json", "/api/v1/axes"},         {"events.json", "/api/v1/events?limit=1000"},
        {"captures.json", "/api/v1/captures"}, {"metrics.txt", "/metrics"}};
    std::string problem = places_.page ? "" : "the configuration has no page (\"web\")";
    for (const auto& [name, target] : all) {
      Gathered file{.file = fmt::format("page/{}", name), .what = fmt::format("{} of the page", target)};
      if (problem.empty() && Clock::now() >= end_) problem = kTooLate;
      if (problem.empty()) problem = fetch(target, file);
      if (file.why_not.empty()) file.why_not = problem;
      out_.push_back(std::move(file));
    }
  }
  /// Why the page answers nothing; an answer that is a refusal is said of that file alone.
  std::string fetch(const char* target, Gathered& file) {
    boost::asio::io_context io(1);
    record::PageClient client(io, *places_.page, asked_.patience);
    record::PageAnswer answer;
    boost::asio::co_spawn(io, client.get(target), [&](const std::exception_ptr& failed, record::PageAnswer came) {
      if (failed) std::rethrow_exception(failed);
      answer = std::move(came);
    });
    io.run();
    if (!answer.problem.empty())
      return fmt::format("http://{}/: {}", record::authority_of(*places_.page), answer.problem);
    if (answer.status != kGood) file.why_not = fmt::format("the page answers {}", answer.status);
    file.text = std::move(answer.body);
    return {};
  }

  const Asked& asked_;
  const Redaction& redaction_;
  const Places places_;
  const std::vector<std::string> profiles_option_ =
      asked_.profile_folders.empty() ? std::vector<std::string>{}
                                     : std::vector<std::string>{"--profiles", asked_.profile_folders.front()};
  const Clock::time_point end_ = Clock::now() + kLongest;
  bool is_valid_ = false;
  std::vector<Gathered> out_;
};

}  // namespace

std::vector<Gathered> gather(const Asked& asked, const Redaction& redaction) {
  return Gathering(asked, redaction).run();
}

}  // namespace axisgate::commands::support
