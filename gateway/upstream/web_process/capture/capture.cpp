// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/capture/capture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace axisgate::web {
namespace {

/// Of a line, an event and an axis, beside what they hold.
constexpr std::size_t kEachLine = 192, kEachEvent = 96, kEachAxis = 256;

/// The gravest first.
constexpr std::array kByGravity{
    Cause::fault,          Cause::unexpected_motion, Cause::units_disagree, Cause::link_lost,
    Cause::command_failed, Cause::lease_stop,        Cause::stranger_stop,  Cause::trigger};
static_assert(kByGravity.size() == static_cast<std::size_t>(last_of(Cause{})) + 1);

std::size_t place(Cause cause) {
  return static_cast<std::size_t>(std::ranges::find(kByGravity, cause) - kByGravity.begin());
}

bool is_number(std::string_view text) {
  constexpr std::size_t kMostDigits = 20;
  return !text.empty() && text.size() <= kMostDigits &&
         std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

bool Capture::has(Cause cause, std::uint16_t axis) const {
  return std::ranges::any_of(causes, [&](const CauseSeen& each) { return each.cause == cause && each.axis == axis; });
}

const AxisInfoRecord* Capture::find(std::uint16_t axis) const {
  const auto found = std::ranges::find(axes, axis, &AxisInfoRecord::axis);
  return found == axes.end() ? nullptr : &*found;
}

const CauseSeen& Capture::gravest() const {
  const CauseSeen* out = &first();
  for (const CauseSeen& each : causes)
    if (each.axis == out->axis && place(each.cause) < place(out->cause)) out = &each;
  return *out;
}

std::string Capture::text() const {
  const CauseSeen& named = gravest();
  std::string out;
  for (const CauseSeen& each : causes) {
    out += out.empty() ? "" : "; then ";
    if (each.axis != named.axis)
      out += fmt::format("{} of axis {}: ", web::text(each.cause), each.axis);
    else if (each.cause != named.cause)
      out += fmt::format("{}: ", web::text(each.cause));
    out += each.text;
  }
  return out;
}

void Capture::each(Series series, SteadyNs begin, SteadyNs end, const Visit& visit) const {
  if (const auto found = lines.find(series); found != lines.end()) found->second.each(begin, end, visit);
}

std::size_t Capture::samples() const {
  std::size_t out = 0;
  for (const auto& [series, points] : lines) out += points.size();
  return out;
}

std::size_t Capture::bytes() const {
  std::size_t out = sizeof(Capture) + kEachAxis * (axes.size() + causes.size());
  for (const auto& [series, points] : lines) out += kEachLine + points.bytes();
  for (const EventRecord& event : events) out += kEachEvent + event.text.size();
  return out;
}

bool is_capture_id(std::string_view text) {
  const std::size_t point = text.find('.');
  return point != std::string_view::npos && is_number(text.substr(0, point)) && is_number(text.substr(point + 1));
}

}  // namespace axisgate::web
