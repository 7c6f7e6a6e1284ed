// SPDX-License-Identifier: Apache-2.0
// One axis as the web shows it. Promises that a value that is not valid now is null and stands in `last` with its age,
// and that of a gateway that is not heard nothing is called good. Never invents what was not reported.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "gateway/upstream/web_process/picture/picture.hpp"

namespace axisgate::web {

/// Without what is fixed while the configuration is as it is: its units, and what its drive can.
[[nodiscard]] nlohmann::ordered_json axis_now_json(const Picture& picture, const AxisPicture& axis, const Now& now);
[[nodiscard]] nlohmann::ordered_json axis_json(const Picture& picture, const AxisPicture& axis, const Now& now);

}  // namespace axisgate::web
