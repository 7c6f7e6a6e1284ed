// SPDX-License-Identifier: Apache-2.0
// What tells a simulated JD from a simulated MD, as data with the section of the sheet beside each row.
// Promises one table per model and no `if (jd)` elsewhere.
// Never holds a figure of a single device; those are DriveOptions.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "tests/simulated/object_dictionary.hpp"

namespace axisgate::simulated {

enum class KincoType : std::uint8_t { jd, md };

// 606C: rpm, refreshed each 200 ms, on the JD (JD 4.2, K7); DEC on the MD (MD B).
enum class SpeedReading : std::uint8_t { rpm_each_200_ms, dec };

struct KincoModel {
  KincoType type;
  std::string_view name;
  std::span<const ObjectEntry> motion_objects;
  std::span<const ObjectEntry> setup_objects;
  std::uint32_t encoder_counts;     // per motor revolution: JD 5, MD 1
  int digital_inputs;               // JD 1.2, MD 1
  OutOfRange out_of_range;          // JD 1.4 point 10, MD 3.2
  std::uint16_t fault_reset_word;   // these bits of 6040 must be 1, bit 7 rising: JD 6.1, MD 8.1
  SpeedReading speed_reading;       // 606C
  bool has_stop_options;            // 605A..605E and 6085 exist: MD M. Without them stops are as JD 6.1 has them
  bool has_halt;                    // controlword bit 8: MD 8.1. The JD does not document it
  bool has_error_word_2;            // 2602's bits are known and set 2601 bit 0: MD 9
  bool remote_bit_in_mode_3;        // statusword bit 9, seen in the JD's mode 3 screen only (JD 6.2, 0xC637)
  bool keeps_single_turn_position;  // MD 12.12: single-turn encoder; the JD's incremental one starts at 0
  bool home_offset_without_move;    // JD: 607C as CiA 402 has it; MD: 6099.05 chooses
  bool torque_object_is_current;    // 6071: current DEC on the JD (4.3), percent of rated torque on the MD (C)
  bool rs485_speaks_this_protocol;  // 6510:0C: MD 3.1. The JD's RS485 is Modbus RTU only (JD 2.2)
};

const KincoModel& jd_model();
const KincoModel& md_model();
const KincoModel& model_of(KincoType type);

}  // namespace axisgate::simulated
