// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/host/restart_plan.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::host {
namespace {

std::string seconds_text(Duration time) {
  const auto tenths = std::chrono::duration_cast<std::chrono::milliseconds>(time).count() / 100;
  const std::string whole = std::to_string(tenths / 10);
  return (tenths % 10 == 0 ? whole : whole + "." + std::to_string(tenths % 10)) + " s";
}

}  // namespace

std::string RestartPlan::on_ready(const std::string& version, Instant now) {
  ready_ = now;
  reported_.reset();
  const std::uint32_t failed = std::exchange(failed_, 0);
  std::string report = std::string(program_.name) + " " + version + " runs";
  if (failed > 1) report += ", after " + std::to_string(failed) + " ends";
  return report;
}

RestartPlan::Next RestartPlan::on_end(const ProcessEnd& end, Instant now) {
  if (ready_ && now - *ready_ >= kRanWell) pause_ = kFirstPause;
  ready_.reset();
  Next next;
  next.pause = has_no_address(end) ? kAddressPause : std::exchange(pause_, std::min(pause_ * 2, kLongestPause));
  ++failed_;
  if (reported_ == end) return next;
  reported_ = end;
  next.report = text(program_, end);
  if (end.how == ProcessEnd::How::not_found)
    *next.report += "; it is looked for again from time to time";
  else if (has_no_address(end))
    *next.report += "; trying again each second";
  else
    *next.report += "; started again in " + seconds_text(next.pause);
  return next;
}

}  // namespace axisgate::host
