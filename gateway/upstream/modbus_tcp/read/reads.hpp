// SPDX-License-Identifier: Apache-2.0
// Reads of registers, coils and discrete inputs: functions 1 to 4 and the read half of 23 (design 3.1 and 3.2).
// Promises one snapshot per request: nothing changes while one is rendered, so no value is ever torn.
// Never waits for a bus; a range may begin or end inside a 32-bit value, and unlisted offsets read 0.
#pragma once

#include "gateway/upstream/modbus_tcp/read/row_values.hpp"
#include "gateway/upstream/modbus_tcp/read/unit_view.hpp"
#include "gateway/upstream/modbus_tcp/wire/pdu.hpp"

namespace axisgate::modbus_tcp {

/// Answers the read of `request` (read_address, read_count), or the exception: 0x02 outside the map, 0x0B with
/// "offline_reads": "exception" where an axis in the range cannot be reached.
[[nodiscard]] Pdu answer_read(const Request& request, const UnitView& view, const Onlooker& onlooker);

/// The exception of such a read of registers, without an answer; none: it has none.
[[nodiscard]] ModbusException judge_registers_read(const Request& request, const UnitView& view,
                                                   const Onlooker& onlooker);

/// What the register shows now, for FC 22. No value: 32 bits wide, unlisted or outside.
[[nodiscard]] std::optional<std::uint16_t> read_one(std::uint16_t address, const UnitView& view,
                                                    const Onlooker& onlooker);

}  // namespace axisgate::modbus_tcp
