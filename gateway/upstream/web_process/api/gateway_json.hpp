// SPDX-License-Identifier: Apache-2.0
// The gateway and its buses as the web shows them, and whether the gateway is there at all.
// Promises numbers as they were reported last, and that what is not known is null or unknown. Never adds up what others
// count.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "gateway/upstream/web_process/http/served.hpp"
#include "gateway/upstream/web_process/picture/picture.hpp"

namespace axisgate::web {

[[nodiscard]] nlohmann::ordered_json gateway_json(const Picture& picture, const Served& served, const Now& now);
[[nodiscard]] nlohmann::ordered_json bus_json(const Picture& picture, const BusPicture& bus, SteadyNs now);
/// {at, buses: [...]}
[[nodiscard]] nlohmann::ordered_json buses_json(const Picture& picture, const Now& now);
[[nodiscard]] const BusPicture* bus_named(const Picture& picture, const std::string& name);

}  // namespace axisgate::web
