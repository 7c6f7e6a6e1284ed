// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/md_objects.hpp"

namespace axisgate::simulated {
namespace {

using enum ObjectType;
using enum Access;
using enum Keep;

// Defaults the sheet leaves open (6060, 6081, 6099, 609A, 6085, 605A..605E, the DIN functions of MD 12.9): a plausible
// figure, never relied upon. Widths it leaves open (607F, 6068, 60F5, 60F9.1A, 60F9.1C, 6510.0B): CiA 402's, or the
// JD's.
constexpr ObjectEntry md_motion_entries[] = {
    // MD A control and mode
    {0x6040, 0x00, u16, rw, ram},           // control word
    {0x6041, 0x00, u16, ro, ram},           // status word
    {0x6060, 0x00, i8, rw, ram, -4},        // mode of operation
    {0x2020, 0x0F, u16, rw, eeprom, 0x2F},  // control word applied by the "drive enable" DIN (absolute/relative select)
    {0x2020, 0x0D, i8, rw, eeprom, -4},     // mode select 0 (DIN mode control = 0)
    {0x2020, 0x0E, i8, rw, eeprom, -3},     // mode select 1 (DIN mode control = 1)
    // MD B measured values
    {0x6063, 0x00, i32, ro, ram},  // actual position
    {0x6078, 0x00, i16, ro, ram},  // actual current
    {0x60FD, 0x00, u32, ro, ram},  // input port status (function level)
    {0x606C, 0x00, i32, ro, ram},  // actual speed
    {0x60F9, 0x1A, i16, ro, ram},  // actual speed, 1 ms value
    {0x60F9, 0x1C, i32, ro, ram},  // speed error
    // MD C targets and limits
    {0x607E, 0x00, u8, rw, eeprom, 0, 0, 1},               // direction (invert speed/position)
    {0x607A, 0x00, i32, rw, ram},                          // target position
    {0x6081, 0x00, u32, rw, ram, 1789570},                 // profile velocity
    {0x60FF, 0x00, i32, rw, ram, 0, -53687091, 53687091},  // target velocity
    {0x6080, 0x00, u16, rw, ram, 5000},                    // maximum speed limit
    {0x6083, 0x00, u32, rw, eeprom, 107374},               // profile acceleration
    {0x6084, 0x00, u32, rw, eeprom, 107374},               // profile deceleration
    {0x6071, 0x00, i16, rw, ram},                          // target torque
    {0x60F6, 0x08, i16, rw, ram},                          // target current
    {0x6073, 0x00, u16, rw, eeprom, 2047},                 // target current limit
    {0x607F, 0x00, u32, rw, eeprom},                       // maximum speed limit (torque mode)
    // MD E windows and software limits
    {0x6065, 0x00, u32, rw, eeprom, 524288},  // maximum following error
    {0x6067, 0x00, u32, rw, eeprom, 327},     // target position window
    {0x2508, 0x09, u16, rw, ram, 10},         // target (position, speed) reached time window
    {0x6068, 0x00, u16, rw, eeprom},          // position window time
    {0x60F9, 0x0A, i32, rw, eeprom, 17896},   // speed reached window
    {0x2010, 0x18, u16, rw, eeprom, 1000},    // zero speed window
    {0x60F9, 0x14, u16, rw, eeprom, 10},      // zero speed hold time
    {0x607D, 0x01, i32, rw, eeprom},          // software limit, positive
    {0x607D, 0x02, i32, rw, eeprom},          // software limit, negative
    {0x2010, 0x19, u8, rw, eeprom, 1, 0, 1},  // limit switch action
    {0x60F5, 0x06, i16, rw, eeprom},          // torque reached threshold
    {0x60F5, 0x07, u16, rw, eeprom},          // torque reached filter time
    // MD F homing
    {0x6098, 0x00, i8, rw, eeprom},            // homing method
    {0x6099, 0x01, u32, rw, eeprom, 3579139},  // homing speed: switch search ("turn signal" speed)
    {0x6099, 0x02, u32, rw, eeprom, 2684355},  // homing speed: origin signal
    {0x6099, 0x03, u8, rw, eeprom, 0, 0, 1},   // home at power-on
    {0x6099, 0x04, i16, rw, eeprom, 1024},     // homing maximum current
    {0x6099, 0x05, u8, rw, eeprom, 0, 0, 1},   // home offset mode
    {0x6099, 0x06, u8, rw, eeprom, 0, 0, 2},   // index signal blind zone
    {0x609A, 0x00, u32, rw, eeprom, 107374},   // homing acceleration
    {0x607C, 0x00, i32, rw, eeprom},           // home offset
    // MD K save and restore
    {0x2FF0, 0x01, u8, rw, ram},  // save control parameters / restore defaults
    {0x2FF0, 0x03, u8, rw, ram},  // save motor parameters
    // MD L errors
    {0x2601, 0x00, u16, ro, ram},  // error word 1 (live)
    {0x2602, 0x00, u16, ro, ram},  // error word 2
    // MD M stop options
    {0x605A, 0x00, i16, rw, eeprom, 2, 0, 6},  // quick stop option
    {0x605B, 0x00, i16, rw, eeprom, 0, 0, 2},  // shutdown option
    {0x605C, 0x00, i16, rw, eeprom, 1, 0, 2},  // disable option
    {0x605D, 0x00, i16, rw, eeprom, 1, 1, 2},  // halt option
    {0x605E, 0x00, i16, rw, eeprom, 2, 0, 2},  // fault reaction option
    {0x6085, 0x00, u32, rw, eeprom, 536871},   // quick stop deceleration
};

}  // namespace

std::span<const ObjectEntry> md_motion_objects() { return md_motion_entries; }

}  // namespace axisgate::simulated
