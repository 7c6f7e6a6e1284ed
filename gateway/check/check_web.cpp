// SPDX-License-Identifier: Apache-2.0
#include "gateway/check/check_sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "gateway/upstream/web_link/capture_defaults.hpp"

namespace axisgate::check {
namespace {

std::string history_text(const web::WebSettings& settings, std::size_t values) {
  constexpr double kMib = 1024 * 1024;
  const double samples = web::history_mib(settings) * kMib / web::kHistoryBytes;
  const double seconds =
      samples / static_cast<double>(std::max<std::size_t>(values, 1)) * in_ms(settings.sample_period) / 1000;
  return fmt::format("{:.0f} s where each of {} values is another one in each sample; what stands takes none of it",
                     seconds, values);
}

/// "10 s before and 5 s behind each cause, the newest 20, in memory alone"
std::string captures_text(const nlohmann::json& recorder) {
  const nlohmann::json given = recorder.value("captures", nlohmann::json::object());
  const bool has_folder = given.contains("folder") && given["folder"].is_string();
  return fmt::format("{} s before and {} s behind each cause, the newest {}, {}",
                     given.value("before_s", double{web::kCaptureBeforeS}),
                     given.value("after_s", double{web::kCaptureAfterS}), given.value("keep", web::kCapturesKept),
                     has_folder ? "as files in " + given["folder"].get<std::string>() : "in memory alone");
}

std::string triggers_text(const nlohmann::json& triggers) {
  std::vector<std::string> names;
  for (const nlohmann::json& each : triggers)
    names.push_back(fmt::format("{} (axis {}: {} {})", each.value("name", ""), each.value("axis", 0),
                                each.value("quantity", ""), each.value("is", "")));
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::string web_title(const web::WebSettings& settings) { return fmt::format("Web: http://{}/", settings.listen); }

ReportLines web_lines(const web::WebSettings& settings, std::size_t values) {
  ReportLines out;
  out.emplace_back("may look", settings.allow.empty() ? "nobody" : fmt::format("{}", fmt::join(settings.allow, ", ")));
  out.emplace_back("by name", settings.hosts.empty()
                                  ? "its address, and localhost"
                                  : fmt::format("its address, localhost, {}", fmt::join(settings.hosts, ", ")));
  if (settings.insecure) out.emplace_back("insecure", "neither encrypted nor with passwords");
  out.emplace_back("samples", fmt::format("what has changed, each {:.0f} ms at most", in_ms(settings.sample_period)));
  out.emplace_back("history", history_text(settings, values));
  const auto recorder = nlohmann::json::parse(settings.recorder.empty() ? "{}" : settings.recorder);
  out.emplace_back("captures", captures_text(recorder));
  if (recorder.contains("triggers")) out.emplace_back("triggers", triggers_text(recorder["triggers"]));
  out.emplace_back("bounds", fmt::format("{} connections, {} of them pages that are open", settings.max_connections,
                                         settings.max_streams));
  out.emplace_back("process", fmt::format("axisgate-web ends beyond {} MiB and is started again; it commands nothing",
                                          settings.memory_limit_mib));
  return out;
}

}  // namespace axisgate::check
