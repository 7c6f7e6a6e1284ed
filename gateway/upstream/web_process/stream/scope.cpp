// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/stream/scope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

namespace axisgate::web {
namespace {

/// Of neighbours two are left, and a gap before, between and behind them.
void thin(std::span<const Point> neighbours, std::vector<Point>& out) {
  const Point* low = nullptr;
  const Point* high = nullptr;
  for (const Point& point : neighbours) {
    if (!point.known) continue;
    if (low == nullptr || point.value < low->value) low = &point;
    if (high == nullptr || point.value > high->value) high = &point;
  }
  bool has_gap = false;
  for (const Point& point : neighbours) {
    const bool kept = point.known ? &point == low || &point == high : !has_gap;
    if (kept) out.push_back(point);
    has_gap = point.known ? has_gap && !kept : true;
  }
}

}  // namespace

std::vector<Point> thinned(const std::vector<Point>& points, std::size_t most) {
  if (points.size() <= most) return points;
  constexpr std::size_t kLeft = 5;
  const std::size_t parts = std::max<std::size_t>(most / kLeft, 1);
  const std::size_t size = (points.size() + parts - 1) / parts;
  std::vector<Point> out;
  const std::span<const Point> all(points);
  for (std::size_t i = 0; i < all.size(); i += size) thin(all.subspan(i, std::min(size, all.size() - i)), out);
  return out;
}

Scope::Scope(std::vector<Series> series, SteadyNs begin) {
  for (const Series& each : series) lines_.push_back({each, begin});
}

std::string Scope::next(const Stores& stores, const Now& now) {
  std::vector<std::vector<Point>> news(lines_.size());
  SteadyNs from = now.at;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    Line& line = lines_[i];
    if (stores.picture.find(line.series.axis) == nullptr) continue;  // a reload has taken it away
    std::vector<Point> points;
    stores.history.each(line.series, line.sent, now.at, [&](const Point& point) {
      if (point.at > line.sent) points.push_back(point);
      return true;
    });
    if (points.empty()) continue;
    line.sent = points.back().at;
    from = std::min(from, points.front().at);
    news[i] = thinned(points, kMostPoints / lines_.size());
  }
  std::string out;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (news[i].empty()) continue;
    const Series series = lines_[i].series;
    const AxisInfoRecord& info = stores.picture.find(series.axis)->info;
    out += fmt::format("{}\"{}\":[", out.empty() ? "" : ",", series_text(series));
    for (const Point& point : news[i]) {
      constexpr double kNsOfMs = 1e6;
      out += fmt::format("{}[{},{}]", out.back() == '[' ? "" : ",", static_cast<double>(point.at - from) / kNsOfMs,
                         point.known ? series_value(series.name, point.value, info).dump() : "null");
    }
    out += ']';
  }
  return out.empty() ? out : fmt::format(R"({{"from":"{}","series":{{{}}}}})", utc_text(from, now), out);
}

}  // namespace axisgate::web
