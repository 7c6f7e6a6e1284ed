// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_host/web_program.hpp"

#include <nlohmann/json.hpp>

namespace axisgate::web {

std::vector<std::string> serve_arguments(const WebSettings& settings, int link_descriptor) {
  nlohmann::json resolved{{"listen", {settings.listen}},
                          {"hosts", settings.hosts},
                          {"insecure", settings.insecure},
                          {"allow", settings.allow},
                          {"max_connections", settings.max_connections},
                          {"max_streams", settings.max_streams},
                          {"history_mb", history_mib(settings)},
                          {"memory_limit_mb", settings.memory_limit_mib}};
  resolved.update(nlohmann::json::parse(settings.recorder));
  return {"serve", "--link-fd=" + std::to_string(link_descriptor), "--settings=" + resolved.dump()};
}

}  // namespace axisgate::web
