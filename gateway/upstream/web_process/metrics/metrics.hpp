// SPDX-License-Identifier: Apache-2.0
// The picture as Prometheus reads it. Pure: the picture in, text out.
// Promises the numbers that the API shows at the same moment, in base units; that what is not known has no sample; that
// while the gateway is not joined axisgate_up is 0 and nothing else of it is there. Never counts anything itself.
#pragma once

#include <string>
#include <string_view>

#include "gateway/upstream/web_process/http/served.hpp"
#include "gateway/upstream/web_process/picture/picture.hpp"

namespace axisgate::web {

inline constexpr std::string_view kMetricsType = "text/plain; version=0.0.4; charset=utf-8";
/// An answer is no longer: 499 axes on 100 buses take a third of it.
inline constexpr std::size_t kMaxMetrics = 16 * 1024 * 1024;

[[nodiscard]] std::string metrics_text(const Picture& picture, const Served& served, SteadyNs now);

}  // namespace axisgate::web
