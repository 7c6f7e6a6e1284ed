// SPDX-License-Identifier: Apache-2.0
// The Modbus RTU frames of the iD286pro's manual (section "communication examples"), and frames built from its register
// table. The last CRC that it prints belongs to another frame, 01 10 01 33 00 02: here it stands corrected.
#pragma once

#include "tests/unit/modbus_rtu/rtu_frames.hpp"

namespace axisgate::test {

struct SheetExchange {
  const char* name;
  bus::Exchange exchange;
  const char* request;
  const char* reply;
  bus::ExchangeResult result{};
};
inline void PrintTo(const SheetExchange& it, std::ostream* out) { *out << it.name; }

inline const SheetExchange kId286pro[] = {
    {"manual_read_302", read_of(302), "01 03 01 2E 00 01 E5 FF", "01 03 02 03 E8 B8 FA", value_of(302, 2, 1000)},
    {"manual_read_304", read_of(304, 4), "01 03 01 30 00 02 C5 F8", "01 03 04 27 10 00 00 F1 42",
     value_of(304, 4, 10000)},
    {"manual_write_300", write_of(300, 1, 2), "01 06 01 2C 00 01 88 3F", "01 06 01 2C 00 01 88 3F"},
    {"manual_write_312", write_of(312, 10000, 4), "01 10 01 38 00 02 04 27 10 00 00 F7 FC", "01 10 01 38 00 02 C1 F9"},
    {"internal_mode", write_of(296, 1, 2), "01 06 01 28 00 01 C9 FE", "01 06 01 28 00 01 C9 FE"},
    {"fault_and_state", block_of(108, 2, {{109, 2}}), "01 03 00 6C 00 02 04 16", "01 03 04 00 00 00 02 7B F2",
     values({{{108, 0}, 2, 0}, {{109, 0}, 2, 2}})},
    {"position", read_of(117, 4), "01 03 00 75 00 02 D5 D1", "01 03 04 CF C7 FF FF 75 6A",
     value_of(117, 4, static_cast<std::uint32_t>(-12345))},
    {"positioning_speed", write_of(306, 1000, 2), "01 06 01 32 03 E8 29 47", "01 06 01 32 03 E8 29 47"},
    {"target", write_of(313, static_cast<std::uint32_t>(-100000), 4), "01 10 01 39 00 02 04 79 60 FF FE E4 73",
     "01 10 01 39 00 02 90 39"},
    {"start_absolute", write_of(323, 1, 2), "01 06 01 43 00 01 B8 22", "01 06 01 43 00 01 B8 22"},
    {"start_relative", write_of(323, 2, 2), "01 06 01 43 00 02 F8 23", "01 06 01 43 00 02 F8 23"},
    {"speed_below_zero", write_of(307, 0xFE0C, 2), "01 06 01 33 FE 0C 38 5C", "01 06 01 33 FE 0C 38 5C"},
    {"start_speed", write_of(323, 3, 2), "01 06 01 43 00 03 39 E3", "01 06 01 43 00 03 39 E3"},
    {"stop", write_of(323, 6, 2), "01 06 01 43 00 06 F9 E0", "01 06 01 43 00 06 F9 E0"},
    {"emergency_stop", write_of(323, 7, 2), "01 06 01 43 00 07 38 20", "01 06 01 43 00 07 38 20"},
    {"home", write_of(323, 12, 2), "01 06 01 43 00 0C 79 E7", "01 06 01 43 00 0C 79 E7"},
    {"clear_alarm", write_of(323, 13, 2), "01 06 01 43 00 0D B8 27", "01 06 01 43 00 0D B8 27"},
};
/// All drives: stop. Nobody answers it.
inline constexpr const char* kId286proStopAll = "FF 06 01 43 00 06 EC 3E";

}  // namespace axisgate::test
