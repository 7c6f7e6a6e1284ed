// SPDX-License-Identifier: Apache-2.0
// The table and the lines that `axisgate-dds topics` shows: samples in, text out. Pure: no topic, no terminal, no
// clock. Promises that a value which is not there is a '-', and one whose valid bit is 0 is marked with '?'; states,
// modes, errors and alarms in the words of gateway/core/words.hpp, as `axisgate top` has them. Where the terminal is
// narrow an axis takes several lines. Never rounds away the sign or more than three digits behind the point.
#pragma once

#include <axisgate.h>

#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace axisgate::dds {

/// An axis of a gateway: its name, then the number.
using AxisKey = std::pair<std::string, std::uint16_t>;
using AxisSamples = std::map<AxisKey, axisgate::AxisState>;

/// A gateway as its gateway_state tells of it, and who writes that: of a name that two gateways have, two participants.
struct SeenGateway {
  axisgate::GatewayState state{};
  std::map<std::string, std::int64_t> writers{};  ///< by participant, the time of day of its newest sample
};
using SeenGateways = std::map<std::string, SeenGateway>;
/// A participant that has said nothing for so long is gone: gateway_state comes each second.
inline constexpr std::int64_t kGatewayGoneAfter = 5'000'000'000;

/// Lines ended by '\n': one that names the columns, then one a gateway.
[[nodiscard]] std::string gateways_table(const SeenGateways& gateways, std::int64_t now_ns);
/// Lines ended by '\n': one that names the columns, then one an axis, or two and more where that would not fit into
/// `columns` (at least 80; 0: there is no end). `now_ns`: time of day. With the gateways' names where one has a name.
[[nodiscard]] std::string topics_table(const AxisSamples& axes, std::int64_t now_ns, std::size_t columns = 0);
/// One axis, one line, without '\n'.
[[nodiscard]] std::string topics_line(const axisgate::AxisState& axis);
/// All members by their names in the IDL; null where there is no value.
[[nodiscard]] std::string topics_json(const axisgate::AxisState& axis);

}  // namespace axisgate::dds
