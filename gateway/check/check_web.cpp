// SPDX-License-Identifier: Apache-2.0
#include "gateway/check/check_sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace axisgate::check {

std::string web_title(const web::WebSettings& settings) { return fmt::format("Web: http://{}/", settings.listen); }

ReportLines web_lines(const web::WebSettings& settings) {
  ReportLines out;
  out.emplace_back("may look", settings.allow.empty() ? "nobody" : fmt::format("{}", fmt::join(settings.allow, ", ")));
  out.emplace_back("by name", settings.hosts.empty()
                                  ? "its address, and localhost"
                                  : fmt::format("its address, localhost, {}", fmt::join(settings.hosts, ", ")));
  if (settings.insecure) out.emplace_back("insecure", "neither encrypted nor with passwords");
  out.emplace_back("samples", fmt::format("what has changed, each {:.0f} ms at most", in_ms(settings.sample_period)));
  out.emplace_back("bounds", fmt::format("{} connections, {} of them pages that are open", settings.max_connections,
                                         settings.max_streams));
  out.emplace_back("process", fmt::format("axisgate-web ends beyond {} MiB and is started again; it commands nothing",
                                          settings.memory_limit_mib));
  return out;
}

}  // namespace axisgate::check
