// SPDX-License-Identifier: Apache-2.0
// What `axisgate record` asks the page for, and what the answers say. Pure: texts in, texts out.
// Promises that what cannot be meant is refused with what to write. Never resolves a name or sends anything.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/commands/client/axis_names.hpp"
#include "gateway/commands/client/host_port.hpp"
#include "gateway/commands/record/plan/pieces.hpp"

namespace axisgate::commands::record {

/// As many as the page answers at once.
inline constexpr std::size_t kMostSeries = 16;

/// "http://127.0.0.1:8080/", also without "http://", without the '/', or without the port, which is 80 then.
[[nodiscard]] std::optional<HostPort> parse_page_url(std::string_view text);
/// "127.0.0.1:8080", "[::1]:8080"
[[nodiscard]] std::string authority_of(const HostPort& place);
/// "'x' is no address of a page: write ..."; empty: it is one.
[[nodiscard]] std::string page_url_mistake(const std::string& text);

/// What is wrong with names of series; empty: they can be asked for.
[[nodiscard]] std::string series_mistake(const std::string& names);
/// "1.position_rev,1.velocity_rpm,...", by axis. @param names with commas between; empty: of a sensible five as many as
/// there is room for
[[nodiscard]] std::string series_of(const std::vector<std::uint16_t>& axes, std::string_view names);
/// How many there are in such a text.
[[nodiscard]] std::size_t count_of(std::string_view series);

/// /api/v1/gateway, as far as it is needed.
struct PageState {
  UtcNs at = 0;
  bool joined = false;  ///< the page hears its gateway
};
/// None: it is no answer of axisgate's page.
[[nodiscard]] std::optional<PageState> page_state(std::string_view json);
/// What the axes are called, of /api/v1/axes.
[[nodiscard]] AxisNames names_of_axes(std::string_view json);
/// How far the history reaches back, of /api/v1/history; none: it does not say.
[[nodiscard]] std::optional<UtcNs> oldest_of(std::string_view json);
/// Of application/problem+json; empty: it has none.
[[nodiscard]] std::string detail_of(std::string_view json);

[[nodiscard]] std::string history_target(const std::string& series, const Piece& piece);
[[nodiscard]] std::string csv_target(const std::string& series, const Piece& piece);

}  // namespace axisgate::commands::record
