// The table and the lines that `axisgate-dds topics` shows: samples in, text out. Pure: no topic, no terminal, no
// clock. Promises that a value which is not there is a '-', and one whose valid bit is 0 is marked with '?'. Never
// rounds away the sign or more than three digits behind the point.
#pragma once

#include <axisgate.h>

#include <cstdint>
#include <map>
#include <string>

namespace axisgate::dds {

using AxisSamples = std::map<std::uint16_t, axisgate::AxisState>;

/// Lines ended by '\n': one that names the columns, then one an axis. `now_ns`: time of day.
[[nodiscard]] std::string topics_table(const AxisSamples& axes, std::int64_t now_ns);
/// One axis, one line, without '\n'.
[[nodiscard]] std::string topics_line(const axisgate::AxisState& axis);
/// All members by their names in the IDL; null where there is no value.
[[nodiscard]] std::string topics_json(const axisgate::AxisState& axis);

}  // namespace axisgate::dds
