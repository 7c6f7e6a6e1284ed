// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/record/plan/request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace axisgate::commands::record {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 5> kUsual{"position_rev", "velocity_rpm", "torque_percent", "current_a",
                                                 "axis_state"};

std::vector<std::string_view> parts_of(std::string_view whole) {
  std::vector<std::string_view> out;
  for (std::size_t comma = 0; comma != std::string_view::npos;) {
    comma = whole.find(',');
    out.push_back(whole.substr(0, comma));
    whole.remove_prefix(comma == std::string_view::npos ? 0 : comma + 1);
  }
  return out;
}

/// What a member says; empty: it is not there, or no text.
std::string text_of(const json& object, const char* member) {
  const auto found = object.is_object() ? object.find(member) : object.end();
  return object.is_object() && found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

json read(std::string_view text) { return json::parse(text, nullptr, false); }

std::string asked(const std::string& series, const Piece& piece) {
  return fmt::format("series={}&from={}&to={}", series, utc_text(piece.from), utc_text(piece.asked_to()));
}

}  // namespace

std::optional<HostPort> parse_page_url(std::string_view text) {
  constexpr std::string_view kScheme = "http://";
  const bool url = text.starts_with(kScheme);
  if (url) text.remove_prefix(kScheme.size());
  if (text.ends_with('/')) text.remove_suffix(1);
  if (text.find('/') != std::string_view::npos) return std::nullopt;
  if (const auto place = parse_host_port(text)) return place;
  return url ? parse_host_port(std::string(text) + ":80") : std::nullopt;
}

std::string authority_of(const HostPort& place) {
  const bool v6 = place.host.find(':') != std::string::npos;
  return fmt::format("{}{}{}:{}", v6 ? "[" : "", place.host, v6 ? "]" : "", place.port);
}

std::string page_url_mistake(const std::string& text) {
  return parse_page_url(text) ? ""
                              : fmt::format(
                                    "'{}' is no address of a page: write http://127.0.0.1:8080/ or "
                                    "http://gateway.local:8080/",
                                    text);
}

std::string series_mistake(const std::string& names) {
  constexpr std::string_view kOfNames = "abcdefghijklmnopqrstuvwxyz0123456789_";
  for (const std::string_view name : parts_of(names))
    if (name.empty() || name.find_first_not_of(kOfNames) != std::string_view::npos)
      return fmt::format(
          "'{}' is no name of a value: write velocity_rpm,position_rev, as the API has them, without the "
          "axis",
          name);
  return {};
}

std::string series_of(const std::vector<std::uint16_t>& axes, std::string_view names) {
  std::vector<std::string_view> wanted = parts_of(names);
  if (names.empty()) {
    wanted.assign(kUsual.begin(), kUsual.end());
    wanted.resize(std::clamp<std::size_t>(kMostSeries / std::max<std::size_t>(axes.size(), 1), 1, kUsual.size()));
  }
  std::string out;
  for (const std::uint16_t axis : axes)
    for (const std::string_view name : wanted) out += fmt::format("{}{}.{}", out.empty() ? "" : ",", axis, name);
  return out;
}

std::size_t count_of(std::string_view series) { return parts_of(series).size(); }

std::optional<PageState> page_state(std::string_view text) {
  const json object = read(text);
  const auto at = parse_utc(text_of(object, "at"));
  if (!at || !object.contains("joined") || !object["joined"].is_boolean()) return std::nullopt;
  return PageState{*at, object["joined"].get<bool>()};
}

AxisNames names_of_axes(std::string_view text) {
  AxisNames names;
  const json object = read(text);
  if (!object.is_object() || !object.contains("axes")) return names;
  for (const json& axis : object["axes"]) {
    const bool numbered = axis.is_object() && axis.contains("axis") && axis["axis"].is_number_unsigned();
    const auto number = numbered ? axis_number_in(axis["axis"].dump()) : std::nullopt;
    if (number) names[*number] = text_of(axis, "name");
  }
  return names;
}

std::optional<UtcNs> oldest_of(std::string_view text) { return parse_utc(text_of(read(text), "oldest")); }

std::string detail_of(std::string_view text) { return text_of(read(text), "detail"); }

std::string history_target(const std::string& series, const Piece& piece) {
  return "/api/v1/history?" + asked(series, piece) + "&points=16";
}

std::string csv_target(const std::string& series, const Piece& piece) {
  return "/api/v1/history.csv?" + asked(series, piece);
}

}  // namespace axisgate::commands::record
