// SPDX-License-Identifier: Apache-2.0
// How one simulated drive is made: type, station, what its EEPROM holds, its mechanics, and the points the sheets leave
// open. Promises that the defaults give a commissioned drive: DIN functions that block the bus removed and stored.
// Never changes while the drive runs.
#pragma once

#include <cstdint>
#include <optional>

#include "tests/simulated/kinco_model.hpp"
#include "tests/simulated/mechanics.hpp"
#include "tests/simulated/time.hpp"

namespace axisgate::simulated {

struct DriveOptions {
  KincoType type = KincoType::jd;
  std::uint8_t station = 1;    // an MD's 1 to 7 stand on its DIP switches and cannot be changed by software (MD 1)
  bool factory_fresh = false;  // DIN1, DIN3, and the JD's DIN5 and DIN6, as delivered (JD 1.4, MD 6.1)
  bool cascade = false;        // 6510:0B as stored
  bool rs485_modbus = false;   // an MD's 6510:0C as stored: 0, Modbus RTU, instead of the 1 it is delivered with
  std::uint32_t encoder_counts = 0;  // 0: the model's
  Mechanics mechanics;

  // Not in the sheets (JD 10, MD 12), so tests may choose.
  Time boot_time = std::chrono::seconds(1);         // JD 1.4 point 5: about 1 s of 8.8.8.8
  Time store_time = std::chrono::milliseconds(50);  // until 2FF0:01 reads 0 and the EEPROM is written
  bool echo_written_value = true;                   // data of a 0x60 reply: echo, or zeros (JD K5, MD C33)
  std::uint8_t unused_bytes = 0x00;                 // of 0x4B and 0x4F replies; the sibling FD5P sends FF (MD 2.2)
  std::optional<OutOfRange> out_of_range;           // none: as the model's sheet has it for RS232
  bool needs_shutdown_first = false;                // 0x0F is ignored until a 0x06 came (JD 2.3, printed for CANopen)
};

}  // namespace axisgate::simulated
