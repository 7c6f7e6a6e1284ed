// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/metrics/metrics.hpp"

#include <utility>

#include "gateway/upstream/web_process/metrics/axis_metrics.hpp"
#include "gateway/upstream/web_process/metrics/families.hpp"
#include "gateway/upstream/web_process/metrics/gateway_metrics.hpp"

namespace axisgate::web {

std::string metrics_text(const Picture& picture, const Served& served, SteadyNs now) {
  Families out;
  const bool joined = picture.joined(now);
  out.add(Metric::up, {}, joined ? 1 : 0);
  if (joined) {
    add_gateway(out, picture);
    add_buses(out, picture);
    for (const auto& [number, axis] : picture.axes()) add_axis(out, picture, number, axis, now);
  }
  add_web(out, picture, served);
  return std::move(out).text();
}

}  // namespace axisgate::web
